// Finding the leaf of the history that a point lies in.
#pragma once

#include <glm/glm.hpp>

#include "delaunay/dag.h"
#include "delaunay/orientation.h"

namespace delray::delaunay {

// The nodes of the first triangle and the ghosts around it, which tile the plane.
constexpr NodeNumber kRoots = 4;

// The root that contains q. REQUIRES: the roots are nodes 0 to 3, the triangle first.
NodeNumber root_of(const Dag<2>& dag, const Orientation& orientation, const glm::dvec2& q);

// The leaf below `node` that contains q, its boundary included. May run while other threads insert:
// what it returns was a leaf when it was read. Children must be as subdivide() and legalize() lay
// them out (internal/dag_flip.h). Expected O(log n) from a root if the points came in random order.
//
// REQUIRES: q lies in `node`, its boundary included.
NodeNumber descend(const Dag<2>& dag, const Orientation& orientation, NodeNumber node,
                   const glm::dvec2& q);

}  // namespace delray::delaunay
