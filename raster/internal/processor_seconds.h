// Processor time that several threads add up.
#pragma once

#include <time.h>

#include <atomic>
#include <cstdint>

namespace delray::raster {

// Waiting for a core does not count: ranks that share cores are as busy as if each had its own.
class ProcessorSeconds {
 public:
  // Runs f on this thread and adds the time it took.
  template <class F>
  void measure(F&& f) {
    const std::int64_t begin = now();
    f();
    nanoseconds_.fetch_add(now() - begin, std::memory_order_relaxed);
  }
  double seconds() const { return 1e-9 * static_cast<double>(nanoseconds_.load()); }

 private:
  static std::int64_t now() {
    timespec time;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
  }

  std::atomic<std::int64_t> nanoseconds_{0};
};

}  // namespace delray::raster
