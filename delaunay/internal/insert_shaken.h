// Insertion of one point where other threads may change what was acquired, instead of giving way.
#pragma once

#include <vector>

#include "delaunay/dag_location.h"
#include "delaunay/internal/dag_flip.h"
#include "delaunay/internal/dag_run.h"
#include "delaunay/internal/insertion_phases.h"

namespace delray::delaunay::internal {

// Cuts what contains the vertex; kShaken also if that is no leaf any more.
template <class Access>
Grant open_leaf(DagRun<2>& run, const DagTriangulation<2>& triangulation, NodeNumber leaf,
                VertexNumber vertex, Access& access, std::vector<NodeNumber>& suspects,
                InsertionPhases& phases) {
  const Dag<2>& dag = triangulation.dag;
  const Grant grant = access.acquire({leaf});
  if (grant != Grant::kGranted) return grant;
  if (!dag.is_leaf(leaf)) return Grant::kShaken;
  phases.located();
  const glm::dvec2& q = run.point(vertex);
  const VertexNumber equal = run.equal_vertex(leaf, q);
  if (equal != kInfiniteVertex) {
    run.merge(equal, vertex);
    return Grant::kGranted;
  }
  for (unsigned k = 0; k < 3; ++k) {
    const CornerNumber corner = corner_of(leaf, k);
    const VertexNumber first = dag.vertex(next_corner(corner)),
                       last = dag.vertex(previous_corner(corner));
    if (triangulation.orientation(first, last, q) == 0) {
      return split_edge(triangulation, corner, vertex, access, suspects);
    }
  }
  return subdivide(triangulation, leaf, vertex, access, suspects);
}

// REQUIRES: the node contains the point; the access policy shakes and never refuses; `suspects` is
// empty and will be again.
template <class Access>
void insert_shaken(DagRun<2>& run, const DagTriangulation<2>& triangulation, NodeNumber node,
                   VertexNumber vertex, Access& access, std::vector<NodeNumber>& suspects,
                   InsertionPhases& phases) {
  do {
    node = descend(triangulation.dag, triangulation.orientation, node, run.point(vertex));
  } while (open_leaf(run, triangulation, node, vertex, access, suspects, phases) !=
           Grant::kGranted);
  phases.subdivided();
  legalize(triangulation, access, suspects);
  phases.legalized();
}

}  // namespace delray::delaunay::internal
