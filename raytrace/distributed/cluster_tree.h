// The upper part of the hierarchy: which clusters of other ranks a ray may meet, and in what order.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <span>
#include <vector>

#include "geometry/box.h"

namespace delray::raytrace {

// A box of a cluster; one has as many as it is placed.
struct ClusterBox {
  geometry::Box3 box;
  std::uint32_t cluster = 0;
};

inline constexpr std::uint32_t kNoCluster = 0xFFFFFFFFU;

// Where a ray enters a box of a cluster.
struct ClusterHit {
  float entry = 0.0F;
  std::uint32_t cluster = 0;
  bool operator<(const ClusterHit& b) const {
    return entry != b.entry ? entry < b.entry : cluster < b.cluster;
  }
  bool operator==(const ClusterHit&) const = default;
};

// Points origin + t * direction, near <= t <= far.
struct Line {
  glm::vec3 origin, inverse;  // inverse: 1 / direction
  float near, far;
};

// Lines side by side: element i of each array is of line i, of those in `active`.
struct LinePacket {
  static constexpr int kLines = 16;

  const float* origin[3];
  const float* direction[3];
  const float *near, *far;
  std::uint32_t active;  // a mask
};

// A bounding volume hierarchy over boxes.
class ClusterTree {
 public:
  ClusterTree() = default;
  // O(n log n).
  explicit ClusterTree(std::vector<ClusterBox> boxes);

  bool empty() const { return rows_.empty(); }

  // The first hit after `after` of those that the line has with boxes, in ascending order; cluster
  // kNoCluster where there is none. What a box's hit is depends on the box and the line alone, so
  // that all ranks agree on the order, whatever is in their trees. O(log n) for lines that meet
  // little.
  ClusterHit next(const Line& line, const ClusterHit& after) const;

  // Which of the active lines have a hit. Fastest where none has and they are close to each other.
  std::uint32_t hit_lines(const LinePacket& lines) const;

  std::uint64_t bytes() const { return rows_.capacity() * sizeof(Row); }

  static constexpr int kWidth = 8;
  // Boxes side by side, lane by lane, with what is in them.
  struct alignas(32) Row {
    float low[3][kWidth], high[3][kWidth];
    std::uint32_t child[kWidth];         // a row; of the lanes in `leaves`, a cluster
    std::uint32_t leaves = 0, used = 0;  // masks of lanes
  };

 private:
  std::uint32_t build(std::span<ClusterBox> boxes);

  std::vector<Row> rows_;
};

}  // namespace delray::raytrace
