// Points with what walks and tests of conflict need to know of them, in either dimension.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "delaunay/flip/flip_3d.h"
#include "delaunay/insertion/insertion_start.h"
#include "delaunay/insertion/orientation_3d.h"
#include "delaunay/insertion/walk.h"
#include "delaunay/mesh/mesh.h"
#include "delaunay/predicates/conflict.h"

namespace delray::delaunay::internal {

template <int D>
class PointSpace;

template <>
class PointSpace<2> {
 public:
  // `first` are vertices of a triangle that turns left. REQUIRES: `points` outlives it.
  PointSpace(std::span<const glm::dvec2> points, const std::array<VertexNumber, 3>& first)
      : points_(points), orientation_(points, first) {}

  bool conflicts(const Mesh<2>& mesh, SimplexNumber t, VertexNumber v) const {
    return conflict(mesh, points_, t, points_[v]);
  }
  SimplexNumber walk_to(const Mesh<2>& mesh, SimplexNumber start, VertexNumber v,
                        std::uint32_t& random) const {
    return walk(mesh, points_, start, points_[v], random).simplex;
  }
  // Whether v is strictly beyond the facet opposite to corner k, of ghosts too.
  bool is_beyond(const Mesh<2>& mesh, SimplexNumber t, unsigned k, VertexNumber v) const {
    return orientation_(mesh.vertex(t, (k + 1) % 3), mesh.vertex(t, (k + 2) % 3), points_[v]) < 0;
  }

 private:
  std::span<const glm::dvec2> points_;
  Orientation<2> orientation_;
};

template <>
class PointSpace<3> {
 public:
  // `first` are vertices of a positively oriented tetrahedron. O(points).
  PointSpace(std::span<const glm::dvec3> points, const std::array<VertexNumber, 4>& first)
      : orientation_(points, first) {}

  bool conflicts(const Mesh<3>& mesh, SimplexNumber t, VertexNumber v) const {
    return conflict(mesh, orientation_, t, orientation_.point(v));
  }
  SimplexNumber walk_to(const Mesh<3>& mesh, SimplexNumber start, VertexNumber v,
                        std::uint32_t& random) const {
    return walk(mesh, orientation_, start, orientation_.point(v), random).simplex;
  }
  bool is_beyond(const Mesh<3>& mesh, SimplexNumber t, unsigned k, VertexNumber v) const {
    const std::array vertices = {mesh.vertex(t, 0), mesh.vertex(t, 1), mesh.vertex(t, 2),
                                 mesh.vertex(t, 3)};
    return orientation_.with(orientation_.point(v), k, vertices) < 0;
  }

 private:
  Orientation<3> orientation_;
};

}  // namespace delray::delaunay::internal
