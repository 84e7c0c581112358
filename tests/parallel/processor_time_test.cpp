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

}  // namespace
}  // namespace delray::parallel
