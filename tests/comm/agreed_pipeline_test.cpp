// A pipeline over ranks: whoever fails, and wherever, all ranks end with the same.
#include "comm/agreed_pipeline.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <string>
#include <vector>

#include "comm/agree_on_failure.h"
#include "comm/collectives.h"
#include "comm/failure.h"
#include "comm/threads.h"
#include "files/error.h"

namespace delray::comm {
namespace {

constexpr std::size_t kItems = 12, kSlots = 3, kCollective = 1;

// Stages of which the second sums over ranks; fail(stage, item) is called first in each.
template <class Fail>
std::vector<parallel::PipelineStage> stages_of(Communicator& communicator, std::vector<int>& sums,
                                               std::vector<int>& slots, Fail fail) {
  return {{"make", true,
           [&, fail](std::size_t item, std::size_t slot) {
             fail(0, item);
             slots[slot] = static_cast<int>(item) + communicator.rank();
           }},
          {"sum", true,
           [&, fail](std::size_t item, std::size_t slot) {
             fail(1, item);
             slots[slot] = all_reduce_value(communicator, slots[slot], std::plus<>());
           }},
          {"keep", false, [&, fail](std::size_t item, std::size_t slot) {
             fail(2, item);
             sums[item] = slots[slot];
           }}};
}

TEST(AgreedPipeline, CommunicatesForEveryItemInOrder) {
  for (const int ranks : {1, 2, 5}) {
    for (const int threads : {1, 3}) {
      run_threads(ranks, threads, [&](Communicator& communicator) {
        std::vector<int> sums(kItems, -1), slots(kSlots);
        const auto stages = stages_of(communicator, sums, slots, [](std::size_t, std::size_t) {});
        const parallel::PipelineTimes times =
            run_agreed_pipeline(communicator, kItems, kSlots, stages, kCollective);
        EXPECT_EQ(times.stages.size(), 3U);
        for (std::size_t i = 0; i < kItems; ++i)
          EXPECT_EQ(sums[i], static_cast<int>(i) * ranks + ranks * (ranks - 1) / 2);
      });
    }
  }
}

TEST(AgreedPipeline, EndsAlikeOnAllRanksWhereverOneFails) {
  for (const std::size_t stage : {0U, 2U}) {
    for (const std::size_t item : {std::size_t{0}, std::size_t{5}, kItems - 1}) {
      for (const int threads : {1, 3}) {
        SCOPED_TRACE("stage " + std::to_string(stage) + ", item " + std::to_string(item));
        std::atomic<int> ended = 0;
        std::atomic<bool> after = false;
        const auto run = [&](Communicator& communicator) {
          std::vector<int> sums(kItems, -1), slots(kSlots);
          const bool fails = communicator.rank() == 1;
          const auto stages =
              stages_of(communicator, sums, slots, [&](std::size_t s, std::size_t i) {
                if (fails && s == stage && i == item)
                  throw files::FileError(files::Cause::device, "a.png", "", "disk full");
                if (s == kCollective && i >= item + kSlots) after = true;
              });
          try {
            run_agreed_pipeline(communicator, kItems, kSlots, stages, kCollective);
          } catch (const files::FileError& error) {
            EXPECT_EQ(error.file(), "a.png");
            EXPECT_NE(dynamic_cast<const AgreedFailure*>(&error), nullptr);
            ++ended;
          }
        };
        run_threads(3, threads, run);
        EXPECT_EQ(ended, 3);
        EXPECT_FALSE(after);
      }
    }
  }
}

TEST(AgreedPipeline, FailuresOfTheCollectiveStageEndTheRun) {
  const auto run = [&](Communicator& communicator) {
    std::vector<int> sums(kItems, -1), slots(kSlots);
    const auto stages = stages_of(communicator, sums, slots, [&](std::size_t s, std::size_t i) {
      if (communicator.rank() == 1 && s == kCollective && i == 4) throw std::runtime_error("four");
    });
    run_agreed_pipeline(communicator, kItems, kSlots, stages, kCollective);
  };
  EXPECT_THROW(run_threads(3, 2, run), RankFailure);
}

TEST(AgreedPipeline, ASingleRankThrowsWhatAStageThrew) {
  const auto run = [&](Communicator& communicator) {
    std::vector<int> sums(kItems, -1), slots(kSlots);
    const auto stages = stages_of(communicator, sums, slots, [](std::size_t s, std::size_t i) {
      if (s == 2 && i == 4) throw std::invalid_argument("four");
    });
    EXPECT_THROW(run_agreed_pipeline(communicator, kItems, kSlots, stages, kCollective),
                 std::invalid_argument);
  };
  run_threads(1, 2, run);
}

}  // namespace
}  // namespace delray::comm
