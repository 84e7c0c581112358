// Insertion of one point by a thread that is alone with the leaves.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "delaunay/flip/dag_flip_2d.h"
#include "delaunay/history/dag_location.h"
#include "delaunay/history/dag_run.h"
#include "delaunay/history/sole_dag_access.h"
#include "delaunay/insertion/insertion_phases.h"
#include "delaunay/insertion/point_supply.h"
#include "delaunay/mesh/add_counts.h"

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

// Goes down the history to the leaf of a point and inserts it there.
template <int D>
void insert_from_root(DagRun<D>& run, const DagTriangulation<D>& triangulation, VertexNumber vertex,
                      SoleDagAccess<D>& access, std::vector<NodeNumber>& suspects,
                      InsertionPhases& phases) {
  phases.next_point();
  if (run.is_first(vertex)) return;
  const auto& q = run.point(vertex);
  const NodeNumber leaf = descend(triangulation.dag, triangulation.orientation,
                                  root_of(triangulation.dag, triangulation.orientation, q), q);
  phases.located();
  insert_in_leaf(run, triangulation, leaf, vertex, access, suspects, phases);
}

// The maximum number of points of a part that insert_alone() inserts.
template <int D>
std::size_t points_alone(const DagRun<D>& run, std::size_t part) {
  // With some thousand triangles threads seldom conflict; most of few points are left to the
  // threads.
  constexpr std::size_t kPoints = 1024, kShare = 16;
  return std::min((run.end(part) - run.begin(part)) / kShare, kPoints / run.parts());
}

// Inserts the first points of every part: in a small triangulation threads would only be in each
// other's way. Returns the others.
template <int D>
PointSupply insert_alone(DagRun<D>& run, const DagTriangulation<D>& triangulation) {
  PointSupply others(run.parts());
  SoleDagAccess<D> access(triangulation.dag, 0);
  InsertionPhases phases(run.options, run.statistics);
  std::vector<NodeNumber> suspects;
  for (std::size_t part = 0; part < run.parts(); ++part) {
    const std::size_t end = run.begin(part) + points_alone(run, part);
    for (auto vertex = static_cast<VertexNumber>(run.begin(part)); vertex < end; ++vertex) {
      insert_from_root(run, triangulation, vertex, access, suspects, phases);
    }
    others.set(part, end, run.end(part));
  }
  phases.finish();
  if (run.options.statistics) add(run.statistics.flips, access.flips());
  return others;
}

}  // namespace delray::delaunay::internal
