// Which rank has at hand what a tile shows.
#pragma once

#include <cstdint>

#include "raytrace/integrators/tiled_frame.h"
#include "raytrace/shared_scene.h"

namespace delray::raytrace {

// The rank that a few rays from the camera through the tile come to first, by boxes alone; `rank`,
// whose part `scene` is, where that has as many of those clusters at hand, or none is in the way.
// O(log clusters) where little overlaps.
int owner_of_tile(const TiledFrame& frame, const SharedScene& scene, int rank, std::uint32_t tile);

}  // namespace delray::raytrace
