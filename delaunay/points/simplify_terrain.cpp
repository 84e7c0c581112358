// Greedy insertion for simplified terrains (Puppo, Davis, De Menthon and Teng 1994; Garland and
// Heckbert 1995).
//
// Finds the distinct places and their hull (Andrew 1979); simplification.h does the rest.
// Degenerate: places on one line keep nothing.
#include "delaunay/simplify_terrain.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include "delaunay/insertion/insertion_order.h"
#include "delaunay/mesh/arguments.h"
#include "delaunay/mesh/mesh.h"
#include "delaunay/order/cell_order.h"
#include "delaunay/points/simplification.h"
#include "delaunay/predicates/conflict.h"
#include "delaunay/triangulate.h"
#include "parallel/arena.h"
#include "parallel/parallel_for.h"

namespace delray::delaunay {
namespace {

// The corners of the convex hull of points that are given in lexicographic order, at least two,
// none twice (Andrew 1979).
std::vector<std::uint32_t> hull_corners(std::span<const glm::dvec2> points,
                                        const std::vector<std::uint32_t>& sorted) {
  std::vector<std::uint32_t> chain;
  std::size_t fixed = 1;  // of the chain before
  const auto add = [&](std::uint32_t i) {
    while (chain.size() > fixed &&
           orient2d(points[chain[chain.size() - 2]], points[chain.back()], points[i]) <= 0) {
      chain.pop_back();
    }
    chain.push_back(i);
  };
  for (const std::uint32_t i : sorted) add(i);
  fixed = chain.size();
  for (std::size_t i = sorted.size() - 1; i-- > 0;) add(sorted[i]);
  chain.pop_back();  // the first again
  return chain;
}

// The places that may be corners of the hull: those outside the hull of eight that are farthest in
// some direction, and on its rim (Akl and Toussaint 1978). In lexicographic order.
std::vector<std::uint32_t> rim_of(std::span<const glm::dvec2> points) {
  const auto less = [&](std::uint32_t i, std::uint32_t j) {
    return lexicographically_less(points[i], points[j]);
  };
  constexpr std::size_t kGrain = 8192;
  constexpr std::array<glm::dvec2, 4> kDirections = {{{1, 0}, {0, 1}, {0.5, 0.5}, {0.5, -0.5}}};
  using Extremes = std::array<std::uint32_t, 2 * kDirections.size()>;
  const auto farther = [&](std::uint32_t i, std::uint32_t j, std::size_t k) {
    const glm::dvec2 direction = kDirections[k / 2] * (k % 2 == 0 ? 1.0 : -1.0);
    return dot(points[i], direction) > dot(points[j], direction);
  };
  const auto combine = [&](Extremes a, const Extremes& b) {
    for (std::size_t k = 0; k < a.size(); ++k) {
      if (farther(b[k], a[k], k)) a[k] = b[k];
    }
    return a;
  };
  const Extremes extremes = parallel::parallel_reduce(
      0, points.size(), kGrain, Extremes{},
      [&](std::size_t first, std::size_t last) {
        Extremes found;
        found.fill(static_cast<std::uint32_t>(first));
        for (std::size_t i = first; i < last; ++i) {
          Extremes one;
          one.fill(static_cast<std::uint32_t>(i));
          found = combine(found, one);
        }
        return found;
      },
      combine);
  std::vector<std::uint32_t> corners(extremes.begin(), extremes.end());
  std::ranges::sort(corners, less);
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  if (corners.size() > 2) corners = hull_corners(points, corners);
  const auto is_inside = [&](const glm::dvec2& q) {
    if (corners.size() < 3) return false;
    for (std::size_t i = 0, before = corners.size() - 1; i < corners.size(); before = i++) {
      if (orient2d(points[corners[before]], points[corners[i]], q) <= 0) return false;
    }
    return true;
  };
  std::vector<std::uint32_t> rim;
  std::mutex mutex;
  parallel::parallel_blocks(0, points.size(), kGrain, [&](std::size_t first, std::size_t last) {
    std::vector<std::uint32_t> found;
    for (std::size_t i = first; i < last; ++i) {
      if (!is_inside(points[i])) found.push_back(static_cast<std::uint32_t>(i));
    }
    const std::scoped_lock lock(mutex);
    rim.insert(rim.end(), found.begin(), found.end());
  });
  std::ranges::sort(rim, less);
  return rim;
}

// The distinct places in an order in which neighbours are near each other.
internal::Places distinct_places(const PointView<double>& points, int threads) {
  const internal::CellOrder order = internal::cell_order(points, threads);
  const std::size_t n = order.points.size();
  internal::Places places;
  places.points.assign(order.points.data(), order.points.data() + n);
  places.rows.assign(order.rows.data(), order.rows.data() + n);
  places.heights.resize(n);
  for (std::size_t i = 0; i < n; ++i) places.heights[i] = points(places.rows[i], 2) + 0.0;
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

SimplifiedTerrain simplify(const PointView<double>& points, double max_error,
                           parallel::Progress* progress, int threads) {
  internal::Places places = distinct_places(points, threads);
  const std::size_t n = places.points.size();
  std::vector<std::uint32_t> corners;
  if (n > 2) corners = hull_corners(places.points, rim_of(places.points));
  if (corners.size() < 3) {
    SimplifiedTerrain result;
    result.triangulation.distinct = n;
    return result;
  }
  std::vector<glm::dvec2> ends;
  for (const std::uint32_t corner : corners) ends.push_back(places.points[corner]);
  std::vector<std::uint32_t> shuffled;
  for (const std::uint32_t i : insertion_order(ends, "brio", 1)) shuffled.push_back(corners[i]);

  internal::Simplification simplification(std::move(places), max_error, progress);
  simplification.start(shuffled);
  threads > 1 ? simplification.refine_in_parts() : simplification.refine();
  return simplification.result();
}

}  // namespace

SimplifiedTerrain simplify_terrain(PointView<double> points, double max_error,
                                   parallel::Progress* progress, int threads) {
  internal::check_view(points, 3);
  check(points, max_error, threads);
  if (progress != nullptr) progress->start(points.size());
  SimplifiedTerrain result = parallel::Arena(threads).execute(
      [&] { return simplify(points, max_error, progress, threads); });
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
