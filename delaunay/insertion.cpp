#include "delaunay/internal/insertion.h"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "delaunay/insertion_order.h"
#include "delaunay/internal/access.h"
#include "delaunay/internal/extract.h"
#include "delaunay/internal/finite_points.h"
#include "delaunay/internal/flip.h"
#include "delaunay/internal/stopwatch.h"
#include "delaunay/mesh.h"
#include "delaunay/predicates.h"
#include "delaunay/walk.h"

namespace delray::delaunay::internal {
namespace {

// The first three points in order that turn, counterclockwise.
std::optional<std::array<VertexNumber, 3>> first_triangle(std::span<const glm::dvec2> points) {
  const auto n = static_cast<VertexNumber>(points.size());
  VertexNumber second = 1;
  while (second < n && points[second] == points[0]) ++second;
  for (VertexNumber third = second + 1; third < n; ++third) {
    const int turn = orient2d(points[0], points[second], points[third]);
    if (turn > 0) return std::array{VertexNumber{0}, second, third};
    if (turn < 0) return std::array{VertexNumber{0}, third, second};
  }
  return std::nullopt;
}

// One triangle and the ghosts around it.
void start_mesh(Mesh<2>& mesh, const std::array<VertexNumber, 3>& triangle) {
  for (unsigned k = 0; k < 3; ++k) mesh.set_vertex(corner_of(0, k), triangle[k]);
  for (unsigned k = 0; k < 3; ++k) {
    const SimplexNumber ghost = 1 + k;
    mesh.set_vertex(corner_of(ghost, 0), triangle[(k + 2) % 3]);
    mesh.set_vertex(corner_of(ghost, 1), triangle[(k + 1) % 3]);
    mesh.set_vertex(corner_of(ghost, 2), kInfiniteVertex);
    mesh.link(corner_of(ghost, 2), corner_of(0, k));
    mesh.link(corner_of(ghost, 1), corner_of(1 + (k + 1) % 3, 0));
  }
}

std::uint64_t count_distinct(std::vector<glm::dvec2> points) {
  std::sort(points.begin(), points.end(), lexicographically_less);
  return static_cast<std::uint64_t>(std::unique(points.begin(), points.end()) - points.begin());
}

}  // namespace

Triangulation insert_all(PointView<double> input, const Options& options) {
  Statistics unused;
  Statistics& seconds = options.statistics != nullptr ? *options.statistics : unused;
  const bool timed = options.statistics != nullptr;
  Stopwatch watch;

  std::vector<glm::dvec2> points = finite_points(input);
  std::vector<std::uint32_t> rows = insertion_order(points, options.order, options.seed);
  const std::size_t n = points.size();
  std::vector<glm::dvec2> ordered(n);
  for (std::size_t i = 0; i < n; ++i) ordered[i] = points[rows[i]];
  points.swap(ordered);
  ordered = {};
  seconds.order = watch.lap();

  const auto start = first_triangle(points);
  if (!start) {
    Triangulation result;
    result.distinct = count_distinct(std::move(points));
    return result;
  }
  Mesh<2> mesh(2 * n - 2);
  start_mesh(mesh, *start);
  SoleAccess access(4);
  std::vector<CornerNumber> suspects;
  std::uint64_t distinct = 3;
  SimplexNumber last = 0;
  std::uint32_t random = static_cast<std::uint32_t>(options.seed) | 1;
  for (VertexNumber vertex = 0; vertex < n; ++vertex) {
    if (options.progress != nullptr) options.progress->advance();
    if (std::ranges::find(*start, vertex) != start->end()) continue;
    if (timed) watch.lap();
    const Place place = walk(mesh, points, last, points[vertex], random);
    if (timed) seconds.locate += watch.lap();
    last = place.simplex;
    if (place.equal != kInfiniteVertex) {
      rows[place.equal] = std::min(rows[place.equal], rows[vertex]);
      continue;
    }
    ++distinct;
    subdivide(mesh, place.simplex, vertex, access, suspects);
    if (timed) seconds.subdivide += watch.lap();
    legalize(mesh, points, access, suspects);
    if (timed) seconds.legalize += watch.lap();
  }
  watch.lap();
  points = {};
  mesh.shrink(access.used());
  Triangulation result = extract(std::move(mesh), rows);
  result.distinct = distinct;
  seconds.extract = watch.lap();
  return result;
}

}  // namespace delray::delaunay::internal
