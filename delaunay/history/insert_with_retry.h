// Insertion of one point where other threads may change what was acquired, instead of giving way.
#pragma once

#include <vector>

#include "delaunay/flip/dag_flip_2d.h"
#include "delaunay/flip/dag_flip_3d.h"
#include "delaunay/history/dag_location.h"
#include "delaunay/history/dag_run.h"
#include "delaunay/insertion/insertion_phases.h"

namespace delray::delaunay::internal {

// Subdivides without ever leaving a flat simplex. REQUIRES: as subdivide().
template <class Access>
Grant subdivide_exactly(const DagTriangulation<2>& triangulation, NodeNumber leaf,
                        VertexNumber vertex, Access& access, std::vector<NodeNumber>& suspects) {
  const Dag<2>& dag = triangulation.dag;
  const glm::dvec2& q = triangulation.points[vertex];
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
template <class Access>
Grant subdivide_exactly(const DagTriangulation<3>& triangulation, NodeNumber leaf,
                        VertexNumber vertex, Access& access, std::vector<NodeNumber>& suspects) {
  return subdivide(triangulation, leaf, vertex, access, suspects);
}

// Subdivides the leaf that contains the vertex; kRetry also if it is no leaf any more.
template <int D, class Access>
Grant open_leaf(DagRun<D>& run, const DagTriangulation<D>& triangulation, NodeNumber leaf,
                VertexNumber vertex, Access& access, std::vector<NodeNumber>& suspects,
                InsertionPhases& phases) {
  const Dag<D>& dag = triangulation.dag;
  const Grant grant = access.acquire({leaf});
  if (grant != Grant::kGranted) return grant;
  if (!dag.is_leaf(leaf)) return Grant::kRetry;
  phases.located();
  const VertexNumber equal = run.equal_vertex(leaf, run.point(vertex));
  if (equal != kInfiniteVertex) {
    run.merge(equal, vertex);
    return Grant::kGranted;
  }
  return subdivide_exactly(triangulation, leaf, vertex, access, suspects);
}

// REQUIRES: the node contains the point; the access policy may say kRetry and never refuses;
// `suspects` is empty and will be again.
template <int D, class Access>
void insert_with_retry(DagRun<D>& run, const DagTriangulation<D>& triangulation, NodeNumber node,
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
