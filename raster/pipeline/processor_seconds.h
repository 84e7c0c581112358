// Processor time of what several threads do by turns.
#pragma once

#include <time.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "parallel/processor_time.h"

namespace delray::raster {

// Processor time that several threads add up.
class ProcessorSeconds {
 public:
  // Runs f on this thread and adds the time it took.
  template <class F>
  void measure(F&& f) {
    const std::int64_t begin = parallel::processor_nanoseconds();
    f();
    add(parallel::processor_nanoseconds() - begin);
  }
  void add(std::int64_t nanoseconds) {
    nanoseconds_.fetch_add(nanoseconds, std::memory_order_relaxed);
  }
  double seconds() const { return 1e-9 * static_cast<double>(nanoseconds_.load()); }

 private:
  std::atomic<std::int64_t> nanoseconds_{0};
};

// The stages that one thread goes through many times. Asking for processor time is a call of the
// system, a tenth of what shading a simple tile takes: it is asked for twice in all, and shared out
// by the time that passed, which costs little to read.
template <std::size_t kStages>
class StageClock {
 public:
  StageClock() : begin_(parallel::processor_nanoseconds()), last_(passed()) {}

  // Counts the time since the last call, or since the beginning, for `stage`.
  void finish(std::size_t stage) {
    const std::int64_t now = passed();
    passed_[stage] += now - last_;
    last_ = now;
  }

  // Adds the processor time of stage k to *seconds[k]. To be called once, after the last stage.
  void add_to(const std::array<ProcessorSeconds*, kStages>& seconds) const {
    const auto all = static_cast<double>(parallel::processor_nanoseconds() - begin_);
    double sum = 0;
    for (const std::int64_t stage : passed_) sum += static_cast<double>(stage);
    if (!(sum > 0)) return;
    for (std::size_t k = 0; k < kStages; ++k)
      seconds[k]->add(static_cast<std::int64_t>(all * (static_cast<double>(passed_[k]) / sum)));
  }

 private:
  static std::int64_t passed() {
    timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
  }

  std::int64_t begin_, last_;
  std::array<std::int64_t, kStages> passed_{};
};

}  // namespace delray::raster
