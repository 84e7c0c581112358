#include "delaunay/interpolate.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <vector>

#include "delaunay/predicates.h"

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

glm::dvec2 circumcentre(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  const glm::dvec2 u = b - a, v = c - a;
  const double uu = glm::dot(u, u), vv = glm::dot(v, v), twice = 2 * cross(u, v);
  return a + glm::dvec2(v.y * uu - u.y * vv, u.x * vv - v.x * uu) / twice;
}

// What a neighbour of q loses: a polygon about it, from the centre at the edge of the cavity that
// leaves it over those of the triangles in the cavity to that at the edge that enters it.
struct Neighbour {
  std::uint32_t row;
  double area = 0;  // twice
  glm::dvec2 leaving{0}, entering{0};
};

Neighbour& neighbour_of(std::vector<Neighbour>& neighbours, std::uint32_t row) {
  const auto known = std::ranges::find(neighbours, row, &Neighbour::row);
  if (known != neighbours.end()) return *known;
  return neighbours.emplace_back(Neighbour{.row = row});
}

// The triangles whose circumcircles hold q, that of q first.
std::vector<std::uint32_t> cavity_of(const Query& query, std::uint32_t first, const glm::dvec2& q) {
  std::vector<std::uint32_t> cavity = {first};
  const auto& vertices = query.triangulation().vertices;
  const auto at = [&](std::size_t corner) { return glm::dvec2(query.position(vertices[corner])); };
  for (std::size_t i = 0; i < cavity.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t next = query.adjacency().neighbours[3 * std::size_t{cavity[i]} + k];
      if (next == Query::kNone || std::ranges::find(cavity, next) != cavity.end()) continue;
      const std::size_t corner = 3 * std::size_t{next};
      if (incircle(at(corner), at(corner + 1), at(corner + 2), q) > 0) cavity.push_back(next);
    }
  }
  return cavity;
}

}  // namespace

std::optional<double> interpolate_linear(const Query& query, std::span<const double> values,
                                         const glm::dvec3& q) {
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
  assert(query.triangulation().dim == 2);
  const std::uint32_t first = query.locate(q);
  if (first == Query::kNone) return std::nullopt;
  const glm::dvec2 centre(q);
  const auto& vertices = query.triangulation().vertices;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t row = vertices[3 * std::size_t{first} + k];
    if (glm::dvec2(query.position(row)) == centre) return values[row];
  }
  // Relative to q: areas are small beside coordinates.
  const auto at = [&](std::uint32_t row) { return glm::dvec2(query.position(row)) - centre; };
  const auto centre_of = [&](std::uint32_t t) {
    const std::uint32_t* v = vertices.data() + 3 * std::size_t{t};
    return circumcentre(at(v[0]), at(v[1]), at(v[2]));
  };
  const std::vector<std::uint32_t> cavity = cavity_of(query, first, centre);
  std::vector<Neighbour> neighbours;
  for (const std::uint32_t t : cavity) {
    const glm::dvec2 own = centre_of(t);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t corner = 3 * std::size_t{t};
      const std::uint32_t a = vertices[corner + (k + 1) % 3], b = vertices[corner + (k + 2) % 3];
      const std::uint32_t next = query.adjacency().neighbours[corner + k];
      if (next != Query::kNone && std::ranges::find(cavity, next) != cavity.end()) {
        neighbour_of(neighbours, a).area += cross(centre_of(next), own);
        continue;
      }
      if (orient2d(query.position(a), query.position(b), centre) == 0) {
        // On the hull all area goes to the two neighbours there.
        const double from_a = glm::length(at(a)), from_b = glm::length(at(b));
        return (values[a] * from_b + values[b] * from_a) / (from_a + from_b);
      }
      const glm::dvec2 beyond = circumcentre(glm::dvec2(0), at(a), at(b));
      Neighbour& leaving = neighbour_of(neighbours, a);
      leaving.area += cross(beyond, own);
      leaving.leaving = beyond;
      Neighbour& entering = neighbour_of(neighbours, b);
      entering.area += cross(own, beyond);
      entering.entering = beyond;
    }
  }
  double sum = 0, value = 0;
  for (const Neighbour& neighbour : neighbours) {
    const double area = neighbour.area + cross(neighbour.entering, neighbour.leaving);
    sum += area;
    value += area * values[neighbour.row];
  }
  return value / sum;
}

}  // namespace delray::delaunay
