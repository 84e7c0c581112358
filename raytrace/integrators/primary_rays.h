// Rays from the camera.
#pragma once

#include "raytrace/scene/ray_batch.h"
#include "scenes/camera.h"

namespace delray::raytrace {

// Where the rays of a block start and pass: positions from the pixels' top left corners, and points
// of the unit disc for the lens, which count only where the view has one.
struct PrimaryPlaces {
  shading::Floats16 x, y, lens_x, lens_y;

  void set(const glm::vec2& position) {
    for (int i = 0; i < kPacketRays; ++i) set_position(i, position);
  }
  void set_position(int i, const glm::vec2& position) { x[i] = position.x, y[i] = position.y; }
  void set_lens(int i, const glm::vec2& point) { lens_x[i] = point.x, lens_y[i] = point.y; }
};

// Fills a group with the rays of the block of pixels whose first one is (x, y). Distances along the
// rays are depths along the view axis.
void set_primary_rays(const scenes::View& view, int x, int y, const PrimaryPlaces& places,
                      shading::LaneMask mask, RayGroup& group);

}  // namespace delray::raytrace
