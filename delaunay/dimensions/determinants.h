// Signs of determinants of points in any dimension.
#pragma once

#include <array>

namespace delray::delaunay::internal {

template <int D>
using PlaceNd = std::array<double, D>;

// The sign of det(p1 - p0, ..., pD - p0). Exact for finite doubles. O(D 2^D).
template <int D>
int orientation_nd(const std::array<const PlaceNd<D>*, D + 1>& points);

// +1 if q is inside the sphere through D + 1 positively oriented points, -1 outside, 0 on it.
// Exact.
template <int D>
int in_sphere_nd(const std::array<const PlaceNd<D>*, D + 1>& points, const PlaceNd<D>& q);

// Whether q counts as inside, by the perturbation of predicates/conflict.h where it is on the
// sphere. REQUIRES: positively oriented points; q is none of them.
template <int D>
bool conflict_nd(const std::array<const PlaceNd<D>*, D + 1>& points, const PlaceNd<D>& q);

}  // namespace delray::delaunay::internal
