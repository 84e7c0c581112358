// The triangles of a tile as planes over the screen, set up many at a time.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include "raster/pipeline/transform.h"
#include "raster/shading/interpolate.h"

namespace delray::raster {

// Four values, and the pixel that their planes are relative to.
struct alignas(64) PixelTriangle : ValuePlanes {
  float x, y, unused[2];
};
static_assert(sizeof(PixelTriangle) == 64);

// Triangles of a cluster: corner k of triangle i is vertex of[k][i].
struct CornerNumbers {
  static constexpr std::size_t kPadding = 16;  // vectors may be read past the end

  alignas(64) std::uint8_t of[3][kClusterTriangles + kPadding] = {};

  // For those that are read past the end, after `count` triangles are set.
  void pad(std::size_t count) {
    for (auto& row : of) std::fill_n(row + count, kPadding, std::uint8_t{0});
  }
};

// A bit per triangle of a cluster.
using ClusterMask = std::uint64_t[kClusterTriangles / 64];
inline bool is_in(const ClusterMask& mask, std::size_t i) { return mask[i / 64] >> i % 64 & 1; }

// Barycentrics of a tile's triangles, and the numbers of their corners.
struct TrianglePlanes {
  static constexpr std::size_t kSize = kTilePixels + 16;  // vectors may be stored past the end

  alignas(64) float a[3][kSize], b[3][kSize], c[3][kSize], x[kSize], y[kSize];
  alignas(64) std::uint32_t corner[3][kSize];

  void set(std::size_t i, const Barycentrics& barycentrics);
};

// Facing of a cluster's triangles.
struct ClusterFacing {
  ClusterMask counter_clockwise, proper;  // as in Barycentrics
  ClusterMask outside;                    // a vertex is kOutside: nothing else is set
};

// Sets `count` triangles from number `first` on, and perhaps more, up to the next multiple of 16:
// planes by make_barycentrics from the screen, and first_vertex added to the numbers of corners.
//
// REQUIRES: count <= kClusterTriangles; first + count <= kTilePixels; what `of` says is below
// vertex_count; corners are padded.
void set_up_planes(const Screen& screen, const ScreenVertices& vertices, std::size_t vertex_count,
                   const CornerNumbers& corners, std::size_t count, std::uint32_t first_vertex,
                   TrianglePlanes& planes, std::size_t first, ClusterFacing& facing);

// make_value_planes of the first triangles, as many as there are, and perhaps of some more.
//
// REQUIRES: radiances has all corners; their fourth value is 1 where it matters; triangles has room
// up to the next multiple of 16.
void set_up_colours(const TrianglePlanes& planes, std::span<const glm::vec4> radiances,
                    std::size_t count, PixelTriangle* triangles);

}  // namespace delray::raster
