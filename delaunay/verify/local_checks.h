// Conditions on single simplices and on pairs at a facet, which the verifiers of whole meshes and
// of meshes in pieces share.
#pragma once

#include <algorithm>
#include <array>
#include <string>

#include "delaunay/verify/verified_mesh.h"

namespace delray::delaunay::internal {

template <int D>
struct Words;
template <>
struct Words<2> {
  static constexpr const char *simplex = "triangle", *simplices = "triangles", *facet = "edge",
                              *flat = "collinear", *mirrored = "it is oriented clockwise",
                              *ball = "circumcircle";
};
template <>
struct Words<3> {
  static constexpr const char *simplex = "tetrahedron", *simplices = "tetrahedra", *facet = "face",
                              *flat = "coplanar", *mirrored = "it is negatively oriented",
                              *ball = "circumsphere";
};

// The rule about ties is written for verifiers alone: an error in that of the triangulations must
// not repeat itself here.
template <class Point>
bool before(const Point& a, const Point& b) {
  for (int k = 0; k < Point::length(); ++k) {
    if (a[k] != b[k]) return a[k] < b[k];
  }
  return false;
}

inline int in_ball(const std::array<glm::dvec2, 3>& p, const glm::dvec2& q) {
  return incircle(p[0], p[1], p[2], q);
}
inline int in_ball(const std::array<glm::dvec3, 4>& p, const glm::dvec3& q) {
  return insphere(p[0], p[1], p[2], p[3], q);
}

// REQUIRES: corners are positively oriented; q is on their circumsphere and none of them.
template <class Point, std::size_t N>
bool counts_as_inside(const std::array<Point, N>& corners, const Point& q) {
  std::array<std::size_t, N + 1> order;
  for (std::size_t i = 0; i <= N; ++i) order[i] = i;
  const auto point = [&](std::size_t i) { return i == N ? q : corners[i]; };
  std::ranges::sort(order,
                    [&](std::size_t i, std::size_t j) { return before(point(j), point(i)); });
  for (const std::size_t i : order) {
    if (i == N) return false;
    std::array<Point, N> replaced = corners;
    replaced[i] = q;
    const int sign = turn_of(replaced);
    if (sign != 0) return sign > 0;
  }
  return false;
}

inline bool collinear(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return orient2d(a, b, c) == 0;
}
inline bool collinear(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  return collinear({a.x, a.y}, {b.x, b.y}, glm::dvec2(c.x, c.y)) &&
         collinear({a.y, a.z}, {b.y, b.z}, glm::dvec2(c.y, c.z)) &&
         collinear({a.z, a.x}, {b.z, b.x}, glm::dvec2(c.z, c.x));
}

template <int D>
Check check_orientation(const VerifiedMesh<D>& mesh) {
  const std::size_t bad =
      find_first(mesh.size(), [&](std::size_t t) { return turn_of(mesh.corners(t)) <= 0; });
  if (bad == kAll) return std::nullopt;
  return Objection{bad, turn_of(mesh.corners(bad)) == 0
                            ? std::string("its vertices are ") + Words<D>::flat
                            : Words<D>::mirrored};
}

template <int D>
std::string facet_name(const VerifiedMesh<D>& mesh, std::size_t facet) {
  const auto v = mesh.outward(facet);
  std::string text = std::string("the ") + Words<D>::facet + " between ";
  for (int k = 0; k < D; ++k) text += (k == 0 ? "" : k + 1 < D ? ", " : " and ") + mesh.row(v[k]);
  return text;
}

// Whether two facets with the same vertices have their simplices on the same side.
template <int D>
bool same_side(const VerifiedMesh<D>& mesh, std::size_t facet, std::size_t mate) {
  const auto a = mesh.outward(facet), b = mesh.outward(mate);
  const auto shift = std::ranges::find(b, a[0]) - b.begin();
  return D == 2 ? shift == 0 : b[(shift + 1) % D] == a[1];
}

template <int D>
Check check_facets(const VerifiedMesh<D>& mesh) {
  const std::size_t crowded = mesh.facets.crowded;
  if (crowded != FacetMates::kNone) {
    return Objection{crowded / (D + 1),
                     facet_name(mesh, crowded) + " has three " + Words<D>::simplices + " or more"};
  }
  const std::size_t bad = find_first(mesh.vertices.size(), [&](std::size_t facet) {
    const std::uint32_t mate = mesh.facets.mates[facet];
    return mate != FacetMates::kNone && same_side(mesh, facet, mate);
  });
  if (bad == kAll) return std::nullopt;
  return Objection{bad / (D + 1), std::string(Words<D>::simplex) + " " +
                                      std::to_string(mesh.facets.mates[bad] / (D + 1)) +
                                      " lies on the same side of " + facet_name(mesh, bad)};
}

// The first facets, as seen from the lower of their simplices, that break the two properties.
struct BadBalls {
  std::size_t inside = kAll;  // the opposite vertex of the neighbour is inside
  std::size_t tie = kAll;     // it is on the circumsphere and counts as inside
};

// Both simplices at a facet are positively oriented, so what holds on one side of it holds on the
// other.
template <int D>
BadBalls find_bad_balls(const VerifiedMesh<D>& mesh) {
  return parallel::parallel_reduce(
      0, mesh.vertices.size(), kVerifyGrain, BadBalls{},
      [&](std::size_t first, std::size_t last) {
        BadBalls bad;
        for (std::size_t facet = first; facet < last; ++facet) {
          const std::uint32_t mate = mesh.facets.mates[facet];
          if (mate == FacetMates::kNone || mate < facet) continue;
          const auto corners = mesh.corners(facet / (D + 1));
          const auto q = mesh.at(mesh.vertices[mate]);
          const int sign = in_ball(corners, q);
          if (sign > 0) bad.inside = std::min(bad.inside, facet);
          if (sign == 0 && counts_as_inside(corners, q)) bad.tie = std::min(bad.tie, facet);
        }
        return bad;
      },
      [](const BadBalls& a, const BadBalls& b) {
        return BadBalls{std::min(a.inside, b.inside), std::min(a.tie, b.tie)};
      });
}

}  // namespace delray::delaunay::internal
