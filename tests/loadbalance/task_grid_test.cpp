// Blocks cover the frame, and queues hand out each task once.
#include "loadbalance/task_grid.h"

#include <gtest/gtest.h>

#include <vector>

#include "loadbalance/schedules/task_queue.h"

namespace delray::loadbalance {
namespace {

using geometry::Rect;

TEST(Blocks, CoverTheFrameExactlyOnce) {
  for (const Rect frame : {Rect{0, 0, 64, 32}, Rect{-5, 3, 44, 50}, Rect{1, 1, 2, 2}, Rect{}}) {
    for (const auto& [width, height] : {std::pair{16, 16}, {3, 3}, {1000, 1}, {1, 7}}) {
      const Blocks blocks{frame, width, height};
      std::vector<int> count(static_cast<std::size_t>(frame.area()));
      for (std::uint32_t task = 0; task < blocks.grid().count(); ++task) {
        const Rect block = blocks.block(task);
        EXPECT_FALSE(block.empty());
        for (int y = block.y0; y < block.y1; ++y) {
          for (int x = block.x0; x < block.x1; ++x) {
            ++count[static_cast<std::size_t>((y - frame.y0) * frame.width() + x - frame.x0)];
          }
        }
      }
      for (const int times : count) ASSERT_EQ(times, 1);
    }
  }
  EXPECT_EQ((Blocks{{0, 0, 100, 50}, 100, 1}).grid().count(), 50U);
}

TEST(TaskQueue, GivesEveryTaskOnceFromBothEnds) {
  internal::TaskQueue queue;
  const TaskRange ranges[] = {{0, 5}, {7, 7}, {10, 12}, {20, 21}};
  queue.put(ranges);
  EXPECT_EQ(queue.size(), 8U);
  EXPECT_EQ(queue.pop(1), (TaskRange{0, 1}));
  EXPECT_EQ(queue.take_back(2), (std::vector<TaskRange>{{11, 12}, {20, 21}}));
  EXPECT_EQ(queue.take_front(4), (std::vector<TaskRange>{{1, 5}}));
  EXPECT_EQ(queue.take_back(9), (std::vector<TaskRange>{{10, 11}}));
  EXPECT_EQ(queue.size(), 0U);
  EXPECT_EQ(queue.pop(5).count(), 0U);
  EXPECT_TRUE(queue.take_front(1).empty());
}

}  // namespace
}  // namespace delray::loadbalance
