#include "parallel/pipeline.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
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
