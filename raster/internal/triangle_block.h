// Sixteen triangles that are seen, in structure-of-arrays form.
#pragma once

#include <cstdint>

#include "raster/internal/draws.h"
#include "raster/internal/interpolate.h"
#include "raster/internal/seen_triangle.h"

namespace delray::raster {

inline constexpr int kBlockSize = 16;

// What is looked up: element [..][i] belongs to triangle i of the block, which may be of any draw.
struct TriangleBlock {
  alignas(64) float position[3][3][kBlockSize];  // of corner k in the mesh: x, y, z
  alignas(64) float normal[3][3][kBlockSize];
  alignas(64) float to_view[3][4][kBlockSize];          // rows
  alignas(64) float to_world[4][3][kBlockSize];         // columns
  alignas(64) float normal_to_world[3][3][kBlockSize];  // columns
  alignas(64) float handedness[kBlockSize];

  void set_draw(int i, const Draw& draw, const ShadedDraw& shaded);
  // The corners of triangle i; normals only if the mesh has some.
  void set_triangle(int i, const scenes::Mesh& mesh, const glm::uvec3& corners);
};

// What is computed, by the arithmetic of make_seen_triangle and make_barycentrics.
struct TriangleGeometry {
  // Barycentrics of triangle i.
  alignas(64) float a[3][kBlockSize], b[3][kBlockSize], c[3][kBlockSize];
  alignas(64) std::int32_t x[kBlockSize], y[kBlockSize];
  alignas(64) float geometric_normal[3][kBlockSize];
  // Of corner k in the world; without a direction of its own a normal is the geometric one.
  alignas(64) float position[3][3][kBlockSize];
  alignas(64) float normal[3][3][kBlockSize];
  // Bit i: the viewer sees corner k of triangle i from the counter-clockwise side; the two normals
  // there agree; the corner has a normal of its own.
  std::uint32_t front[3], agree[3], own_normal[3];
};

// Of all triangles of the block; what unused ones hold makes no difference to the others.
void compute_geometry(const Screen& screen, const TriangleBlock& block, TriangleGeometry& geometry);

}  // namespace delray::raster
