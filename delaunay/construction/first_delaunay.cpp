// Steps down the lower hull above one direction from point 0, until no point is below.
#include "delaunay/construction/first_delaunay.h"

#include <algorithm>
#include <vector>

#include "delaunay/insertion/insertion_start.h"

namespace delray::delaunay::internal {
namespace {

template <int D>
class Descent {
 public:
  using Point = Position<D>;
  using Simplex = std::array<Point, D + 1>;

  explicit Descent(const Simplex& start) : simplex_(start), directions_(start) {}

  const Simplex& simplex() const { return simplex_; }

  // Returns the corner that q replaces. REQUIRES: q is in the ball.
  unsigned step(const Point& q) {
    for (unsigned k = 1; k <= D; ++k) {
      Simplex next = simplex_;
      next[k] = q;
      if (orientation_of(next) > 0 && holds_direction(next)) {
        simplex_ = next;
        return k;
      }
    }
    return 0;  // never: one of both holds it
  }

 private:
  // Whether the place a little from corner 0 towards the first direction, less towards the second,
  // and so on, is in the simplex.
  bool holds_direction(const Simplex& simplex) const {
    for (unsigned facet = 1; facet <= D; ++facet) {
      int side = 0;
      for (unsigned i = 1; i <= D && side == 0; ++i) {
        Simplex moved = simplex;
        moved[facet] = directions_[i];
        side = orientation_of(moved);
      }
      if (side < 0) return false;
    }
    return true;
  }

  Simplex simplex_, directions_;
};

}  // namespace

template <int D>
std::optional<std::array<VertexNumber, D + 1>> first_delaunay_simplex(const ApexSearch<D>& search) {
  const std::span<const Position<D>> points = search.points();
  auto corners = first_simplex<D>(std::vector<Position<D>>(points.begin(), points.end()));
  if (!corners) return corners;
  std::array<Position<D>, D + 1> start;
  for (unsigned k = 0; k <= D; ++k) start[k] = points[(*corners)[k]];
  Descent<D> descent(start);
  for (bool moved = true; moved;) {
    moved = false;
    for (VertexNumber v = 0; v < points.size(); ++v) {
      if (std::ranges::find(*corners, v) != corners->end()) continue;
      if (!is_in_ball(descent.simplex(), points[v])) continue;
      (*corners)[descent.step(points[v])] = v;
      moved = true;
    }
  }
  return corners;
}

template std::optional<std::array<VertexNumber, 3>> first_delaunay_simplex(const ApexSearch<2>&);
template std::optional<std::array<VertexNumber, 4>> first_delaunay_simplex(const ApexSearch<3>&);

}  // namespace delray::delaunay::internal
