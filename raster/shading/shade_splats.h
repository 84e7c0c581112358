// Colours of points and segments.
#pragma once

#include "raster/shading/shade_tile.h"

namespace delray::raster {

inline bool is_splat(const FrameShading& frame, std::uint32_t number) {
  return frame.draws[frame.list.cluster_of(number).draw].splats.any();
}

// The point of a splat at a pixel that it covers. REQUIRES: is_splat.
SeenPoint splat_point(const FrameShading& frame, std::uint32_t number, int x, int y);

// Whether the draw's splats show one colour each, whatever the light.
bool is_plain(const shading::Shader& shader, const Draw& draw);

// As shade_tile, where all draws are plain. REQUIRES: frame.all_plain.
template <class Colour>
std::uint64_t shade_plain_splats(const FrameShading& frame, const VisibilityTile& tile,
                                 const geometry::Rect& rect, const Window<Colour>& window);

}  // namespace delray::raster
