// Where the points of tiles lie.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "delaunay/tiles.h"
#include "delaunay/tiles/box_tree.h"
#include "geometry/box.h"

namespace delray::delaunay {

// What all other tiles are told of a tile from the start. With the extreme points nobody's hull
// sees half of the world.
struct TileSummary {
  geometry::Box3d box;  // tight; empty without points; z is 0 in 2D
  RowPoint extremes[6];
  std::uint64_t extreme_count = 0;

  // Of equal points the one with the lowest row is extreme: it represents them.
  void include(const RowPoint& point, int dim);
  void include(const TileSummary& other, int dim);
};

// The boxes of all tiles, by number.
class TileBoxes {
 public:
  explicit TileBoxes(std::span<const TileSummary> summaries);

  const geometry::Box3d& operator[](std::size_t tile) const { return boxes_[tile]; }
  std::size_t size() const { return boxes_.size(); }
  template <int D>
  const BoxTree<glm::vec<D, double>>& tree() const {
    if constexpr (D == 2) {
      return plane_;
    } else {
      return space_;
    }
  }

 private:
  std::vector<geometry::Box3d> boxes_;
  BoxTree<glm::dvec2> plane_;
  BoxTree<glm::dvec3> space_;
};

// The tiles that a region of the tiles [first, last) may have to tell.
struct OtherTiles {
  const TileBoxes& boxes;
  std::size_t first = 0, last = 0;

  bool has(std::size_t tile) const { return tile < first || tile >= last; }
};

}  // namespace delray::delaunay
