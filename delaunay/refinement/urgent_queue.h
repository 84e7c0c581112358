// A queue of items by a small number of urgencies.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "delaunay/refinement/triangle_shape.h"

namespace delray::delaunay::internal {

// The most urgent come first, and of these the last that came. O(1) for each step.
template <class Item>
class UrgentQueue {
 public:
  bool empty() const { return used_[0] == 0 && used_[1] == 0; }
  // REQUIRES: urgency <= kMostUrgent.
  void push(const Item& item, unsigned urgency) {
    lists_[urgency].push_back(item);
    used_[urgency / 64] |= std::uint64_t{1} << (urgency % 64);
  }
  std::size_t size() const {
    std::size_t size = 0;
    for (const auto& list : lists_) size += list.size();
    return size;
  }
  // Moves half of the items of each urgency to another queue.
  void share(UrgentQueue& other) {
    for (unsigned urgency = 0; urgency <= kMostUrgent; ++urgency) {
      for (std::size_t left = lists_[urgency].size() / 2; left > 0; --left) {
        other.push(lists_[urgency].back(), urgency);
        lists_[urgency].pop_back();
      }
    }
  }
  // REQUIRES: not empty.
  Item pop() {
    const unsigned word = used_[1] != 0 ? 1 : 0;
    const auto urgency = word * 64 + static_cast<unsigned>(63 - std::countl_zero(used_[word]));
    const Item item = lists_[urgency].back();
    lists_[urgency].pop_back();
    if (lists_[urgency].empty()) used_[word] &= ~(std::uint64_t{1} << (urgency % 64));
    return item;
  }

 private:
  static_assert(kMostUrgent < 128);
  std::array<std::vector<Item>, kMostUrgent + 1> lists_;
  std::array<std::uint64_t, 2> used_{};
};

}  // namespace delray::delaunay::internal
