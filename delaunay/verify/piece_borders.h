// What lies on the borders of pieces, and what others have of it.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

#include "delaunay/tiles.h"
#include "delaunay/verify/findings.h"
#include "delaunay/verify/local_checks.h"
#include "delaunay/verify/place.h"

namespace delray::delaunay::internal {

template <int D>
bool place_precedes(const glm::vec<D, double>& a, const glm::vec<D, double>& b) {
  for (int k = 0; k < D; ++k) {
    if (a[k] != b[k]) return a[k] < b[k];
  }
  return false;
}

// A facet with nothing on its other side in its piece, and its simplex: the outward corners of the
// facet (VerifiedMesh::outward()), then the corner opposite to it.
template <int D>
struct BorderFacet {
  using Point = glm::vec<D, double>;
  std::array<Point, D + 1> corners;
  std::array<std::uint64_t, D + 1> rows;
  PieceSimplex of;

  // Corners in an order that is positive.
  std::array<Point, D + 1> simplex() const {
    std::array<Point, D + 1> p = corners;
    // A triangle lies to the left of its edges; a tetrahedron is behind its faces.
    if constexpr (D == 3) std::swap(p[0], p[1]);
    return p;
  }
  // A sum, which does not depend on the order of the corners.
  std::uint64_t key() const {
    std::uint64_t sum = 0;
    for (int k = 0; k < D; ++k) sum += bits_of_place<D>(corners[k]);
    return mix_bits(sum);
  }
};

// Pairs facets of the same places with their simplices on different sides: whoever numbers the same
// place in two ways has not made two of it. Calls pair(first, second) for each, the first being
// that of the simplex that comes first, and left(facet) for those that find none. Which are matched
// where there are more than two depends on their simplices alone. O(n log n).
template <int D, class Pair, class Left>
void match_borders(std::span<const BorderFacet<D>> facets, Pair&& pair, Left&& left) {
  struct Side {
    std::array<typename BorderFacet<D>::Point, D> places;  // ascending
    std::size_t facet;
    bool odd;  // whether sorting has turned the facet round
  };
  const auto order = [&](const Side& side) {
    const BorderFacet<D>& facet = facets[side.facet];
    return std::tie(facet.of.piece, facet.of.simplex, facet.rows);
  };
  std::vector<Side> sides(facets.size());
  for (std::size_t i = 0; i < facets.size(); ++i) {
    Side& side = sides[i];
    std::copy_n(facets[i].corners.begin(), D, side.places.begin());
    side.facet = i;
    side.odd = false;
    for (int a = 0; a < D; ++a) {
      for (int b = a + 1; b < D; ++b) side.odd ^= place_precedes<D>(side.places[b], side.places[a]);
    }
    std::ranges::sort(side.places, place_precedes<D>);
  }
  std::ranges::sort(sides, [&](const Side& a, const Side& b) {
    for (int k = 0; k < D; ++k) {
      if (a.places[k] != b.places[k]) return place_precedes<D>(a.places[k], b.places[k]);
    }
    if (a.odd != b.odd) return b.odd;
    return order(a) < order(b);
  });
  for (std::size_t first = 0, last = 0; first < sides.size(); first = last) {
    std::size_t odd = first;
    while (last < sides.size() && sides[last].places == sides[first].places) {
      odd += sides[last++].odd ? 0 : 1;
    }
    std::size_t even = first;
    const std::size_t evens = odd;
    for (; even < evens && odd < last; ++even, ++odd) {
      const bool in_order = order(sides[even]) < order(sides[odd]);
      const std::size_t one = sides[even].facet, other = sides[odd].facet;
      pair(facets[in_order ? one : other], facets[in_order ? other : one]);
    }
    for (; even < evens; ++even) left(facets[sides[even].facet]);
    for (; odd < last; ++odd) left(facets[sides[odd].facet]);
  }
}

// A vertex on borders, which several pieces have, and a simplex that has it.
struct BorderVertex {
  RowPoint point;
  PieceSimplex of;
};

// Calls f(vertices) for those of each place, by ascending rows, heights and simplices. O(n log n).
template <int D, class F>
void for_places(std::span<BorderVertex> vertices, F&& f) {
  using Point = glm::vec<D, double>;
  const auto place = [](const BorderVertex& vertex) {
    return without_signed_zeros<D>(Point(vertex.point.position));
  };
  std::ranges::sort(vertices, [&](const BorderVertex& a, const BorderVertex& b) {
    const Point p = place(a), q = place(b);
    if (p != q) return place_precedes<D>(p, q);
    return std::tie(a.point.row, a.point.position.z, a.of.piece, a.of.simplex) <
           std::tie(b.point.row, b.point.position.z, b.of.piece, b.of.simplex);
  });
  for (std::size_t first = 0, last = 0; first < vertices.size(); first = last) {
    while (last < vertices.size() && place(vertices[last]) == place(vertices[first])) ++last;
    f(std::span<const BorderVertex>(vertices).subspan(first, last - first));
  }
}

}  // namespace delray::delaunay::internal
