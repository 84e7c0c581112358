// A Delaunay simplex to begin with, of points that are not triangulated yet.
#pragma once

#include <array>
#include <optional>

#include "delaunay/construction/apex_search.h"
#include "delaunay/mesh/mesh.h"

namespace delray::delaunay::internal {

// A simplex of the Delaunay triangulation with point 0 as its corner 0, positively oriented;
// nothing if all points are equal, collinear or (in space) coplanar.
//
// The first simplex of independent points is replaced for every point in its ball by the one of
// both that holds what is about corner 0 in a fixed direction: a step down the lifted points' lower
// hull (the dual simplex method of linear programming). O(n) a pass, few passes.
template <int D>
std::optional<std::array<VertexNumber, D + 1>> first_delaunay_simplex(const ApexSearch<D>& search);

extern template std::optional<std::array<VertexNumber, 3>> first_delaunay_simplex(
    const ApexSearch<2>&);
extern template std::optional<std::array<VertexNumber, 4>> first_delaunay_simplex(
    const ApexSearch<3>&);

}  // namespace delray::delaunay::internal
