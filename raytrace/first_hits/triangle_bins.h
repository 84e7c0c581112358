// The triangles that rays from the camera may hit, by the squares of the picture.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "geometry/rect.h"
#include "raytrace/first_hits/ray_space.h"
#include "raytrace/scene/ray.h"

namespace delray::raytrace {

// The window of a view, cut into blocks of kBlockSide pixels.
struct SeenWindow {
  const scenes::View& view;
  geometry::Rect pixels;
  float longest = 1;    // direction of a ray
  bool centred = true;  // rays go through centres of pixels; else anywhere through them
};

inline constexpr int kBinSide = 16;  // pixels
inline constexpr int kBinBlocks = kBinSide / kBlockSide;
inline constexpr int kSquareBlocks = kBinBlocks * kBinBlocks;

// The blocks of a square that a triangle may be hit through: bit kBinBlocks * y + x is block
// (x, y), and the bits from kSquareBlocks on are how many there are.
using BlocksOfSquare = std::uint32_t;
inline int count(BlocksOfSquare blocks) { return static_cast<int>(blocks >> kSquareBlocks); }

// A triangle that rays may hit in one or up to four squares, once for each of them.
struct TriangleInSquare {
  std::uint32_t square, triangle;
  float nearest;  // no hit that Embree computes is nearer
  BlocksOfSquare blocks;
};
// One that reaches further: through the blocks [x0, x1) x [y0, y1) of the window, and no others.
struct WideTriangle {
  std::uint32_t triangle = 0;
  float nearest = 0;
  std::uint16_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

// What may be hit of some triangles of an instance.
struct SeenTriangles {
  std::uint32_t instance = 0;
  float nearest = std::numeric_limits<float>::infinity();  // of all
  std::vector<TriangleInSquare> in_squares;
  std::vector<WideTriangle> wide;
};

// Triangles [first, last) of an instance that rays of the window may hit, by Embree's own
// arithmetic, in any block where they may. Sixteen at a time. O(triangles).
SeenTriangles find_seen(const GeometryInstance& instance, std::uint32_t number,
                        const RaySpace& space, const SeenWindow& window, std::uint32_t first,
                        std::uint32_t last);

// A triangle in one of the squares.
struct BinnedTriangle {
  std::uint32_t instance, triangle;
  float nearest;  // as above
  BlocksOfSquare blocks;
};

// Squares of kBinSide pixels, row by row, the last ones reaching over the window.
inline int squares_along(int pixels) { return (pixels + kBinSide - 1) / kBinSide; }

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

// Of parts whose nearest triangle is nearer the triangles come first. Parallel: threads share out
// the parts. O(s + squares threads) work, where s sums the squares of each triangle. Throws
// std::length_error for 2^32 of them.
TriangleBins bin_triangles(std::span<const SeenTriangles> seen, const geometry::Rect& window);

}  // namespace delray::raytrace
