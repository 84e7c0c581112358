// Local improvement of a triangulation in space.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "delaunay/improve.h"
#include "delaunay/mesh/mesh.h"

namespace delray::delaunay::internal {

struct FacetFlips {
  FlipCounts flips;
  std::vector<CornerNumber> blocked;  // opposite to the facets that no flip can replace
};

// Flips facets between tetrahedra whose spheres hold each other's fourth corner, until there is
// none that can be flipped (Joe 1989): 2 by 3, 3 by 2, and where four corners are in one plane 4 by
// 4, of which on the hull two are ghosts.
//
// REQUIRES: the finite tetrahedra fill the convex hull of the points, ghosts are linked with each
// other too, no slot is dead.
FacetFlips flip_facets(Mesh<3>& mesh, std::span<const glm::dvec3> points);

}  // namespace delray::delaunay::internal
