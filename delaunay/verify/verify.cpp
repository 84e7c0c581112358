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
#include "delaunay/verify/local_checks.h"

namespace delray::delaunay {
namespace {

using internal::BadBalls;
using internal::Check;
using internal::check_facets;
using internal::check_orientation;
using internal::collinear;
using internal::find_bad_balls;
using internal::find_first;
using internal::kAll;
using internal::kVerifyGrain;
using internal::Objection;
using internal::row;
using internal::VerifiedMesh;
using internal::Words;

template <int D>
Check check_rows(PointView<double> points, std::span<const std::uint32_t> simplices) {
  const std::size_t bad =
      find_first(simplices.size(), [&](std::size_t i) { return simplices[i] >= points.size(); });
  if (bad == kAll) return std::nullopt;
  return Objection{bad / (D + 1),
                   "vertex " + std::to_string(simplices[bad]) + " is not a row of the points"};
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
