// Rays from the camera.
#pragma once

#include <vector>

#include "geometry/rect.h"
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

// How far to the right of the view's axis the rays of blocks pass, and how far above it, at
// distance 1: columns and rows of blocks have these in common where all rays go through the same
// places.
struct PrimarySteps {
  std::vector<shading::Floats16> right, up;  // by column, by row

  // Of the blocks of these pixels.
  void set(const scenes::View& view, const geometry::Rect& pixels, const PrimaryPlaces& places);
};

// A group that is filled with the rays of the block of pixels whose first one is (x, y).
struct PrimaryBlock {
  int x, y;
  const PrimaryPlaces& places;
  const shading::Floats16 &right, &up;  // PrimarySteps of the places
  shading::LaneMask mask;
  // The group has had rays of the same view from here before, and nothing but hits were written to
  // it since: what rays of the view have in common is there.
  bool again;
};

// Distances along the rays are depths along the view axis.
void set_primary_rays(const scenes::View& view, const PrimaryBlock& block, RayGroup& group);

}  // namespace delray::raytrace
