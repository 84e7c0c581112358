// Writes JSON as ASCII, and asks the system for the peak memory of the process.
#include "apps/statistics.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include "files/atomic_file.h"

namespace delray::apps {

std::string json_text(const Json& value, int indent) {
  constexpr bool kAscii = true;
  return value.dump(indent, ' ', kAscii, Json::error_handler_t::replace);
}

void write_statistics(const std::string& path, const Json& statistics) {
  if (!path.empty()) files::write_file(path, json_text(statistics, 2) + "\n");
}

std::uint64_t peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // Linux counts kibibytes
}

std::string count_text(std::uint64_t count, const char* one) {
  return fmt::format("{} {}{}", count, one, count == 1 ? "" : "s");
}

std::string primitives_text(std::uint64_t triangles, std::uint64_t splats) {
  const std::string points =
      splats == 1 ? "1 point or line" : fmt::format("{} points and lines", splats);
  if (triangles == 0 && splats > 0) return points;
  return count_text(triangles, "triangle") + (splats > 0 ? ", " + points : "");
}

}  // namespace delray::apps
