// Tasks that wait, in ranges.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "loadbalance/task_grid.h"

namespace delray::loadbalance::internal {

class TaskQueue {
 public:
  std::uint64_t size() const { return size_; }

  void put(std::span<const TaskRange> ranges) {
    for (const TaskRange& range : ranges) {
      if (range.first >= range.last) continue;
      ranges_.push_back(range);
      size_ += range.count();
    }
  }
  void clear() {
    ranges_.clear();
    size_ = 0;
  }

  // Up to `most` consecutive tasks from the front; none where none wait. REQUIRES: most >= 1.
  TaskRange pop(std::uint64_t most) {
    if (size_ == 0) return {};
    TaskRange& front = ranges_.front();
    const auto count = static_cast<std::uint32_t>(std::min<std::uint64_t>(most, front.count()));
    const TaskRange taken{front.first, front.first + count};
    front.first += count;
    if (front.first == front.last) ranges_.pop_front();
    size_ -= count;
    return taken;
  }

  // Up to `amount` tasks from the front, or from the back.
  std::vector<TaskRange> take_front(std::uint64_t amount) {
    std::vector<TaskRange> taken;
    while (amount > 0 && size_ > 0) {
      taken.push_back(pop(amount));
      amount -= taken.back().count();
    }
    return taken;
  }
  std::vector<TaskRange> take_back(std::uint64_t amount) {
    std::vector<TaskRange> taken;
    while (amount > 0 && size_ > 0) {
      TaskRange& back = ranges_.back();
      const auto count = static_cast<std::uint32_t>(std::min<std::uint64_t>(amount, back.count()));
      taken.push_back({back.last - count, back.last});
      back.last -= count;
      if (back.first == back.last) ranges_.pop_back();
      size_ -= count;
      amount -= count;
    }
    std::reverse(taken.begin(), taken.end());
    return taken;
  }

 private:
  std::deque<TaskRange> ranges_;  // none empty
  std::uint64_t size_ = 0;
};

}  // namespace delray::loadbalance::internal
