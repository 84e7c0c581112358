// Flips that make a triangulation Delaunay which insertions have left nearly so.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "delaunay/flip/dag_flip_2d.h"
#include "delaunay/flip/dag_flip_3d.h"

namespace delray::delaunay::internal {

// Flips edges that are not locally Delaunay until there are none, which ends at the one
// triangulation that has none (Lawson 1977), and returns how many leaves were replaced. All edges
// are looked at, by so many threads; they are flipped by one. O(leaves) if few are wrong.
//
// REQUIRES: no thread inserts, and all have abandoned what they did not use; the leaves are a
// triangulation without flat triangles.
std::uint64_t repair(const DagTriangulation<2>& triangulation, std::size_t threads);

// Flips facets likewise. In space such flips may get stuck before they are done: then none.
std::optional<std::uint64_t> repair(const DagTriangulation<3>& triangulation, std::size_t threads);

}  // namespace delray::delaunay::internal
