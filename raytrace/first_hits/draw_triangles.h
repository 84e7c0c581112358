// Rasterizes triangles into the packets of camera rays: each block of 4 x 4 pixels that a triangle
// may be seen in is tested against it by Embree's own arithmetic.
#pragma once

#include <span>
#include <vector>

#include "raytrace/first_hits/triangle_bins.h"
#include "raytrace/scene/ray_batch.h"

namespace delray::raytrace {

// A block's rays while triangles are drawn. Their packet has the nearest hit so far.
struct DrawnBlock {
  RayGroup* group = nullptr;
  shading::Vectors16 direction;  // in the space of the triangles at hand, unless that is the world
  shading::Floats16 second;      // distance of the second nearest hit
  float beyond = 0;              // further hits make no difference
  bool came_nearer = false;      // since `beyond` was found
  shading::LaneMask unsure = 0;  // lanes that something met of which nothing is certain
  shading::LaneMask edge = 0;    // lanes whose nearest hit is not safely inside of its triangle
};

// Blocks of a rectangle of the window, row by row: (x0 + i, y0 + j) is element j * columns + i.
struct DrawnBlocks {
  int x0 = 0, y0 = 0, columns = 0, rows = 0;
  std::span<DrawnBlock> blocks;
};

// No hits yet.
void clear_drawn(RayGroup& group, DrawnBlock& block);

// REQUIRES: all triangles are of instances in this space; the blocks' groups have no hits but of
// triangles that were drawn before.
void draw_triangles(std::span<const GeometryInstance> instances, const RaySpace& space,
                    std::span<const SeenTriangle> triangles, const DrawnBlocks& blocks);

// Whether all active lanes have for certain the hit, or the miss, that Embree would find. If not,
// all get back their miss, to be traced together: Embree may find another one of two hits at nearly
// the same distance for a ray alone. All triangles that may be hit have been drawn.
bool keep_certain_hits(DrawnBlock& block);

}  // namespace delray::raytrace
