// Insertion of one point by a thread that is alone with the leaves.
#pragma once

#include <vector>

#include "delaunay/internal/dag_flip.h"
#include "delaunay/internal/dag_run.h"
#include "delaunay/internal/insertion_phases.h"
#include "delaunay/internal/sole_dag_access.h"

namespace delray::delaunay::internal {

// REQUIRES: the leaf contains the point; `suspects` is empty and will be again.
template <int D>
void insert_in_leaf(DagRun<D>& run, const DagTriangulation<D>& triangulation, NodeNumber leaf,
                    VertexNumber vertex, SoleDagAccess<D>& access,
                    std::vector<NodeNumber>& suspects, InsertionPhases& phases) {
  const VertexNumber equal = run.equal_vertex(leaf, run.point(vertex));
  if (equal != kInfiniteVertex) {
    run.merge(equal, vertex);
    return;
  }
  subdivide(triangulation, leaf, vertex, access, suspects);
  phases.subdivided();
  legalize(triangulation, access, suspects);
  phases.legalized();
}

}  // namespace delray::delaunay::internal
