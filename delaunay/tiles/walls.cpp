// Finds the simplices behind walls by walking from the outer side of each wall over all facets that
// are none. A facet and the same facet from its other side differ by the parity of their corners'
// order.
#include "delaunay/tiles/walls.h"

#include <algorithm>
#include <utility>

#include "delaunay/mesh/facets.h"

namespace delray::delaunay {

Walls::Wall Walls::wall_of(std::span<const std::uint32_t> corners) const {
  Wall wall;
  std::ranges::copy(corners, wall.corners.begin());
  const auto order = [&](std::size_t i, std::size_t j) {
    if (wall.corners[i] <= wall.corners[j]) return;
    std::swap(wall.corners[i], wall.corners[j]);
    wall.odd = !wall.odd;
  };
  order(0, 1);
  if (dim_ == 3) {
    order(1, 2);
    order(0, 1);
  }
  return wall;
}

void Walls::add(std::span<const std::uint32_t> corners) { walls_.push_back(wall_of(corners)); }

void Walls::renumber(std::span<const std::uint32_t> numbers) {
  for (Wall& wall : walls_) {
    for (int k = 0; k < dim_; ++k) wall.corners[k] = numbers[wall.corners[k]];
  }
}

void Walls::mark_vertices(std::vector<std::uint8_t>& marks) const {
  for (const Wall& wall : walls_) {
    for (int k = 0; k < dim_; ++k) marks[wall.corners[k]] = 1;
  }
}

Walls::Outside Walls::find_outside(const Triangulation& triangulation,
                                   std::span<const std::uint32_t> mates) const {
  const auto corners = static_cast<std::size_t>(dim_) + 1;
  const auto facet_of = [&](std::size_t facet) {
    std::array<std::uint32_t, 3> vertices{};
    const std::size_t simplex = facet / corners * corners;
    const std::span<const int> order = facet_corners(dim_, facet % corners);
    for (std::size_t k = 0; k < order.size(); ++k) {
      vertices[k] = triangulation.vertices[simplex + static_cast<std::size_t>(order[k])];
    }
    return vertices;
  };
  const auto size = static_cast<std::size_t>(dim_);

  Outside outside;
  outside.simplices.assign(triangulation.size(), walls_.empty() ? 1 : 0);
  std::vector<std::uint8_t> is_wall;
  if (!walls_.empty()) {
    is_wall.resize(mates.size());
    std::vector<Wall> sorted = walls_;
    std::ranges::sort(sorted);
    std::vector<std::uint8_t> has_outer(sorted.size());
    std::vector<std::uint32_t> front;
    for (std::size_t facet = 0; facet < mates.size(); ++facet) {
      const auto vertices = facet_of(facet);
      Wall other_side = wall_of(std::span(vertices).first(size));
      other_side.odd = !other_side.odd;
      auto at = std::ranges::lower_bound(sorted, Wall{other_side.corners, false});
      if (at == sorted.end() || at->corners != other_side.corners) continue;
      is_wall[facet] = 1;
      if (at->odd != other_side.odd) continue;
      has_outer[static_cast<std::size_t>(at - sorted.begin())] = 1;
      front.push_back(static_cast<std::uint32_t>(facet / corners));
    }
    while (!front.empty()) {
      const std::size_t simplex = front.back();
      front.pop_back();
      if (std::exchange(outside.simplices[simplex], std::uint8_t{1}) != 0) continue;
      for (std::size_t facet = simplex * corners; facet < (simplex + 1) * corners; ++facet) {
        if (is_wall[facet] != 0 || mates[facet] == FacetMates::kNone) continue;
        front.push_back(static_cast<std::uint32_t>(mates[facet] / corners));
      }
    }
    for (std::size_t i = 0; i < sorted.size(); ++i) {
      if (has_outer[i] != 0) continue;
      auto vertices = sorted[i].corners;
      if (sorted[i].odd) std::swap(vertices[0], vertices[1]);
      outside.hull.insert(outside.hull.end(), vertices.begin(), vertices.begin() + dim_);
    }
  }
  for (std::size_t facet = 0; facet < mates.size(); ++facet) {
    if (mates[facet] != FacetMates::kNone || outside.simplices[facet / corners] == 0) continue;
    if (!is_wall.empty() && is_wall[facet] != 0) continue;
    const auto vertices = facet_of(facet);
    outside.hull.insert(outside.hull.end(), vertices.begin(), vertices.begin() + dim_);
  }
  return outside;
}

}  // namespace delray::delaunay
