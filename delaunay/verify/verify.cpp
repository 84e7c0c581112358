// Verification of triangulations: local conditions whose conjunction proves the global ones
// (Mehlhorn et al. 1999, Delaunay 1934).
//
// Checked in this order: rows exist; orientation; at most two simplices at a facet, on opposite
// sides; a convex boundary (check_hull()); every distinct point is used; empty circumspheres across
// facets; lowest rows; the rule for ties (Devillers and Teillaud 2011). Each check runs in parallel
// and names the first simplex that breaks it. O(n) expected.
//
// Degenerate: without simplices all points must be collinear (3D: coplanar). The rule for ties is
// written anew for this file, so that an error in that of the triangulations is not repeated.
#include "delaunay/verify.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>

#include "delaunay/mesh/arguments.h"
#include "delaunay/mesh/equal_points.h"
#include "delaunay/verify/verified_mesh.h"

namespace delray::delaunay {
namespace {

using internal::Check;
using internal::find_first;
using internal::kAll;
using internal::kVerifyGrain;
using internal::Objection;
using internal::row;
using internal::turn_of;
using internal::VerifiedMesh;

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

// The rule about ties is written for this file alone: an error in that of the triangulations must
// not repeat itself here.
template <class Point>
bool before(const Point& a, const Point& b) {
  for (int k = 0; k < Point::length(); ++k) {
    if (a[k] != b[k]) return a[k] < b[k];
  }
  return false;
}

int in_ball(const std::array<glm::dvec2, 3>& p, const glm::dvec2& q) {
  return incircle(p[0], p[1], p[2], q);
}
int in_ball(const std::array<glm::dvec3, 4>& p, const glm::dvec3& q) {
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

template <int D>
Check check_rows(PointView<double> points, std::span<const std::uint32_t> simplices) {
  const std::size_t bad =
      find_first(simplices.size(), [&](std::size_t i) { return simplices[i] >= points.size(); });
  if (bad == kAll) return std::nullopt;
  return Objection{bad / (D + 1),
                   "vertex " + std::to_string(simplices[bad]) + " is not a row of the points"};
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
  for (int k = 0; k < D; ++k) text += (k == 0 ? "" : k + 1 < D ? ", " : " and ") + row(v[k]);
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

template <int D>
Check check_use(const VerifiedMesh<D>& mesh) {
  std::vector<std::uint8_t> used(mesh.points.size(), 0);
  parallel::parallel_for(0, mesh.vertices.size(), kVerifyGrain, [&](std::size_t i) {
    // Others write the same at the same time; once is enough.
    const std::atomic_ref mark(used[mesh.vertices[i]]);
    if (mark.load(std::memory_order_relaxed) == 0) mark.store(1, std::memory_order_relaxed);
  });
  const std::size_t bad = find_first(
      mesh.points.size(), [&](std::size_t i) { return mesh.lowest[i] == i && used[i] == 0; });
  if (bad == kAll) return std::nullopt;
  return Objection{kAll, row(bad) + " is in no " + Words<D>::simplex};
}

bool collinear(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return orient2d(a, b, c) == 0;
}
bool collinear(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  return collinear({a.x, a.y}, {b.x, b.y}, glm::dvec2(c.x, c.y)) &&
         collinear({a.y, a.z}, {b.y, b.z}, glm::dvec2(c.y, c.z)) &&
         collinear({a.z, a.x}, {b.z, b.x}, glm::dvec2(c.z, c.x));
}

// Without simplices all points must be flat: looks for D + 1 that are not.
template <int D>
Check check_no_simplices(const VerifiedMesh<D>& mesh) {
  const std::size_t n = mesh.points.size();
  std::vector<std::size_t> frame = {0};
  const auto add = [&](auto&& independent) {
    const std::size_t found = find_first(n, independent);
    if (found != kAll) frame.push_back(found);
    return found != kAll;
  };
  if (!add([&](std::size_t i) { return mesh.lowest[i] != 0; })) return std::nullopt;
  const auto a = mesh.at(0), b = mesh.at(frame[1]);
  if (!add([&](std::size_t i) { return !collinear(a, b, mesh.at(i)); })) return std::nullopt;
  if constexpr (D == 3) {
    const auto c = mesh.at(frame[2]);
    if (!add([&](std::size_t i) { return orient3d(a, b, c, mesh.at(i)) != 0; })) {
      return std::nullopt;
    }
  }
  std::string rows;
  for (int k = 0; k <= D; ++k) {
    rows += (k == 0 ? "" : k < D ? ", " : " and ") + std::to_string(frame[k]);
  }
  return Objection{kAll, std::string("there are no ") + Words<D>::simplices + ", but rows " + rows +
                             " are not " + Words<D>::flat};
}

template <int D>
Check check_coverage(const VerifiedMesh<D>& mesh) {
  if (mesh.size() == 0) return check_no_simplices(mesh);
  if (Check objection = check_orientation(mesh)) return objection;
  if (Check objection = check_facets(mesh)) return objection;
  if (Check objection = internal::check_hull(mesh)) return objection;
  return check_use(mesh);
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

template <int D>
Check check_ball(const VerifiedMesh<D>& mesh, std::size_t facet, const std::string& where) {
  if (facet == kAll) return std::nullopt;
  return Objection{facet / (D + 1), row(mesh.vertices[mesh.facets.mates[facet]]) + where};
}

template <int D>
Check check_representatives(const VerifiedMesh<D>& mesh) {
  const std::size_t bad = find_first(
      mesh.given.size(), [&](std::size_t i) { return mesh.given[i] != mesh.vertices[i]; });
  if (bad == kAll) return std::nullopt;
  return Objection{bad / (D + 1),
                   row(mesh.given[bad]) + " is a vertex, but equals " + row(mesh.vertices[bad])};
}

template <int D>
VerifiedMesh<D> build(PointView<double> points, std::span<const std::uint32_t> simplices) {
  VerifiedMesh<D> mesh{points, simplices, lowest_equal_rows(points, D), {}, 0, {}};
  for (std::size_t i = 0; i < points.size(); ++i) mesh.distinct += mesh.lowest[i] == i ? 1 : 0;
  mesh.vertices.resize(simplices.size());
  parallel::parallel_for(0, simplices.size(), kVerifyGrain,
                         [&](std::size_t i) { mesh.vertices[i] = mesh.lowest[simplices[i]]; });
  mesh.facets = match_facets(D, mesh.vertices, points.size());
  return mesh;
}

template <int D>
Verdict verify(PointView<double> points, std::span<const std::uint32_t> simplices) {
  Verdict verdict;
  const auto objects = [&](const Check& objection) {
    if (!objection) return false;
    if (objection->simplex != kAll) verdict.simplex = objection->simplex;
    verdict.reason = objection->reason;
    return true;
  };
  if (objects(check_rows<D>(points, simplices))) return verdict;
  const VerifiedMesh<D> mesh = build<D>(points, simplices);
  verdict.distinct = mesh.distinct;
  if (objects(check_coverage(mesh))) return verdict;
  verdict.valid = true;
  const BadBalls bad = find_bad_balls(mesh);
  const std::string ball = Words<D>::ball;
  if (objects(check_ball(mesh, bad.inside, " is inside its " + ball))) return verdict;
  verdict.delaunay = true;
  if (objects(check_representatives(mesh))) return verdict;
  if (objects(check_ball(mesh, bad.tie, " is on its " + ball + " and counts as inside"))) {
    return verdict;
  }
  verdict.canonical = true;
  return verdict;
}

}  // namespace

Verdict verify_simplices(int dim, PointView<double> points,
                         std::span<const std::uint32_t> simplices) {
  internal::check_view(points, dim);
  // Which rows there are is for the verdict.
  internal::check_simplices(dim, simplices, std::numeric_limits<std::size_t>::max());
  return dim == 2 ? verify<2>(points, simplices) : verify<3>(points, simplices);
}

Verdict verify_triangles(PointView<double> points, std::span<const std::uint32_t> triangles) {
  return verify_simplices(2, points, triangles);
}

std::optional<std::size_t> first_different_row(PointView<double> vertices, PointView<double> points,
                                               int dim) {
  internal::check_view(vertices, dim);
  internal::check_view(points, dim);
  const std::size_t shared = std::min(vertices.size(), points.size());
  const std::size_t row_number = find_first(shared, [&](std::size_t i) {
    for (int k = 0; k < dim; ++k) {
      if (vertices(i, k) != points(i, k)) return true;
    }
    return false;
  });
  if (row_number != kAll) return row_number;
  if (vertices.size() != points.size()) return shared;
  return std::nullopt;
}

}  // namespace delray::delaunay
