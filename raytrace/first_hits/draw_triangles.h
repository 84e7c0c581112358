// Rasterizes triangles into the packets of camera rays: each block of 4 x 4 pixels that a triangle
// may be seen in is tested against it by Embree's own arithmetic.
#pragma once

#include <span>

#include "raytrace/first_hits/triangle_bins.h"
#include "raytrace/scene/ray_batch.h"

namespace delray::raytrace {

// A block's rays while triangles are drawn. Their packet has the nearest hit so far.
struct DrawnBlock {
  RayGroup* group = nullptr;
  shading::Vectors16 direction;  // in the space of the triangles at hand
  shading::Floats16 second;      // distance of the second nearest hit
  shading::LaneMask unsure = 0;  // lanes that something met of which nothing is certain
  shading::LaneMask edge = 0;    // lanes whose nearest hit is not safely inside of its triangle
};

// A square of the window; block b is bit b of BinnedTriangle::blocks.
struct DrawnSquare {
  DrawnBlock blocks[kSquareBlocks];
  shading::Floats16 beyond;         // element b: hits in block b that are further away do not count
  shading::LaneMask drawn = 0;      // blocks that have a group of rays
  shading::LaneMask unlimited = 0;  // those of them whose `beyond` is not the least it could be

  void clear();
  // Of rays without hits yet.
  void add(int block, RayGroup& group);
};

// REQUIRES: the groups of the square have no hits but of triangles that were drawn before.
void draw_triangles(const RaySpaces& scene, std::span<const BinnedTriangle> triangles,
                    DrawnSquare& square);

// The number of active lanes if all have for certain the hit, or the miss, that Embree would find.
// If not, 0, and all get back their miss, to be traced together: Embree may find another one of two
// hits at nearly the same distance for a ray alone. All triangles that may be hit have been drawn.
int keep_certain_hits(DrawnBlock& block);

}  // namespace delray::raytrace
