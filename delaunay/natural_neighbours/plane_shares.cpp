// Shares in doubles where their error bound allows it, in wider numbers otherwise (Sibson 1981; see
// natural_shares.h). Sums are rounded in the order of the triangles: they are sorted first.
#include "delaunay/natural_neighbours/plane_shares.h"

#include <algorithm>
#include <cstddef>

#include "delaunay/natural_neighbours/natural_shares.h"
#include "delaunay/predicates.h"

namespace delray::delaunay::internal {
namespace {

// From its lowest row on.
void begin_with_lowest(CavityTriangle& triangle) {
  const auto lowest =
      static_cast<std::size_t>(std::ranges::min_element(triangle.rows) - triangle.rows.begin());
  const CavityTriangle t = triangle;
  triangle.hull = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t from = (k + lowest) % 3;
    triangle.rows[k] = t.rows[from];
    triangle.at[k] = t.at[from];
    triangle.hull |= static_cast<std::uint8_t>((t.hull >> from & 1) << k);
  }
}

}  // namespace

std::vector<NaturalNeighbour> shares_of_length(const PlacedVertex& a, const PlacedVertex& b,
                                               const glm::dvec3& q) {
  const glm::dvec3 &start = a.at, &end = b.at;
  // Halves: a difference of doubles may be too large.
  const glm::dvec3 length = glm::abs(0.5 * end - 0.5 * start);
  const int k = length.x >= length.y && length.x >= length.z ? 0 : length.y >= length.z ? 1 : 2;
  const double of_a =
      std::clamp((0.5 * end[k] - 0.5 * q[k]) / (0.5 * end[k] - 0.5 * start[k]), 0.0, 1.0);
  return {{a.row, of_a}, {b.row, 1 - of_a}};
}

std::vector<NaturalNeighbour> shares_in_plane(std::vector<CavityTriangle>& cavity,
                                              const glm::dvec2& q) {
  for (CavityTriangle& triangle : cavity) begin_with_lowest(triangle);
  std::ranges::sort(cavity, {}, &CavityTriangle::rows);
  std::vector<Triangle<double>> triangles;
  triangles.reserve(cavity.size());
  for (const CavityTriangle& t : cavity) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t start = (k + 1) % 3, end = (k + 2) % 3;
      if ((t.hull >> k & 1) == 0 || orient2d(t.at[start], t.at[end], q) != 0) continue;
      return shares_of_length({t.rows[start], {t.at[start], 0}}, {t.rows[end], {t.at[end], 0}},
                              {q, 0});
    }
    Triangle<double>& triangle = triangles.emplace_back();
    triangle.rows = t.rows;
    for (std::size_t k = 0; k < 3; ++k) triangle.at[k] = to_vector<double>(t.at[k]);
  }
  auto shares = shares_of_area<double>(triangles, to_vector<double>(q));
  return shares ? *std::move(shares) : wide_shares_of_area(triangles, q);
}

}  // namespace delray::delaunay::internal
