// A point near the facet gives a ball, points in the ball give smaller ones, until there is none
// (Kohout 2004, 4.2).
#include "delaunay/construction/apex_search.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "delaunay/predicates/conflict.h"
#include "delaunay/tiles/circumball.h"

namespace delray::delaunay {
namespace {

constexpr std::size_t kBucket = 8;  // points whose box is looked at before they are

template <class Point>
std::vector<geometry::Box<Point>> boxes_of_runs(std::span<const Point> points) {
  std::vector<geometry::Box<Point>> boxes((points.size() + kBucket - 1) / kBucket);
  for (std::size_t i = 0; i < points.size(); ++i) boxes[i / kBucket].include(points[i]);
  return boxes;
}

template <std::size_t N, class Point>
std::array<Point, N + 1> with_apex(const std::array<Point, N>& facet, const Point& apex) {
  std::array<Point, N + 1> simplex;
  std::ranges::copy(facet, simplex.begin());
  simplex[N] = apex;
  return simplex;
}

// The facet's closed outside meets the box.
bool outside_meets(const std::array<glm::dvec2, 2>& facet, const geometry::Box<glm::dvec2>& box) {
  return reaches_beyond({facet[1], facet[0]}, box);
}
bool outside_meets(const std::array<glm::dvec3, 3>& facet, const geometry::Box<glm::dvec3>& box) {
  return reaches_beyond(facet, box);
}

}  // namespace

bool is_in_ball(const std::array<glm::dvec2, 3>& simplex, const glm::dvec2& q) {
  return circle_conflict(simplex[0], simplex[1], simplex[2], q);
}
bool is_in_ball(const std::array<glm::dvec3, 4>& simplex, const glm::dvec3& q) {
  return sphere_conflict(AnyPoints{}, simplex[0], simplex[1], simplex[2], simplex[3], q);
}
int orientation_of(const std::array<glm::dvec2, 3>& simplex) {
  return orient2d(simplex[0], simplex[1], simplex[2]);
}
int orientation_of(const std::array<glm::dvec3, 4>& simplex) {
  return orient3d(simplex[0], simplex[1], simplex[2], simplex[3]);
}

template <int D>
ApexSearch<D>::ApexSearch(std::vector<Point> points)
    : points_(std::move(points)), runs_(boxes_of_runs(std::span<const Point>(points_))) {}

template <int D>
template <class Found>
bool ApexSearch<D>::any_in_run(std::uint32_t run, const Found& found) const {
  const std::size_t first = run * kBucket, last = std::min(first + kBucket, points_.size());
  for (std::size_t i = first; i < last; ++i) {
    if (found(static_cast<std::uint32_t>(i))) return true;
  }
  return false;
}

template <int D>
std::optional<std::uint32_t> ApexSearch<D>::any_outside(const Facet& facet) const {
  std::optional<std::uint32_t> result;
  const auto take = [&](std::uint32_t i) {
    if (orientation_of(with_apex(facet, points_[i])) <= 0) return false;
    result = i;
    return true;
  };
  const auto look = [&](const auto& touches) {
    return runs_.any(touches, [&](std::uint32_t run) { return any_in_run(run, take); });
  };
  geometry::Box<Point> box;
  for (const Point& corner : facet) box.include(corner);
  // Boxes about the facet, ever larger; then the whole half-space.
  const Point middle = box.centre();
  double reach = glm::length(box.high * 0.5 - box.low * 0.5);
  for (int step = 0; step < 12 && std::isfinite(reach); ++step, reach *= 2) {
    if (look([&](const geometry::Box<Point>& other) {
          return glm::all(glm::lessThanEqual(other.low, middle + reach)) &&
                 glm::all(glm::lessThanEqual(middle - reach, other.high));
        })) {
      return result;
    }
  }
  look([&](const geometry::Box<Point>& other) { return outside_meets(facet, other); });
  return result;
}

template <int D>
std::optional<std::uint32_t> ApexSearch<D>::find(const Facet& facet,
                                                 const std::optional<Point>& apex) const {
  std::optional<std::uint32_t> best;
  if (!apex) {
    best = any_outside(facet);
    if (!best) return best;
  }
  std::array<Point, D + 1> simplex = with_apex(facet, apex ? *apex : points_[*best]);
  Circumball<D> ball(simplex);
  const auto improve = [&](std::uint32_t i) {
    const Point& q = points_[i];
    if (q != simplex[D] && orientation_of(with_apex(facet, q)) > 0 && is_in_ball(simplex, q)) {
      best = i;
      simplex[D] = q;
      ball = Circumball<D>(simplex);
    }
    return false;
  };
  runs_.any([&](const geometry::Box<Point>& box) { return ball.touches(box); },
            [&](std::uint32_t run) { return any_in_run(run, improve); });
  return best;
}

template class ApexSearch<2>;
template class ApexSearch<3>;

}  // namespace delray::delaunay
