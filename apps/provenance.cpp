// Collects the version, the processor from /proc/cpuinfo, the compiler, the system and the time.
#include "apps/provenance.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/utsname.h>

#include <ctime>
#include <fstream>
#include <thread>

#include "apps/statistics.h"
#include "scenes/generate.h"

namespace delray::apps {
namespace {

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  std::string line;
  while (std::getline(file, line)) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown processor";
}

}  // namespace

std::string machine_text() {
  return fmt::format("{}, {} hardware threads", processor(), std::thread::hardware_concurrency());
}

std::string machine_and_compiler() { return machine_text() + "; " DELRAY_COMPILER; }

std::vector<std::pair<std::string, std::string>> provenance(const Session& session) {
  utsname system{};
  uname(&system);
  return {{"command", session.command_line},
          {"version", "delray " DELRAY_VERSION},
          {"machine", machine_text()},
          {"compiler", DELRAY_COMPILER},
          {"system", fmt::format("{} {}", system.sysname, system.release)},
          {"ranks", session.under_mpi ? "processes of mpirun" : "threads of one process"},
          {"date", fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(std::time(nullptr)))}};
}

std::vector<std::pair<std::string, std::string>> provenance(const Session& session,
                                                            const std::string& scene) {
  auto result = provenance(session);
  if (scenes::is_generated(scene))
    result.emplace_back("scene", scenes::full_name(scene) + ": kind, triangles, seed");
  return result;
}

}  // namespace delray::apps
