#include "delaunay/verify.h"

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "delaunay/internal/equal_points.h"
#include "delaunay/internal/facets.h"
#include "delaunay/predicates.h"
#include "parallel/parallel_for.h"

namespace delray::delaunay {
namespace {

constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();
constexpr std::size_t kGrain = 4096;  // triangles or points: about 0.2 ms

// The lowest i of [0, n) for which bad(i), or kAll.
template <class Bad>
std::size_t find_first(std::size_t n, Bad&& bad) {
  return parallel::parallel_reduce(
      0, n, kGrain, kAll,
      [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
          if (bad(i)) return i;
        }
        return kAll;
      },
      [](std::size_t a, std::size_t b) { return std::min(a, b); });
}

std::string row(std::uint32_t vertex) { return "row " + std::to_string(vertex); }

// Something to say against a triangulation; `simplex` is kAll where it is about no single one.
struct Objection {
  std::size_t simplex = kAll;
  std::string reason;
};
using Check = std::optional<Objection>;

// The triangles with each vertex replaced by the lowest row of its equals.
struct Mesh2 {
  PointView<double> points;
  std::span<const std::uint32_t> given;
  std::vector<std::uint32_t> lowest;     // per row
  std::vector<std::uint32_t> triangles;  // 3 per triangle
  std::size_t distinct = 0;
  FacetMates edges;

  std::size_t size() const { return given.size() / 3; }
  glm::dvec2 at(std::uint32_t i) const { return {points(i, 0), points(i, 1)}; }
  // Edge number 3 t + i runs from start to end, to the left of which lies triangle t.
  std::uint32_t start(std::size_t edge) const {
    return triangles[edge - edge % 3 + (edge + 1) % 3];
  }
  std::uint32_t end(std::size_t edge) const { return triangles[edge - edge % 3 + (edge + 2) % 3]; }
};

// The rules about the order and the positions are written for this file alone: an error in those of
// the triangulations must not repeat itself here.
bool before(const glm::dvec2& a, const glm::dvec2& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; }

// REQUIRES: corners turn left; q is on their circumcircle and none of them.
bool counts_as_inside(const std::array<glm::dvec2, 3>& corners, const glm::dvec2& q) {
  std::array<int, 4> order = {0, 1, 2, 3};  // 3 is q
  const auto point = [&](int i) { return i == 3 ? q : corners[i]; };
  std::ranges::sort(order, [&](int i, int j) { return before(point(j), point(i)); });
  for (const int i : order) {
    if (i == 3) return false;
    std::array<glm::dvec2, 3> replaced = corners;
    replaced[i] = q;
    const int sign = orient2d(replaced[0], replaced[1], replaced[2]);
    if (sign != 0) return sign > 0;
  }
  return false;
}

Check check_rows(PointView<double> points, std::span<const std::uint32_t> triangles) {
  const std::size_t bad =
      find_first(triangles.size(), [&](std::size_t i) { return triangles[i] >= points.size(); });
  if (bad == kAll) return std::nullopt;
  return Objection{bad / 3,
                   "vertex " + std::to_string(triangles[bad]) + " is not a row of the points"};
}

Check check_orientation(const Mesh2& mesh) {
  const std::size_t bad = find_first(mesh.size(), [&](std::size_t t) {
    const std::uint32_t* v = mesh.triangles.data() + 3 * t;
    return orient2d(mesh.at(v[0]), mesh.at(v[1]), mesh.at(v[2])) <= 0;
  });
  if (bad == kAll) return std::nullopt;
  const std::uint32_t* v = mesh.triangles.data() + 3 * bad;
  const int sign = orient2d(mesh.at(v[0]), mesh.at(v[1]), mesh.at(v[2]));
  return Objection{bad, sign == 0 ? "its vertices are collinear" : "it is oriented clockwise"};
}

Check check_edges(const Mesh2& mesh) {
  const std::size_t crowded = mesh.edges.crowded;
  if (crowded != FacetMates::kNone) {
    return Objection{crowded / 3, "the edge between " + row(mesh.start(crowded)) + " and " +
                                      row(mesh.end(crowded)) + " has three triangles or more"};
  }
  const std::size_t bad = find_first(mesh.triangles.size(), [&](std::size_t edge) {
    const std::uint32_t mate = mesh.edges.mates[edge];
    return mate != FacetMates::kNone && mesh.start(edge) == mesh.start(mate);
  });
  if (bad == kAll) return std::nullopt;
  return Objection{bad / 3, "triangle " + std::to_string(mesh.edges.mates[bad] / 3) +
                                " lies on the same side of the edge between " +
                                row(mesh.start(bad)) + " and " + row(mesh.end(bad))};
}

// Whether the path a, b, c turns left or goes straight on.
bool is_convex(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  const int turn = orient2d(a, b, c);
  return turn > 0 || (turn == 0 && before(a, b) == before(b, c));
}

// A polygon whose corners are all convex winds once around its inside if it has one lexicographic
// minimum, and so do several only if they are one.
Check check_hull(const Mesh2& mesh) {
  std::vector<std::uint32_t> leaving(mesh.points.size(),
                                     FacetMates::kNone);  // hull edge per vertex
  for (std::size_t edge = 0; edge < mesh.triangles.size(); ++edge) {
    if (mesh.edges.mates[edge] != FacetMates::kNone) continue;
    std::uint32_t& known = leaving[mesh.start(edge)];
    if (known != FacetMates::kNone) {
      return Objection{edge / 3, "the boundary passes " + row(mesh.start(edge)) + " twice"};
    }
    known = static_cast<std::uint32_t>(edge);
  }
  bool has_minimum = false;
  for (std::size_t edge = 0; edge < mesh.triangles.size(); ++edge) {
    if (mesh.edges.mates[edge] != FacetMates::kNone) continue;
    // Every boundary edge that enters a vertex has one that leaves it, since triangles are cycles.
    const std::uint32_t next = leaving[mesh.end(edge)];
    const glm::dvec2 a = mesh.at(mesh.start(edge)), b = mesh.at(mesh.end(edge));
    const glm::dvec2 c = mesh.at(mesh.end(next));
    if (!is_convex(a, b, c)) {
      return Objection{edge / 3, "the boundary is not convex at " + row(mesh.end(edge))};
    }
    if (before(b, a) && before(b, c)) {
      if (has_minimum) {
        return Objection{edge / 3,
                         "the boundary is more than one polygon at " + row(mesh.end(edge))};
      }
      has_minimum = true;
    }
  }
  return std::nullopt;
}

Check check_use(const Mesh2& mesh) {
  std::vector<std::uint8_t> used(mesh.points.size(), 0);
  for (const std::uint32_t vertex : mesh.triangles) used[vertex] = 1;
  const std::size_t bad = find_first(
      mesh.points.size(), [&](std::size_t i) { return mesh.lowest[i] == i && used[i] == 0; });
  if (bad == kAll) return std::nullopt;
  return Objection{kAll, row(static_cast<std::uint32_t>(bad)) + " is in no triangle"};
}

Check check_no_triangles(const Mesh2& mesh) {
  const std::size_t n = mesh.points.size();
  const std::size_t other = find_first(n, [&](std::size_t i) { return mesh.lowest[i] != 0; });
  if (other == kAll) return std::nullopt;
  const glm::dvec2 a = mesh.at(0), b = mesh.at(static_cast<std::uint32_t>(other));
  const std::size_t aside = find_first(n, [&](std::size_t i) {
    return orient2d(a, b, mesh.at(static_cast<std::uint32_t>(i))) != 0;
  });
  if (aside == kAll) return std::nullopt;
  return Objection{kAll, "there are no triangles, but rows 0, " + std::to_string(other) + " and " +
                             std::to_string(aside) + " are not collinear"};
}

Check check_coverage(const Mesh2& mesh) {
  if (mesh.size() == 0) return check_no_triangles(mesh);
  if (Check objection = check_orientation(mesh)) return objection;
  if (Check objection = check_edges(mesh)) return objection;
  if (Check objection = check_hull(mesh)) return objection;
  return check_use(mesh);
}

// The first edges, as seen from the lower of their triangles, that break the two properties.
struct BadCircles {
  std::size_t inside = kAll;  // the opposite vertex of the neighbour is inside
  std::size_t tie = kAll;     // it is on the circumcircle and counts as inside
};

// Both triangles at an edge turn left, so what holds on one side of it holds on the other.
BadCircles find_bad_circles(const Mesh2& mesh) {
  return parallel::parallel_reduce(
      0, mesh.triangles.size(), kGrain, BadCircles{},
      [&](std::size_t first, std::size_t last) {
        BadCircles bad;
        for (std::size_t edge = first; edge < last; ++edge) {
          const std::uint32_t mate = mesh.edges.mates[edge];
          if (mate == FacetMates::kNone || mate < edge) continue;
          const std::uint32_t* v = mesh.triangles.data() + (edge - edge % 3);
          const std::array c = {mesh.at(v[0]), mesh.at(v[1]), mesh.at(v[2])};
          const glm::dvec2 q = mesh.at(mesh.triangles[mate]);
          const int sign = incircle(c[0], c[1], c[2], q);
          if (sign > 0) bad.inside = std::min(bad.inside, edge);
          if (sign == 0 && counts_as_inside(c, q)) bad.tie = std::min(bad.tie, edge);
        }
        return bad;
      },
      [](const BadCircles& a, const BadCircles& b) {
        return BadCircles{std::min(a.inside, b.inside), std::min(a.tie, b.tie)};
      });
}

Check check_circle(const Mesh2& mesh, std::size_t edge, const char* what) {
  if (edge == kAll) return std::nullopt;
  return Objection{edge / 3, row(mesh.triangles[mesh.edges.mates[edge]]) + what};
}

Check check_representatives(const Mesh2& mesh) {
  const std::size_t bad = find_first(
      mesh.given.size(), [&](std::size_t i) { return mesh.given[i] != mesh.triangles[i]; });
  if (bad == kAll) return std::nullopt;
  return Objection{bad / 3,
                   row(mesh.given[bad]) + " is a vertex, but equals " + row(mesh.triangles[bad])};
}

Mesh2 build(PointView<double> points, std::span<const std::uint32_t> triangles) {
  Mesh2 mesh{points, triangles, lowest_equal_rows(points, 2), {}, 0, {}};
  for (std::size_t i = 0; i < points.size(); ++i) mesh.distinct += mesh.lowest[i] == i ? 1 : 0;
  mesh.triangles.resize(triangles.size());
  parallel::parallel_for(0, triangles.size(), kGrain,
                         [&](std::size_t i) { mesh.triangles[i] = mesh.lowest[triangles[i]]; });
  mesh.edges = match_facets(2, mesh.triangles, points.size());
  return mesh;
}

void object(Verdict& verdict, const Objection& objection) {
  if (objection.simplex != kAll) verdict.simplex = objection.simplex;
  verdict.reason = objection.reason;
}

}  // namespace

Verdict verify_triangles(PointView<double> points, std::span<const std::uint32_t> triangles) {
  Verdict verdict;
  if (const Check objection = check_rows(points, triangles)) {
    object(verdict, *objection);
    return verdict;
  }
  const Mesh2 mesh = build(points, triangles);
  verdict.distinct = mesh.distinct;
  if (const Check objection = check_coverage(mesh)) {
    object(verdict, *objection);
    return verdict;
  }
  verdict.valid = true;
  const BadCircles bad = find_bad_circles(mesh);
  if (const Check objection = check_circle(mesh, bad.inside, " is inside its circumcircle")) {
    object(verdict, *objection);
    return verdict;
  }
  verdict.delaunay = true;
  if (const Check objection = check_representatives(mesh)) {
    object(verdict, *objection);
    return verdict;
  }
  if (const Check objection =
          check_circle(mesh, bad.tie, " is on its circumcircle and counts as inside")) {
    object(verdict, *objection);
    return verdict;
  }
  verdict.canonical = true;
  return verdict;
}

std::optional<std::size_t> first_different_row(PointView<double> vertices, PointView<double> points,
                                               int dim) {
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
