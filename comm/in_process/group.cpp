// Splits a group: the last rank that posts sorts all requests by colour, key and rank and makes a
// group of each colour. O(n log n).
#include "comm/in_process/group.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace delray::comm::internal {

void Group::post_split(int rank, int color, int key) {
  const std::scoped_lock lock(mutex_);
  requests_[rank].color = color;
  requests_[rank].key = key;
  if (++posted_ < requests_.size()) return;
  posted_ = 0;

  std::vector<int> order(requests_.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return std::tuple(requests_[a].color, requests_[a].key, a) <
           std::tuple(requests_[b].color, requests_[b].key, b);
  });
  for (std::size_t first = 0; first < order.size();) {
    std::size_t last = first;
    std::vector<int> members;
    while (last < order.size() && requests_[order[last]].color == requests_[order[first]].color) {
      members.push_back(world_ranks[order[last++]]);
    }
    const auto group = std::make_shared<Group>(std::move(members));
    for (std::size_t i = first; i < last; ++i) {
      requests_[order[i]].result = {group, static_cast<int>(i - first)};
    }
    first = last;
  }
}

Group::Membership Group::take_split(int rank) {
  const std::scoped_lock lock(mutex_);
  return std::move(requests_[rank].result);
}

}  // namespace delray::comm::internal
