// Linear interpolation by barycentric coordinates, from areas or volumes seen from the query point,
// and natural-neighbour interpolation (Sibson 1981) as the weighted sum of natural_neighbours().
#include "delaunay/interpolate.h"

#include <array>
#include <cstdint>
#include <vector>

#include "delaunay/mesh/arguments.h"

namespace delray::delaunay {
namespace {

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }
double volume(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  return glm::dot(a, glm::cross(b, c));
}

// Weights of the vertices at the origin, not normalized.
std::array<double, 4> weights_at_origin(int dim, const std::array<glm::dvec3, 4>& p) {
  if (dim == 2) {
    return {cross({p[1].x, p[1].y}, {p[2].x, p[2].y}), cross({p[2].x, p[2].y}, {p[0].x, p[0].y}),
            cross({p[0].x, p[0].y}, {p[1].x, p[1].y}), 0};
  }
  return {volume(p[1], p[2], p[3]), -volume(p[0], p[2], p[3]), volume(p[0], p[1], p[3]),
          -volume(p[0], p[1], p[2])};
}

}  // namespace

std::optional<double> interpolate_linear(const Query& query, std::span<const double> values,
                                         const glm::dvec3& q) {
  internal::check_values(values.size(), query.points().size());
  const std::uint32_t simplex = query.locate(q);
  if (simplex == Query::kNone) return std::nullopt;
  const int dim = query.triangulation().dim;
  const std::size_t corners = static_cast<std::size_t>(dim) + 1;
  const std::uint32_t* rows = query.triangulation().vertices.data() + simplex * corners;
  std::array<glm::dvec3, 4> p{};
  for (std::size_t k = 0; k < corners; ++k) p[k] = query.position(rows[k]) - q;
  const auto weights = weights_at_origin(dim, p);
  double sum = 0, value = 0;
  for (std::size_t k = 0; k < corners; ++k) {
    sum += weights[k];
    value += weights[k] * values[rows[k]];
  }
  return value / sum;
}

std::optional<double> interpolate_natural_neighbour(const Query& query,
                                                    std::span<const double> values,
                                                    const glm::dvec3& q) {
  internal::check_values(values.size(), query.points().size());
  const std::vector<NaturalNeighbour> neighbours = natural_neighbours(query, q);
  if (neighbours.empty()) return std::nullopt;
  double value = 0;
  for (const NaturalNeighbour& neighbour : neighbours) {
    value += neighbour.weight * values[neighbour.row];
  }
  return value;
}

}  // namespace delray::delaunay
