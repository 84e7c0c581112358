// What methods that insert points in rounds have in common: equal points are one, a simplex comes
// first.
#pragma once

#include <cstdint>
#include <span>

#include "delaunay/construction/distinct_points.h"
#include "delaunay/mesh/start_mesh.h"
#include "delaunay/mesh/stopwatch.h"
#include "delaunay/mesh/with_threads.h"
#include "delaunay/triangulate.h"
#include "parallel/progress.h"

namespace delray::delaunay::internal {

template <template <int> class Insertion, int D>
Result insert_distinct_in(PointView<double> input, const Options& options) {
  Stopwatch watch;
  const DistinctOrder<D> distinct = distinct_points<D>(input);
  const std::uint64_t n = distinct.points.size();
  if (options.progress != nullptr) options.progress->advance(input.size() - n);
  const double order_seconds = watch.lap();
  Result result;
  if (const auto first = first_simplex<D>(distinct.points)) {
    if (options.progress != nullptr) options.progress->advance(first->size());
    Insertion<D> insertion(distinct.points, *first, options);
    insertion.run();
    watch.lap();
    result = insertion.extract_with(std::span<const std::uint32_t>(distinct.rows));
    result.statistics.extract = watch.lap();
  }
  result.statistics.order = order_seconds;
  result.triangulation.dim = D;
  result.triangulation.distinct = n;
  return result;
}

// An Insertion is made of points, the corners of the first simplex and options; run() inserts all
// others, and extract_with(rows) gives the result with the rows of the input.
template <template <int> class Insertion>
Result insert_distinct(PointView<double> points, const Options& options) {
  return with_threads(options.threads, [&] {
    return options.dim == 2 ? insert_distinct_in<Insertion, 2>(points, options)
                            : insert_distinct_in<Insertion, 3>(points, options);
  });
}

}  // namespace delray::delaunay::internal
