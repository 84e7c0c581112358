// A kd-tree over space (Bentley 1975) with cells of nearly equal weight, and its traversal from
// front to back (Fuchs, Kedem and Naylor 1980).
//
// Each node sorts the centres along their longest extent and cuts at the one where the lower cells
// have their share of the weight. The traversal visits the side with the eye first. O(n log n log
// count) to build, O(cells) to traverse.
//
// Degenerate: boxes without a finite centre do not count; equal centres stay on one side, so that
// cells may be empty; a node without centres cuts at 0 or at the nearest border of its space.
#include "loadbalance/kd_cells.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace delray::loadbalance {
namespace {

struct WeightedCentre {
  glm::vec3 centre;
  std::uint32_t weight;
};

class Cutter {
 public:
  explicit Cutter(KdCells& result) : result_(result) {}

  void cut(std::span<WeightedCentre> items, const geometry::Box3& space, int count) {
    if (count == 1) {
      result_.cells.push_back(space);
      return;
    }
    const int lower = count / 2;
    const KdCells::Plane plane = choose(items, space, lower, count);
    result_.planes.push_back(plane);
    const auto middle = std::partition(items.begin(), items.end(), [&](const WeightedCentre& item) {
      return item.centre[plane.axis] < plane.at;
    });
    geometry::Box3 below = space, above = space;
    below.high[plane.axis] = above.low[plane.axis] = plane.at;
    cut({items.begin(), middle}, below, lower);
    cut({middle, items.end()}, above, count - lower);
  }

 private:
  // Sorts the items.
  static KdCells::Plane choose(std::span<WeightedCentre> items, const geometry::Box3& space,
                               int lower, int count) {
    if (items.empty()) return {0, std::clamp(0.0F, space.low.x, space.high.x)};
    geometry::Box3 centres;
    std::uint64_t weight = 0;
    for (const WeightedCentre& item : items) {
      centres.include(item.centre);
      weight += item.weight;
    }
    const glm::vec3 size = centres.size();
    int axis = size.y > size.x ? 1 : 0;
    if (size.z > size[axis]) axis = 2;
    std::sort(items.begin(), items.end(), [&](const WeightedCentre& a, const WeightedCentre& b) {
      return a.centre[axis] < b.centre[axis];
    });
    const std::uint64_t share =
        weight * static_cast<std::uint64_t>(lower) / static_cast<std::uint64_t>(count);
    std::uint64_t before = 0;
    for (const WeightedCentre& item : items) {
      before += item.weight;
      if (before > share) return {axis, item.centre[axis]};
    }
    return {axis, items.back().centre[axis]};
  }

  KdCells& result_;
};

void visit(const KdCells& cells, const glm::vec3& eye, int first, int count, std::size_t node,
           std::vector<int>& order) {
  if (count == 1) {
    order.push_back(first);
    return;
  }
  const int lower = count / 2;
  const KdCells::Plane& plane = cells.planes[node];
  const bool is_below = eye[plane.axis] < plane.at;
  for (const bool below : {is_below, !is_below}) {
    if (below) {
      visit(cells, eye, first, lower, node + 1, order);
    } else {
      visit(cells, eye, first + lower, count - lower, node + static_cast<std::size_t>(lower),
            order);
    }
  }
}

}  // namespace

KdCells cut_space(std::span<const geometry::Box3> boxes, std::span<const std::uint32_t> weights,
                  int count) {
  if (boxes.size() != weights.size() || count < 1)
    throw std::invalid_argument("there is at least one cell, and a weight for each box");
  std::vector<WeightedCentre> items;
  items.reserve(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const glm::vec3 centre = boxes[i].centre();
    if (glm::all(glm::lessThan(glm::abs(centre), glm::vec3(std::numeric_limits<float>::max())))) {
      items.push_back({centre, weights[i]});
    }
  }
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  KdCells result;
  Cutter(result).cut(items, {glm::vec3(-kInfinity), glm::vec3(kInfinity)}, count);
  return result;
}

std::vector<int> front_to_back(const KdCells& cells, const glm::vec3& eye) {
  std::vector<int> order;
  order.reserve(cells.cells.size());
  visit(cells, eye, 0, static_cast<int>(cells.cells.size()), 0, order);
  return order;
}

}  // namespace delray::loadbalance
