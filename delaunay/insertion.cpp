#include "delaunay/internal/insertion.h"

#include <algorithm>
#include <array>
#include <vector>

#include "delaunay/dag_location.h"
#include "delaunay/insertion_order.h"
#include "delaunay/internal/access.h"
#include "delaunay/internal/dag_run.h"
#include "delaunay/internal/extract.h"
#include "delaunay/internal/finite_points.h"
#include "delaunay/internal/first_triangle.h"
#include "delaunay/internal/flip.h"
#include "delaunay/internal/insert_in_leaf.h"
#include "delaunay/internal/insertion_phases.h"
#include "delaunay/internal/sole_dag_access.h"
#include "delaunay/internal/stopwatch.h"
#include "delaunay/mesh.h"
#include "delaunay/walk.h"

namespace delray::delaunay::internal {
namespace {

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

Triangulation insert_walking(PointView<double> input, const Options& options) {
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

// Down the history of the triangulation to the simplex of the next point.
template <int D>
Triangulation insert_descending(PointView<double> input, const Options& options) {
  DagRun<D> run(input, options, 1);
  if (!run.is_flat()) {
    const DagTriangulation<D> triangulation = run.triangulation();
    SoleDagAccess<D> access(triangulation.dag, 0);
    InsertionPhases phases(options);
    std::vector<NodeNumber> suspects;
    for (VertexNumber vertex = 0; vertex < run.end(0); ++vertex) {
      phases.next_point();
      if (run.is_first(vertex)) continue;
      const auto& q = run.point(vertex);
      const NodeNumber leaf = descend(triangulation.dag, triangulation.orientation,
                                      root_of(triangulation.dag, triangulation.orientation, q), q);
      phases.located();
      insert_in_leaf(run, triangulation, leaf, vertex, access, suspects, phases);
    }
    phases.finish();
  }
  return run.finish();
}

}  // namespace

Triangulation insert_all(PointView<double> points, const Options& options) {
  return options.location == "dag" ? insert_descending<2>(points, options)
                                   : insert_walking(points, options);
}

}  // namespace delray::delaunay::internal
