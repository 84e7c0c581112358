// Insertion into tetrahedra that leaves the history behind; as dag_flip_2d.h does with triangles.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "delaunay/flip/dag.h"
#include "delaunay/flip/dag_flip_2d.h"
#include "delaunay/flip/flip_3d.h"
#include "delaunay/insertion/orientation_3d.h"

namespace delray::delaunay::internal {

template <>
struct DagTriangulation<3> {
  Dag<3>& dag;
  std::span<const glm::dvec3> points;
  Orientation<3> orientation;
};

// See Flips3d. Suspects are corners of the new vertex.
template <class Access>
Grant subdivide(const DagTriangulation<3>& triangulation, NodeNumber leaf, VertexNumber vertex,
                Access& access, std::vector<CornerNumber>& suspects) {
  return Flips3d(triangulation.dag, triangulation.orientation, access, suspects)
      .subdivide(leaf, vertex);
}

template <class Access>
Grant legalize(const DagTriangulation<3>& triangulation, Access& access,
               std::vector<CornerNumber>& suspects) {
  return Flips3d(triangulation.dag, triangulation.orientation, access, suspects).legalize();
}

}  // namespace delray::delaunay::internal
