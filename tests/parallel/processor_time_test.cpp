// Processor time stands still while a thread sleeps.
#include "parallel/processor_time.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <thread>

namespace delray::parallel {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000;

void work_for(std::int64_t nanoseconds) {
  for (const std::int64_t end = processor_nanoseconds() + nanoseconds;
       processor_nanoseconds() < end;) {
  }
}

TEST(ProcessorTime, DoesNotPassWhileTheThreadSleeps) {
  std::int64_t (*const clocks[])() = {processor_nanoseconds, quick_processor_nanoseconds};
  for (const auto clock : clocks) {
    const std::int64_t begin = clock();
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    EXPECT_LT(clock() - begin, 10 * kMillisecond);
    work_for(20 * kMillisecond);
    EXPECT_GE(clock() - begin, 20 * kMillisecond - kMillisecond / 5);
  }
}

TEST(ProcessorTime, IsQuicklyToldWithinAFifthOfAMillisecondAndNeverFalls) {
  std::int64_t before = quick_processor_nanoseconds();
  for (int i = 0; i < 2000; ++i) {
    const std::int64_t least = processor_nanoseconds();
    const std::int64_t told = quick_processor_nanoseconds();
    const std::int64_t most = processor_nanoseconds();
    EXPECT_GE(told, before);
    EXPECT_GE(told, least - kMillisecond / 5);
    EXPECT_LE(told, most + kMillisecond / 5);
    before = told;
    if (i % 100 == 0) std::this_thread::sleep_for(std::chrono::microseconds(i));
  }
}

// Sleeping is no waiting for a core; waiting never falls.
TEST(ProcessorTime, WaitingForACoreIsToldFromSleeping) {
  const auto before = core_wait_nanoseconds();
  if (!before) GTEST_SKIP() << "the system does not tell";
  const auto begin = std::chrono::steady_clock::now();
  const std::int64_t processor = processor_nanoseconds();
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  const std::int64_t waited = *core_wait_nanoseconds() - *before;
  const std::int64_t used = processor_nanoseconds() - processor;
  const std::int64_t passed =
      std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now() - begin)
          .count();
  EXPECT_GE(waited, 0);
  EXPECT_LE(waited, passed - used - 50 * kMillisecond + kMillisecond);
}

}  // namespace
}  // namespace delray::parallel
