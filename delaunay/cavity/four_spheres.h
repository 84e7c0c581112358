// Sphere tests, four at a time in vector registers.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "delaunay/mesh/mesh.h"
#include "delaunay/order/curve_order_3d.h"
#include "delaunay/predicates/sphere_tests.h"

namespace delray::delaunay::internal {

// Bit i of `inside`: whether simplex i is in conflict. Where `undecided` has it, the rounding may
// have exceeded the error bounds, and `inside` says nothing.
struct FourConflicts {
  unsigned inside, undecided;
};

// Which of four finite simplices of `mesh` conflict with q, a point of the mesh that is no vertex
// of them; vertex v lies at vertices[v + 1]. Decides what the first two stages of `tests` decide,
// and ties where those are exact. The simplices may be equal.
using TestFourSpheres = FourConflicts (*)(const SphereTests& tests, const SpaceVertex* vertices,
                                          const Mesh<3>& mesh, const SimplexNumber* simplices,
                                          const glm::dvec3& q);

// The function for the instruction set of this machine.
TestFourSpheres test_four_spheres();

}  // namespace delray::delaunay::internal
