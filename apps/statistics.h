// --stats: what a run did, as JSON.
#pragma once

#include <chrono>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

namespace delray::apps {

using Json = nlohmann::ordered_json;

// As JSON in ASCII: terminals find nothing in it to obey. Bytes that are not UTF-8 become U+FFFD.
std::string json_text(const Json& value, int indent);

// Writes to a file, whole or not at all, or to stdout for "-"; nothing for an empty path.
void write_statistics(const std::string& path, const Json& statistics);

// Seconds since it was made or last read.
class Stopwatch {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - start_).count();
    start_ = now;
    return seconds;
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// "1 page", "2 pages". `one` is a noun whose plural ends in s.
std::string count_text(std::uint64_t count, const char* one);

// What a scene is made of: "12 triangles, 3 points and lines", or "1 triangle", without what there
// is none of.
std::string primitives_text(std::uint64_t triangles, std::uint64_t splats);

// The most memory that this process has had, bytes.
std::uint64_t peak_memory();

}  // namespace delray::apps
