// Greedy insertion for simplified terrains (Puppo, Davis, De Menthon and Teng 1994; Garland and
// Heckbert 1995).
//
// Finds the distinct places, their hull (Andrew 1979) and an order in which neighbours are near
// each other; simplification.h does the rest. Degenerate: places on one line keep nothing.
#include "delaunay/simplify_terrain.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>

#include "delaunay/insertion/insertion_order.h"
#include "delaunay/mesh/arguments.h"
#include "delaunay/mesh/mesh.h"
#include "delaunay/mesh/with_threads.h"
#include "delaunay/points/simplification.h"
#include "delaunay/predicates/conflict.h"
#include "delaunay/triangulate.h"

namespace delray::delaunay {
namespace {

// The corners of the convex hull of points in lexicographic order, as indices (Andrew 1979).
std::vector<std::uint32_t> hull_corners(const std::vector<glm::dvec2>& points) {
  std::vector<std::uint32_t> chain;
  std::size_t fixed = 1;  // of the chain before
  const auto add = [&](std::uint32_t i) {
    while (chain.size() > fixed &&
           orient2d(points[chain[chain.size() - 2]], points[chain.back()], points[i]) <= 0) {
      chain.pop_back();
    }
    chain.push_back(i);
  };
  const auto n = static_cast<std::uint32_t>(points.size());
  for (std::uint32_t i = 0; i < n; ++i) add(i);
  fixed = chain.size();
  for (std::uint32_t i = n - 1; i-- > 0;) add(i);
  chain.pop_back();  // the first again
  return chain;
}

// The lowest row of each place, in lexicographic order.
internal::Places distinct_places(const PointView<double>& points) {
  std::vector<std::uint32_t> rows(points.size());
  std::iota(rows.begin(), rows.end(), 0U);
  const auto at = [&](std::uint32_t row) { return glm::dvec2(points(row, 0), points(row, 1)); };
  std::ranges::sort(rows, [&](std::uint32_t i, std::uint32_t j) {
    const glm::dvec2 a = at(i), b = at(j);
    return a == b ? i < j : lexicographically_less(a, b);
  });
  internal::Places places;
  for (const std::uint32_t row : rows) {
    const glm::dvec2 p = at(row) + 0.0;
    if (!places.points.empty() && places.points.back() == p) continue;
    places.points.push_back(p);
    places.rows.push_back(row);
  }
  return places;
}

void check(const PointView<double>& points, double max_error, int threads) {
  if (!(max_error >= 0 && std::isfinite(max_error))) {
    throw std::invalid_argument("the largest error must be finite and not negative");
  }
  if (threads < 1 || threads > kMostThreads) {
    throw std::invalid_argument("threads: from 1 to " + std::to_string(kMostThreads) + ", not " +
                                std::to_string(threads));
  }
  if (points.size() > kMaximumSimplices / 2) throw std::invalid_argument("more than 2^29 points");
  for (std::size_t row = 0; row < points.size(); ++row) {
    for (int k = 0; k < 3; ++k) {
      if (std::isfinite(points(row, k))) continue;
      throw std::invalid_argument("row " + std::to_string(row) +
                                  " has a coordinate that is not finite");
    }
  }
}

}  // namespace

SimplifiedTerrain simplify_terrain(PointView<double> points, double max_error,
                                   parallel::Progress* progress, int threads) {
  internal::check_view(points, 3);
  check(points, max_error, threads);
  if (progress != nullptr) progress->start(points.size());
  internal::Places sorted = distinct_places(points);
  const std::size_t n = sorted.points.size();
  std::vector<std::uint32_t> corners;
  if (n > 2) corners = hull_corners(sorted.points);
  if (corners.size() < 3) {
    SimplifiedTerrain result;
    result.triangulation.distinct = n;
    if (progress != nullptr) progress->advance(points.size());
    return result;
  }

  const std::vector<std::uint32_t> order = insertion_order(sorted.points, "hilbert", 1);
  internal::Places places;
  std::vector<std::uint32_t> number(n);  // along the curve
  for (const std::uint32_t i : order) {
    number[i] = static_cast<std::uint32_t>(places.points.size());
    places.points.push_back(sorted.points[i]);
    places.rows.push_back(sorted.rows[i]);
    places.heights.push_back(points(sorted.rows[i], 2) + 0.0);
  }
  sorted = {};
  std::vector<glm::dvec2> ends;
  for (std::uint32_t& corner : corners) {
    corner = number[corner];
    ends.push_back(places.points[corner]);
  }
  std::vector<std::uint32_t> shuffled;
  for (const std::uint32_t i : insertion_order(ends, "brio", 1)) shuffled.push_back(corners[i]);

  internal::Simplification simplification(std::move(places), max_error, progress);
  simplification.start(shuffled);
  if (threads > 1) {
    internal::with_threads(threads, [&] { simplification.refine_in_rounds(); });
  } else {
    simplification.refine();
  }
  SimplifiedTerrain result = simplification.result();
  if (progress != nullptr) progress->advance(points.size() - progress->done());
  return result;
}

PointCloud select_rows(const PointCloud& cloud, const std::vector<std::uint32_t>& rows) {
  internal::check_attributes(cloud);
  for (const std::uint32_t row : rows) {
    if (row >= cloud.size())
      throw std::invalid_argument("row " + std::to_string(row) + " does not exist");
  }
  const auto select = [&](auto& to, const auto& from) {
    if (from.empty()) return;
    to.reserve(rows.size());
    for (const std::uint32_t row : rows) to.push_back(from[row]);
  };
  PointCloud result;
  result.has_z = cloud.has_z;
  select(result.positions, cloud.positions);
  select(result.colours, cloud.colours);
  select(result.intensity, cloud.intensity);
  select(result.classification, cloud.classification);
  select(result.returns, cloud.returns);
  return result;
}

}  // namespace delray::delaunay
