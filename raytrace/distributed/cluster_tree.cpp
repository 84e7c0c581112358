// A bounding volume hierarchy over the boxes of clusters, built by median splits along the longest
// side of the centres.
//
// A query collects every box that the line meets, then sorts by where it enters; of a cluster
// placed several times the first entry counts. Slabs are widened by what division rounds off. O(n
// log n) to build, O(log n + crossings) to search.
//
// Degenerate: equal centres are ordered by number; a line in the plane of a side is decided by the
// other axes; an empty tree crosses nothing.
#include "raytrace/distributed/cluster_tree.h"

#include <algorithm>
#include <limits>

namespace delray::raytrace {
namespace {

constexpr std::uint32_t kLeaf = 4;  // boxes

// What dividing and multiplying may round off.
constexpr float kLess = 1.0F - 0x1p-20F, kMore = 1.0F + 0x1p-20F;

struct Line {
  glm::vec3 origin, inverse;
  float near, far;
};

// Where the line enters the box, at least `near`; infinity where it misses.
float entry_of(const geometry::Box3& box, const Line& line) {
  float low = line.near, high = line.far;
  for (int k = 0; k < 3; ++k) {
    const float a = (box.low[k] - line.origin[k]) * line.inverse[k];
    const float b = (box.high[k] - line.origin[k]) * line.inverse[k];
    // A line in the plane of a side gives a number that is none, which decides nothing.
    const float first = std::min(a, b), last = std::max(a, b);
    const float in = first * (first > 0.0F ? kLess : kMore);
    const float out = last * (last > 0.0F ? kMore : kLess);
    if (a != a || b != b) continue;
    low = std::max(low, in);
    high = std::min(high, out);
  }
  return low <= high ? low : std::numeric_limits<float>::infinity();
}

glm::vec3 centre_of(const geometry::Box3& box) { return box.centre(); }

}  // namespace

ClusterTree::ClusterTree(std::vector<ClusterBox> boxes) : boxes_(std::move(boxes)) {
  nodes_.reserve(boxes_.size());
  if (!boxes_.empty()) build(0, static_cast<std::uint32_t>(boxes_.size()));
}

std::uint32_t ClusterTree::build(std::uint32_t first, std::uint32_t count) {
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back();
  geometry::Box3 box, centres;
  for (std::uint32_t i = first; i < first + count; ++i) {
    box.include(boxes_[i].box.low);
    box.include(boxes_[i].box.high);
    centres.include(centre_of(boxes_[i].box));
  }
  nodes_[index].box = box;
  nodes_[index].first = first;
  nodes_[index].count = count;
  if (count <= kLeaf) return index;
  const glm::vec3 size = centres.high - centres.low;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const auto begin = boxes_.begin() + first;
  std::nth_element(begin, begin + count / 2, begin + count,
                   [axis](const ClusterBox& a, const ClusterBox& b) {
                     const float x = centre_of(a.box)[axis], y = centre_of(b.box)[axis];
                     return x != y ? x < y : a.cluster < b.cluster;
                   });
  nodes_[index].count = 0;
  const std::uint32_t left = build(first, count / 2);
  const std::uint32_t right = build(first + count / 2, count - count / 2);
  nodes_[index].left = left;
  nodes_[index].right = right;
  return index;
}

void ClusterTree::find(const glm::vec3& origin, const glm::vec3& direction, float near, float far,
                       std::vector<ClusterHit>& cluster_hits) const {
  cluster_hits.clear();
  if (nodes_.empty()) return;
  const Line line{origin, glm::vec3(1.0F) / direction, near, far};
  constexpr float kMissed = std::numeric_limits<float>::infinity();
  std::uint32_t stack[64];
  int height = 0;
  stack[height++] = 0;
  while (height > 0) {
    const Node& node = nodes_[stack[--height]];
    if (entry_of(node.box, line) == kMissed) continue;
    if (node.count == 0) {
      stack[height++] = node.left;
      stack[height++] = node.right;
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const float entry = entry_of(boxes_[i].box, line);
      if (entry != kMissed) cluster_hits.push_back({entry, boxes_[i].cluster});
    }
  }
  std::sort(cluster_hits.begin(), cluster_hits.end());
  // Of a cluster that is placed several times the first cluster_hit counts.
  std::size_t kept = 0;
  for (std::size_t i = 0; i < cluster_hits.size(); ++i) {
    bool known = false;
    for (std::size_t j = 0; j < kept && !known; ++j)
      known = cluster_hits[j].cluster == cluster_hits[i].cluster;
    if (!known) cluster_hits[kept++] = cluster_hits[i];
  }
  cluster_hits.resize(kept);
}

}  // namespace delray::raytrace
