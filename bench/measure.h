// Seconds and bytes for comparisons in which several programs take turns on one machine.
#pragma once

#include <malloc.h>
#include <sys/mman.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <fstream>
#include <string>
#include <vector>

#include "delaunay/mesh/array.h"

namespace delray::bench {

// The upper median. REQUIRES: there are values.
inline double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Seconds that work() takes; what it returns is destroyed after the clock has stopped.
double seconds_of(auto&& work) {
  const auto start = std::chrono::steady_clock::now();
  [[maybe_unused]] const auto result = work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Touches so many bytes and gives them back to the system. A virtual machine returns memory that
// was free for some seconds to its host, and fetching it again takes longer than many a
// triangulation: whoever runs after a long rival would pay for it. To be called before every run,
// of all sides.
inline void warm_memory(std::size_t bytes) {
  delaunay::Array<char> memory(bytes);
  constexpr std::size_t kPage = 4096;
  for (std::size_t i = 0; i < bytes; i += kPage) {
    static_cast<volatile char*>(memory.data())[i] = 1;
  }
}

// While it lives memory that went back to malloc stays in the process, warm, for a side that takes
// longer than memory stays warm. The peak of memory must not be measured meanwhile.
class KeepMemory {
 public:
  KeepMemory() {
    mallopt(M_MMAP_MAX, 0);
    mallopt(M_TRIM_THRESHOLD, -1);
  }
  ~KeepMemory() {
    constexpr int kDefaultMaps = 65536, kDefaultTrim = 128 * 1024;
    mallopt(M_MMAP_MAX, kDefaultMaps);
    mallopt(M_TRIM_THRESHOLD, kDefaultTrim);
    malloc_trim(0);
  }
  KeepMemory(const KeepMemory&) = delete;
  KeepMemory& operator=(const KeepMemory&) = delete;
};

// Peak of the resident set in bytes since the last call with reset; 0 where Linux's /proc is
// missing.
inline std::size_t peak_memory(bool reset) {
  if (reset) {
    malloc_trim(0);
    std::ofstream("/proc/self/clear_refs") << "5";
  }
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmHWM:")) return std::stoull(line.substr(6)) * 1024;
  }
  return 0;
}

}  // namespace delray::bench
