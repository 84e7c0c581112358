// The loop of an incremental insertion that keeps no history: from points to result.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "delaunay/insertion/insertion_order.h"
#include "delaunay/insertion/insertion_start.h"
#include "delaunay/insertion/walk.h"
#include "delaunay/mesh/extract.h"
#include "delaunay/mesh/stopwatch.h"
#include "delaunay/triangulate.h"

namespace delray::delaunay::internal {

// Inserts the points in the order of the options. A Located is made of the ordered points, a first
// simplex of them and the seed; it has locate(vertex) -> Place, subdivide(vertex, simplex), which
// puts the vertex there, legalize(), and take(), the mesh.
template <int D, class Located>
Result insert_walking(PointView<double> input, const Options& options) {
  Statistics seconds;
  const bool timed = options.statistics;
  Stopwatch watch;

  using Points = std::vector<Position<D>>;
  Points points = positions<D>(input);
  std::vector<std::uint32_t> rows =
      insertion_order(std::span<const Position<D>>(points), options.order, options.seed);
  const std::size_t n = points.size();
  Points ordered(n);
  for (std::size_t i = 0; i < n; ++i) ordered[i] = points[rows[i]];
  points.swap(ordered);
  ordered = {};
  seconds.order = watch.lap();

  const auto start = first_simplex<D>(points);
  if (!start) {
    Result result;
    result.statistics = seconds;
    result.triangulation.dim = D;
    result.triangulation.distinct = count_distinct(std::move(points));
    return result;
  }
  Located mesh(points, *start, options.seed);
  std::uint64_t distinct = D + 1;
  for (VertexNumber vertex = 0; vertex < n; ++vertex) {
    if (options.progress != nullptr) options.progress->advance();
    if (std::ranges::find(*start, vertex) != start->end()) continue;
    if (timed) watch.lap();
    const Place place = mesh.locate(vertex);
    if (timed) seconds.locate += watch.lap();
    if (place.equal != kInfiniteVertex) {
      rows[place.equal] = std::min(rows[place.equal], rows[vertex]);
      continue;
    }
    ++distinct;
    mesh.subdivide(vertex, place.simplex);
    if (timed) seconds.subdivide += watch.lap();
    mesh.legalize();
    if (timed) seconds.legalize += watch.lap();
  }
  if constexpr (requires { mesh.flips(); }) {
    if (timed) seconds.flips = mesh.flips();
  }
  watch.lap();
  points = {};
  Result result = extract(mesh.take(), rows);
  result.triangulation.distinct = distinct;
  seconds.extract = watch.lap();
  result.statistics = seconds;
  return result;
}

}  // namespace delray::delaunay::internal
