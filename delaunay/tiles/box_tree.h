// A tree of boxes that finds those among many that something touches.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "geometry/box.h"

namespace delray::delaunay {

// A binary tree, halved at the median of the longest axis. Memory O(boxes).
template <class Point>
class BoxTree {
 public:
  using Box = geometry::Box<Point>;

  // Empty boxes are never found. O(n log^2 n).
  explicit BoxTree(std::span<const Box> boxes) : boxes_(boxes.begin(), boxes.end()) {
    for (std::uint32_t i = 0; i < boxes_.size(); ++i) {
      if (!boxes_[i].empty()) order_.push_back(i);
    }
    nodes_.resize(order_.empty() ? 0 : 2 * order_.size() - 1);
    if (!order_.empty()) build(0, 0, order_.size());
  }

  // Calls found(i) for every box i that `touches` is true for; it must be true for every box that
  // holds one for which it is. O(log n) for each that is found.
  template <class Touches, class Found>
  void find(const Touches& touches, const Found& found) const {
    if (!order_.empty()) find(0, 0, order_.size(), touches, found);
  }

  // Whether `wanted(i)` is true for any of these boxes.
  template <class Touches, class Wanted>
  bool any(const Touches& touches, const Wanted& wanted) const {
    return !order_.empty() && any(0, 0, order_.size(), touches, wanted);
  }

 private:
  // The node of order_[first, last). Its lower half follows it, then the upper one.
  void build(std::size_t node, std::size_t first, std::size_t last) {
    Box box;
    for (std::size_t i = first; i < last; ++i) box.include(boxes_[order_[i]]);
    nodes_[node] = box;
    if (last - first == 1) return;
    const Point size = box.size();
    int axis = 0;
    for (int k = 1; k < Point::length(); ++k) {
      if (size[k] > size[axis]) axis = k;
    }
    const std::size_t middle = first + (last - first) / 2;
    std::nth_element(order_.begin() + static_cast<std::ptrdiff_t>(first),
                     order_.begin() + static_cast<std::ptrdiff_t>(middle),
                     order_.begin() + static_cast<std::ptrdiff_t>(last),
                     [&](std::uint32_t a, std::uint32_t b) {
                       return boxes_[a].centre()[axis] < boxes_[b].centre()[axis];
                     });
    build(node + 1, first, middle);
    build(node + 2 * (middle - first), middle, last);
  }
  template <class Touches, class Found>
  void find(std::size_t node, std::size_t first, std::size_t last, const Touches& touches,
            const Found& found) const {
    if (!touches(nodes_[node])) return;
    if (last - first == 1) {
      found(order_[first]);
      return;
    }
    const std::size_t middle = first + (last - first) / 2;
    find(node + 1, first, middle, touches, found);
    find(node + 2 * (middle - first), middle, last, touches, found);
  }

  template <class Touches, class Wanted>
  bool any(std::size_t node, std::size_t first, std::size_t last, const Touches& touches,
           const Wanted& wanted) const {
    if (!touches(nodes_[node])) return false;
    if (last - first == 1) return wanted(order_[first]);
    const std::size_t middle = first + (last - first) / 2;
    return any(node + 1, first, middle, touches, wanted) ||
           any(node + 2 * (middle - first), middle, last, touches, wanted);
  }

  std::vector<Box> boxes_, nodes_;
  std::vector<std::uint32_t> order_;
};

}  // namespace delray::delaunay
