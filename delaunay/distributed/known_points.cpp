// The apex of one area's points is what the search of the next begins with.
#include "delaunay/distributed/known_points.h"

#include <span>
#include <utility>

#include "delaunay/insertion/insertion_order.h"

namespace delray::delaunay {

void KnownPoints::add(int area, std::vector<RowPoint> points) {
  std::vector<glm::dvec2> positions;
  for (const RowPoint& point : points) positions.emplace_back(point.position);
  std::vector<RowPoint> ordered;
  std::vector<glm::dvec2> ordered_positions;
  for (const std::uint32_t i :
       insertion_order(std::span<const glm::dvec2>(positions), "hilbert", 1)) {
    ordered.push_back(points[i]);
    ordered_positions.push_back(positions[i]);
  }
  areas_.emplace(area, Area{std::move(ordered), ApexSearch<2>(std::move(ordered_positions))});
}

std::optional<RowPoint> KnownPoints::apex_of(const RowPoint& a, const RowPoint& b) const {
  const ApexSearch<2>::Facet edge = {glm::dvec2(a.position), glm::dvec2(b.position)};
  std::optional<RowPoint> apex;
  std::optional<glm::dvec2> position;
  for (const auto& [number, area] : areas_) {
    if (const auto found = area.search.find(edge, position)) {
      apex = area.points[*found];
      position = area.search.points()[*found];
    }
  }
  return apex;
}

}  // namespace delray::delaunay
