// Pipelines keep order and slots, and end with what a stage throws.
#include "parallel/pipeline.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

#include "parallel/arena.h"
#include "parallel/parallel_for.h"

namespace delray::parallel {
namespace {

class Pipeline : public testing::TestWithParam<int> {
 protected:
  template <class F>
  void in_arena(F&& f) {
    const AllowThreads allowed(GetParam());
    Arena arena(GetParam());
    arena.execute(f);
  }
};

TEST_P(Pipeline, PassesEveryItemThroughAllStagesAndKeepsSlotsApart) {
  constexpr std::size_t kItems = 200, kSlots = 3;
  std::vector<int> slots(kSlots, -1), stages_done(kItems, 0);
  std::vector<std::size_t> first, last;
  std::atomic<int> inside = 0, most = 0;
  const std::vector<PipelineStage> stages = {
      {"enter", true,
       [&](std::size_t item, std::size_t slot) {
         most = std::max(most.load(), ++inside);
         EXPECT_EQ(slots[slot], -1) << item;
         slots[slot] = static_cast<int>(item);
         first.push_back(item);
         ++stages_done[item];
       }},
      {"work", false,
       [&](std::size_t item, std::size_t slot) {
         std::atomic<int> sum = 0;
         parallel_for(0, 64, 1, [&](std::size_t) { ++sum; });
         EXPECT_EQ(sum, 64);
         EXPECT_EQ(slots[slot], static_cast<int>(item));
         ++stages_done[item];
       }},
      {"leave", true, [&](std::size_t item, std::size_t slot) {
         EXPECT_EQ(stages_done[item], 2);
         slots[slot] = -1;
         last.push_back(item);
         --inside;
       }}};
  in_arena([&] {
    const PipelineTimes times = run_pipeline(kItems, kSlots, stages);
    EXPECT_EQ(times.stages.size(), 3U);
    EXPECT_GE(times.seconds, 0);
  });
  ASSERT_EQ(last.size(), kItems);
  EXPECT_EQ(first, last);
  for (std::size_t i = 0; i < kItems; ++i) EXPECT_EQ(last[i], i);
  EXPECT_LE(most, static_cast<int>(kSlots));
}

TEST_P(Pipeline, EndsWithWhatAStageThrows) {
  std::atomic<int> after = 0;
  const std::vector<PipelineStage> stages = {
      {"work", true,
       [](std::size_t item, std::size_t) {
         if (item == 5) throw std::runtime_error("five");
       }},
      {"leave", true, [&](std::size_t, std::size_t) { ++after; }}};
  in_arena([&] { EXPECT_THROW(run_pipeline(100, 4, stages), std::runtime_error); });
  EXPECT_LE(after, 5);
}

// Gives up after a while, for where a second thread does not come.
void wait_for(const std::atomic<bool>& flag) {
  for (int i = 0; i < 200 && !flag; ++i)
    std::this_thread::sleep_for(std::chrono::microseconds(100));
}

TEST_P(Pipeline, LoopsOfOtherStagesAreWholeThoughOneThrows) {
  std::atomic<bool> looping = false, thrown = false;
  const std::vector<PipelineStage> stages = {
      {"loop", true,
       [&](std::size_t item, std::size_t) {
         std::atomic<int> steps = 0;
         if (item > 0) {
           looping = true;
           wait_for(thrown);
           std::this_thread::sleep_for(std::chrono::milliseconds(2));
         }
         parallel_for(0, 1000, 1, [&](std::size_t) { ++steps; });
         EXPECT_EQ(steps, 1000);
       }},
      {"throw", false, [&](std::size_t, std::size_t) {
         if (GetParam() > 1) wait_for(looping);
         thrown = true;
         throw std::runtime_error("at once");
       }}};
  in_arena([&] { EXPECT_THROW(run_pipeline(100, 4, stages), std::runtime_error); });
}

TEST(PipelineSlots, OneSlotPassesOneItemAfterTheOther) {
  std::vector<int> order;
  const auto stage = [&](int number) {
    return PipelineStage{"", false, [&order, number](std::size_t item, std::size_t slot) {
                           EXPECT_EQ(slot, 0U);
                           order.push_back(static_cast<int>(item) * 2 + number);
                         }};
  };
  const std::vector<PipelineStage> stages = {stage(0), stage(1)};
  Arena(3).execute([&] { run_pipeline(10, 1, stages); });
  for (int i = 0; i < 20; ++i) EXPECT_EQ(order.at(static_cast<std::size_t>(i)), i);
}

TEST_P(Pipeline, NeedsNoItems) {
  const std::vector<PipelineStage> stages = {
      {"never", true, [](std::size_t, std::size_t) { FAIL(); }}};
  in_arena([&] {
    const PipelineTimes times = run_pipeline(0, 2, stages);
    EXPECT_EQ(times.stages[0], 0);
    EXPECT_EQ(predicted_seconds(times, 0), 0);
  });
}

INSTANTIATE_TEST_SUITE_P(Threads, Pipeline, testing::Values(1, 2, 5));

TEST(PipelineTimes, FollowTheReportsFormulas) {
  const PipelineTimes times = {{10, 30, 20}, 0};
  EXPECT_EQ(sequential_seconds(times), 60);
  EXPECT_EQ(predicted_seconds(times, 10), 6 + 9 * 3);
  EXPECT_EQ(predicted_seconds(times, 1), 60);
}

}  // namespace
}  // namespace delray::parallel
