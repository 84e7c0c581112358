// The search of incremental construction: the point with which a facet makes its next simplex.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "delaunay/tiles/box_tree.h"

namespace delray::delaunay {

// Points in buckets, runs of them whose boxes are in a tree.
template <int D>
class ApexSearch {
 public:
  using Point = glm::vec<D, double, glm::defaultp>;
  // Its outside is to the left of an edge; a triangle is seen counterclockwise from there.
  using Facet = std::array<Point, D>;

  // Each point once, best in an order that keeps neighbours near each other. O(n log n).
  explicit ApexSearch(std::vector<Point> points);

  std::span<const Point> points() const { return points_; }

  // The point outside of the facet whose ball through the facet's corners has no other point in
  // that is outside, by the rule of predicates/conflict.h; the search begins with `apex`, a point
  // that is one of these or not. Nothing if no point is outside, or if none is better than `apex`.
  // O(log n) expected where points are spread evenly.
  std::optional<std::uint32_t> find(const Facet& facet,
                                    const std::optional<Point>& apex = std::nullopt) const;

 private:
  template <class Found>
  bool any_in_run(std::uint32_t run, const Found& found) const;
  std::optional<std::uint32_t> any_outside(const Facet& facet) const;

  std::vector<Point> points_;
  BoxTree<Point> runs_;
};

extern template class ApexSearch<2>;
extern template class ApexSearch<3>;

// Whether q lies in the ball of a positively oriented simplex, of which it is no corner.
bool is_in_ball(const std::array<glm::dvec2, 3>& simplex, const glm::dvec2& q);
bool is_in_ball(const std::array<glm::dvec3, 4>& simplex, const glm::dvec3& q);
// +1 where the corners are positively oriented.
int orientation_of(const std::array<glm::dvec2, 3>& simplex);
int orientation_of(const std::array<glm::dvec3, 4>& simplex);

}  // namespace delray::delaunay
