// Vertices of a mesh in the world, as lighting wants them.
#pragma once

#include <cstdint>
#include <span>

#include "raster/shading/seen_triangle.h"

namespace delray::raster {

// By the arithmetic of make_seen_triangle.
struct WorldVertices {
  static constexpr std::size_t kPadding = 16;  // vectors may be stored past the end

  alignas(64) float position[3][kClusterVertices + kPadding];
  alignas(64) float normal[3][kClusterVertices + kPadding];
  std::uint8_t has_normal[kClusterVertices + kPadding];  // else it is (0, 0, 1)
};

// Element i of the result is vertex which[i] of the draw's mesh. Runs in the calling thread.
//
// REQUIRES: 1 <= which.size() <= kClusterVertices.
void to_world(const Draw& draw, const ShadedDraw& shaded, std::span<const std::uint32_t> which,
              WorldVertices& vertices);

}  // namespace delray::raster
