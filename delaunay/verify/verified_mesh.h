// A mesh as the verifier sees it, and the objections that it may raise.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "delaunay/mesh/facets.h"
#include "delaunay/points.h"
#include "delaunay/predicates.h"
#include "parallel/parallel_for.h"

namespace delray::delaunay::internal {

constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();
constexpr std::size_t kVerifyGrain = 4096;  // simplices or points: some tenths of a millisecond

// The lowest i of [0, n) for which bad(i), or kAll.
template <class Bad>
std::size_t find_first(std::size_t n, Bad&& bad) {
  return parallel::parallel_reduce(
      0, n, kVerifyGrain, kAll,
      [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
          if (bad(i)) return i;
        }
        return kAll;
      },
      [](std::size_t a, std::size_t b) { return std::min(a, b); });
}

inline std::string row(std::uint64_t vertex) { return "row " + std::to_string(vertex); }

// Something to say against a triangulation; `simplex` is kAll where it is about no single one.
struct Objection {
  std::size_t simplex = kAll;
  std::string reason;
};
using Check = std::optional<Objection>;

inline int turn_of(const std::array<glm::dvec2, 3>& p) { return orient2d(p[0], p[1], p[2]); }
inline int turn_of(const std::array<glm::dvec3, 4>& p) { return orient3d(p[0], p[1], p[2], p[3]); }

// The simplices with each vertex replaced by the lowest row of its equals. Facet number
// (D + 1) t + i is the one of simplex t opposite to its vertex i.
template <int D>
struct VerifiedMesh {
  static constexpr std::size_t kCorners = D + 1;
  using Point = glm::vec<D, double, glm::defaultp>;

  PointView<double> points;
  std::span<const std::uint32_t> given;
  std::vector<std::uint32_t> lowest;    // per row
  std::vector<std::uint32_t> vertices;  // kCorners per simplex
  std::size_t distinct = 0;
  FacetMates facets;
  PointView<std::uint64_t> rows{};  // of the points in the whole input; none: their numbers

  std::string row(std::size_t vertex) const {
    return internal::row(rows.size() == 0 ? vertex : rows(vertex, 0));
  }
  std::size_t size() const { return given.size() / kCorners; }
  Point at(std::size_t i) const {
    Point p;
    for (int k = 0; k < D; ++k) p[k] = points(i, k);
    return p;
  }
  std::array<Point, kCorners> corners(std::size_t simplex) const {
    std::array<Point, kCorners> result;
    for (std::size_t k = 0; k < kCorners; ++k) result[k] = at(vertices[simplex * kCorners + k]);
    return result;
  }
  // An edge from its start to its end, the triangle on its left; a face counterclockwise as seen
  // from outside the tetrahedron.
  std::array<std::uint32_t, D> outward(std::size_t facet) const {
    const std::uint32_t* v = vertices.data() + (facet - facet % kCorners);
    if constexpr (D == 2) {
      return {v[(facet + 1) % 3], v[(facet + 2) % 3]};
    } else {
      constexpr std::uint8_t kFaces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
      const std::uint8_t* face = kFaces[facet % 4];
      return {v[face[0]], v[face[1]], v[face[2]]};
    }
  }
};

// Whether the facets without a mate are the surface of one convex body, passed once.
Check check_hull(const VerifiedMesh<2>& mesh);
Check check_hull(const VerifiedMesh<3>& mesh);

}  // namespace delray::delaunay::internal
