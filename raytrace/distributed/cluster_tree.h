// The upper part of the hierarchy, which every rank has: which clusters a ray may meet, and in what
// order.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "geometry/box.h"

namespace delray::raytrace {

// A box of a cluster; one has as many as it is placed.
struct ClusterBox {
  geometry::Box3 box;
  std::uint32_t cluster = 0;
};

// Where a ray enters a cluster first.
struct ClusterHit {
  float entry = 0.0F;
  std::uint32_t cluster = 0;
  bool operator<(const ClusterHit& b) const {
    return entry != b.entry ? entry < b.entry : cluster < b.cluster;
  }
  bool operator==(const ClusterHit&) const = default;
};

class ClusterTree {
 public:
  ClusterTree() = default;
  // The same boxes in the same order give the same tree on every rank. O(n log n).
  explicit ClusterTree(std::vector<ClusterBox> boxes);

  // Replaces `cluster_hits` by the clusters that points origin + t * direction, near <= t <= far,
  // may touch, by (entry, number), each once. The same on every rank. O(log n + cluster_hits).
  void find(const glm::vec3& origin, const glm::vec3& direction, float near, float far,
            std::vector<ClusterHit>& cluster_hits) const;

  geometry::Box3 bounds() const { return nodes_.empty() ? geometry::Box3() : nodes_[0].box; }

  std::uint64_t bytes() const {
    return boxes_.capacity() * sizeof(ClusterBox) + nodes_.capacity() * sizeof(Node);
  }

 private:
  struct Node {
    geometry::Box3 box;
    std::uint32_t first = 0, count = 0;  // of boxes, where it is a leaf
    std::uint32_t left = 0, right = 0;   // nodes, where it is none
  };
  std::uint32_t build(std::uint32_t first, std::uint32_t count);

  std::vector<ClusterBox> boxes_;
  std::vector<Node> nodes_;
};

}  // namespace delray::raytrace
