// Processor time by clock_gettime. The quick form adds the time that has passed since the system
// was asked last to what it said then, and never goes back.
#include "parallel/processor_time.h"

#include <time.h>

#include <algorithm>

namespace delray::parallel {
namespace {

constexpr std::int64_t kUnasked = 200'000;  // ns

std::int64_t nanoseconds(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

// When the system was asked, and what it said.
struct Asked {
  std::int64_t when = -kUnasked, answer = 0, last = 0;
};

}  // namespace

std::int64_t processor_nanoseconds() { return nanoseconds(CLOCK_THREAD_CPUTIME_ID); }

std::int64_t quick_processor_nanoseconds() {
  thread_local Asked asked;
  const std::int64_t now = nanoseconds(CLOCK_MONOTONIC);
  if (now - asked.when >= kUnasked) {
    asked.when = now;
    asked.answer = processor_nanoseconds();
  }
  asked.last = std::max(asked.last, asked.answer + (now - asked.when));
  return asked.last;
}

}  // namespace delray::parallel
