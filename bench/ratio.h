// Ratios in a form that scripts/bench reads: a line of JSON for each, appended to the file that the
// environment variable DELRAY_RATIOS names. Without the variable nothing is written.
#pragma once

#include <cassert>
#include <cstdlib>
#include <fstream>
#include <string>

namespace delray::bench {

// The direction in which a ratio is better.
enum class Better { lower, higher };

// `name` says what was measured and differs from those of all other ratios of a run of the program;
// `bar` is the limit that the ratio is held to, 0 where it has none.
//
// REQUIRES: no quotation marks or backslashes in `name`.
inline void report_ratio(const std::string& name, double ratio, Better better = Better::lower,
                         double bar = 0) {
  assert(name.find_first_of("\"\\") == std::string::npos);
  const char* path = std::getenv("DELRAY_RATIOS");
  if (path == nullptr) return;
  std::ofstream file(path, std::ios::app);
  file << R"({"name": ")" << name << R"(", "ratio": )" << ratio << R"(, "better": ")"
       << (better == Better::lower ? "lower" : "higher") << '"';
  if (bar > 0) file << R"(, "bar": )" << bar;
  file << "}\n";
}

// "1 thread", "2 threads".
inline std::string thread_count(int threads) {
  return std::to_string(threads) + (threads == 1 ? " thread" : " threads");
}

}  // namespace delray::bench
