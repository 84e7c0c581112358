// Finding the leaf of the history that a point lies in.
#pragma once

#include <glm/glm.hpp>

#include "delaunay/flip/dag.h"
#include "delaunay/predicates/orientation.h"

namespace delray::delaunay {

// The nodes of the first simplex and the ghosts around it, which tile all that there is: 0 to here.
template <int D>
constexpr NodeNumber kRoots = D + 2;

// The root that contains q. REQUIRES: the roots are the first nodes, the simplex before the ghosts.
NodeNumber root_of(const Dag<2>& dag, const Orientation<2>& orientation, const glm::dvec2& q);
NodeNumber root_of(const Dag<3>& dag, const Orientation<3>& orientation, const glm::dvec3& q);

// The leaf below `node` that contains q, its boundary included. May run while other threads insert:
// what it returns was a leaf when it was read. Children must be as subdivide() and legalize() lay
// them out (dag_flip_2d.h, flip_3d.h). Expected O(log n) from a root if the points came in
// random order.
//
// REQUIRES: q lies in `node`, its boundary included.
NodeNumber descend(const Dag<2>& dag, const Orientation<2>& orientation, NodeNumber node,
                   const glm::dvec2& q);
NodeNumber descend(const Dag<3>& dag, const Orientation<3>& orientation, NodeNumber node,
                   const glm::dvec3& q);

// A leaf that contained q when it was read, found by walking from a leaf below `start` over edges
// or facets that q lies beyond (Devillers, Pion, Teillaud 2002); or kNoNode if the way was long, or
// lost in what other threads are doing. O(1) for a start nearby.
NodeNumber walk_to(const Dag<2>& dag, const Orientation<2>& orientation, NodeNumber start,
                   const glm::dvec2& q);
NodeNumber walk_to(const Dag<3>& dag, const Orientation<3>& orientation, NodeNumber start,
                   const glm::dvec3& q);

}  // namespace delray::delaunay
