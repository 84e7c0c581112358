// Triangles set up for the screen and sorted into tiles.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "raster/internal/draws.h"
#include "raster/internal/screen_triangle.h"
#include "raster/internal/transform.h"

namespace delray::raster {

// What became of the triangles that were looked at.
struct TriangleCounts {
  std::uint64_t in = 0;
  std::uint64_t culled = 0;   // off the screen, between pixel centres, without area, or facing away
  std::uint64_t clipped = 0;  // cut by the near plane or the guard band, and something was left
  std::uint64_t rasterized = 0;  // handed to at least one tile

  void operator+=(const TriangleCounts& other) {
    in += other.in;
    culled += other.culled;
    clipped += other.clipped;
    rasterized += other.rasterized;
  }
};

// The triangles of a few neighbouring clusters. Those of tile k are triangles[e & kIndex] for the
// entries e in [first[k], first[k + 1]), ascending; kMasked marks those with holes in them.
struct Bin {
  static constexpr std::uint32_t kMasked = 0x80000000U;
  static constexpr std::uint32_t kIndex = 0x7FFFFFFFU;

  std::vector<ScreenTriangle> triangles;
  std::vector<std::uint32_t> first;  // one more than tiles; empty when there are no triangles
  std::vector<std::uint32_t> entries;
  TriangleCounts counts;

  std::span<const std::uint32_t> of_tile(int tile) const {
    if (first.empty()) return {};
    return std::span(entries).subspan(first[tile], first[tile + 1] - first[tile]);
  }
};

// A draw with what setup needs of it.
struct PreparedDraw {
  const Draw* draw = nullptr;
  ToView to_view;
  const ScreenVertex* vertices = nullptr;  // element i is vertex draw->first_vertex + i of the mesh
  bool masked = false;                     // holes are cut by alpha
  int hidden_side = 0;                     // sign of the area that is not drawn; 0: both are
};

// Sets up clusters [begin, end) of `list` and sorts them into the tiles for which `wanted` is not 0
// (size: screen.tiles()). Reuses the memory of `bin`. One thread.
void fill_bin(const Screen& screen, const DrawList& list, std::span<const PreparedDraw> draws,
              std::uint32_t begin, std::uint32_t end, std::span<const std::uint8_t> wanted,
              Bin& bin);

// The pixels that the box of triangles [first, first + count) of a draw touches, clipped to the
// frame, and how many of them may be seen. For costs: exact where nothing is clipped.
struct Extent {
  geometry::Rect box;
  std::uint64_t triangles = 0;
  std::uint64_t pixels = 0;  // of the triangles' own areas, rounded up to one each
};
Extent extent(const Screen& screen, const PreparedDraw& draw, std::uint32_t first,
              std::uint32_t count);

}  // namespace delray::raster
