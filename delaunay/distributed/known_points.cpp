// Incremental construction's search (Kohout 2004, 5.1): a point near the edge gives a circle,
// points in the circle give smaller ones, until there is none.
#include "delaunay/distributed/known_points.h"

#include <algorithm>
#include <cmath>

#include "delaunay/insertion/insertion_order.h"
#include "delaunay/predicates/conflict.h"
#include "delaunay/tiles/circumball.h"

namespace delray::delaunay {
namespace {

constexpr std::size_t kRun = 16;  // points whose box is looked at before they are
using PlaneBox = geometry::Box<glm::dvec2>;

}  // namespace

void KnownPoints::add(int area, std::vector<RowPoint> points) {
  std::vector<glm::dvec2> positions;
  for (const RowPoint& point : points) positions.emplace_back(point.position);
  std::vector<RowPoint> ordered;
  std::vector<PlaneBox> boxes;
  for (const std::uint32_t i :
       insertion_order(std::span<const glm::dvec2>(positions), "hilbert", 1)) {
    if (ordered.size() % kRun == 0) boxes.emplace_back();
    boxes.back().include(positions[i]);
    ordered.push_back(points[i]);
  }
  areas_.emplace(area, Area{std::move(ordered), BoxTree<glm::dvec2>(boxes)});
}

template <class Touches, class Found>
void KnownPoints::find(const Touches& touches, const Found& found) const {
  for (const auto& entry : areas_) {
    const Area& area = entry.second;
    area.runs.find(touches, [&](std::uint32_t run) {
      const std::size_t first = run * kRun, last = std::min(first + kRun, area.points.size());
      for (std::size_t i = first; i < last; ++i) found(area.points[i]);
    });
  }
}

std::optional<RowPoint> KnownPoints::any_left_of(const RowPoint& a, const RowPoint& b) const {
  const glm::dvec2 p(a.position), q(b.position);
  const glm::dvec2 middle = p * 0.5 + q * 0.5;
  std::optional<RowPoint> result;
  const auto take = [&](const RowPoint& point) {
    if (!result && orient2d(p, q, glm::dvec2(point.position)) > 0) result = point;
  };
  // Squares about the edge, ever larger.
  double reach = glm::length(q - p);
  for (int step = 0; step < 12 && !result && std::isfinite(reach); ++step, reach *= 2) {
    find(
        [&](const PlaneBox& box) {
          return !result && glm::all(glm::lessThanEqual(box.low, middle + reach)) &&
                 glm::all(glm::lessThanEqual(middle - reach, box.high));
        },
        take);
  }
  if (result) return result;
  find([&](const PlaneBox& box) { return !result && reaches_beyond({q, p}, box); }, take);
  return result;
}

std::optional<RowPoint> KnownPoints::apex_of(const RowPoint& a, const RowPoint& b) const {
  std::optional<RowPoint> apex = any_left_of(a, b);
  if (!apex) return apex;
  const glm::dvec2 p(a.position), q(b.position);
  Circumball<2> ball({p, q, glm::dvec2(apex->position)});
  find([&](const PlaneBox& box) { return ball.touches(box); },
       [&](const RowPoint& point) {
         const glm::dvec2 c(point.position);
         if (point.row == apex->row || c == p || c == q || orient2d(p, q, c) <= 0) return;
         if (!circle_conflict(p, q, glm::dvec2(apex->position), c)) return;
         apex = point;
         ball = Circumball<2>({p, q, c});
       });
  return apex;
}

}  // namespace delray::delaunay
