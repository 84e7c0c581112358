// The triangles that rays from the camera may hit, by the squares of the picture.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "geometry/rect.h"
#include "raytrace/first_hits/ray_space.h"
#include "raytrace/scene/ray.h"

namespace delray::raytrace {

// A triangle that rays may hit through the blocks [x0, x1) x [y0, y1) of the window, and no others.
struct SeenTriangle {
  std::uint32_t instance = 0, triangle = 0;
  float nearest = 0;  // no hit that Embree computes is nearer
  std::uint16_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;

  int blocks() const { return (x1 - x0) * (y1 - y0); }
};

// The window of a view, cut into blocks of kBlockSide pixels.
struct SeenWindow {
  const scenes::View& view;
  geometry::Rect pixels;
  float longest = 1;    // direction of a ray
  bool centred = true;  // rays go through centres of pixels; else anywhere through them
};

// Appends triangles [first, last) of an instance that rays of the window may hit, by Embree's own
// arithmetic, in any block where they may. Sixteen at a time. O(triangles).
void find_seen(const GeometryInstance& instance, std::uint32_t number, const RaySpace& space,
               const SeenWindow& window, std::uint32_t first, std::uint32_t last,
               std::vector<SeenTriangle>& seen);

inline constexpr int kBinSide = 16;  // pixels
inline constexpr int kBinBlocks = kBinSide / kBlockSide;
inline constexpr int kSquareBlocks = kBinBlocks * kBinBlocks;

// A triangle in one of the squares.
struct BinnedTriangle {
  std::uint32_t instance, triangle;
  float nearest;         // as above
  std::uint32_t blocks;  // bit kBinBlocks * y + x: it may be hit through block (x, y)
};

// Triangles by squares of kBinSide pixels of the window, row by row.
struct TriangleBins {
  int columns = 0, rows = 0;
  std::vector<std::uint32_t> first;  // one more than squares
  std::unique_ptr<BinnedTriangle[]> triangles;
  std::vector<std::uint32_t> blocks;  // by square: how many blocks its triangles may be seen in

  std::size_t square(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(x);
  }
  std::span<const BinnedTriangle> of(std::size_t square) const {
    return {triangles.get() + first[square], triangles.get() + first[square + 1]};
  }
};

// Triangles of lists whose nearest ones are nearer come first. Parallel: each thread walks through
// all triangles and sorts those of some rows of squares. O(t threads + s), where s sums the squares
// of each triangle. Throws std::length_error for 2^32 of them.
TriangleBins bin_triangles(std::vector<std::vector<SeenTriangle>>&& seen,
                           const geometry::Rect& window);

}  // namespace delray::raytrace
