// Natural neighbours of a place and their shares (Sibson 1981).
//
// The simplices whose circumspheres hold the place are collected from the one that contains it
// outward (Bowyer 1981, Watson 1981). Their vertices are the neighbours, and shares_in_plane() or
// shares_of_volume() measure what each cell would lose, in doubles where an error bound allows it
// and in wider numbers otherwise. The cost of the location, plus O(k log k) for k such simplices.
//
// Degenerate: a place at a vertex has that neighbour alone. On an edge of the hull shares are
// lengths, on a face of a 3D hull they are areas within its plane; which of these holds is decided
// by exact predicates.
#include "delaunay/interpolate.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>

#include "delaunay/insertion/first_tetrahedron.h"
#include "delaunay/natural_neighbours/natural_shares.h"
#include "delaunay/natural_neighbours/plane_shares.h"
#include "delaunay/predicates.h"

namespace delray::delaunay {
namespace {

using internal::kFacets;
using internal::SpaceTriangle;
using internal::Tetrahedron;

// The simplices whose spheres hold q, that of q first, and where each is among them.
struct Cavity {
  std::vector<std::uint32_t> simplices;
  std::unordered_map<std::uint32_t, std::size_t> places;
};

Cavity cavity_of(const Query& query, std::uint32_t first, const glm::dvec3& q) {
  const auto& vertices = query.triangulation().vertices;
  const int dim = query.triangulation().dim;
  const auto corners = static_cast<std::size_t>(dim) + 1;
  const auto holds = [&](std::uint32_t simplex) {
    std::array<glm::dvec3, 4> p{};
    for (std::size_t k = 0; k < corners; ++k) {
      p[k] = query.position(vertices[simplex * corners + k]);
    }
    return dim == 2
               ? incircle(glm::dvec2(p[0]), glm::dvec2(p[1]), glm::dvec2(p[2]), glm::dvec2(q)) > 0
               : insphere(p[0], p[1], p[2], p[3], q) > 0;
  };
  Cavity cavity{{first}, {{first, 0}}};
  for (std::size_t i = 0; i < cavity.simplices.size(); ++i) {
    for (std::size_t k = 0; k < corners; ++k) {
      const std::uint32_t next = query.adjacency().neighbours[cavity.simplices[i] * corners + k];
      if (next == Query::kNone || cavity.places.contains(next) || !holds(next)) continue;
      cavity.places.emplace(next, cavity.simplices.size());
      cavity.simplices.push_back(next);
    }
  }
  return cavity;
}

std::vector<NaturalNeighbour> neighbours_in_plane(const Query& query, const Cavity& cavity,
                                                  const glm::dvec3& q) {
  std::vector<internal::CavityTriangle> triangles;
  triangles.reserve(cavity.simplices.size());
  for (const std::uint32_t t : cavity.simplices) {
    internal::CavityTriangle& triangle = triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t corner = 3 * std::size_t{t} + k;
      triangle.rows[k] = query.triangulation().vertices[corner];
      triangle.at[k] = glm::dvec2(query.position(triangle.rows[k]));
      if (query.adjacency().neighbours[corner] == Query::kNone) {
        triangle.hull |= static_cast<std::uint8_t>(1U << k);
      }
    }
  }
  return internal::shares_in_plane(triangles, glm::dvec2(q));
}

// The edge that is of one triangle only and on a line with q.
std::optional<std::pair<std::uint32_t, std::uint32_t>> side_of(
    const Query& query, std::span<const SpaceTriangle> triangles, const glm::dvec3& q) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const SpaceTriangle& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) edges.emplace_back(t.rows[k], t.rows[(k + 1) % 3]);
  }
  std::ranges::sort(edges);
  for (const auto& [a, b] : edges) {
    if (!std::ranges::binary_search(edges, std::pair(b, a)) &&
        internal::are_collinear(query.position(a), query.position(b), q)) {
      return std::pair(a, b);
    }
  }
  return std::nullopt;
}

// Neighbours of q in the plane of a facet of the hull: those within that plane.
std::vector<NaturalNeighbour> neighbours_on_hull(const Query& query,
                                                 const std::vector<Tetrahedron>& cavity,
                                                 const std::array<glm::dvec3, 3>& plane,
                                                 const glm::dvec3& q) {
  std::vector<SpaceTriangle> triangles;
  for (const Tetrahedron& t : cavity) {
    for (std::size_t k = 0; k < 4; ++k) {
      if (!t.is_side(k)) continue;
      SpaceTriangle triangle;
      bool in_plane = true;
      for (std::size_t i = 0; i < 3; ++i) {
        triangle.rows[i] = t.rows[kFacets[k][i]];
        triangle.at[i] = t.at[kFacets[k][i]];
        in_plane &= orient3d(plane[0], plane[1], plane[2], triangle.at[i]) == 0;
      }
      if (in_plane) triangles.push_back(triangle);
    }
  }
  if (const auto side = side_of(query, triangles, q)) {
    const auto vertex = [&](std::uint32_t row) {
      return internal::PlacedVertex{row, query.position(row)};
    };
    return internal::shares_of_length(vertex(side->first), vertex(side->second), q);
  }
  return internal::wide_shares_in_plane(triangles, plane, q);
}

std::vector<NaturalNeighbour> neighbours_in_space(const Query& query, const Cavity& simplices,
                                                  const glm::dvec3& q) {
  std::vector<Tetrahedron> cavity;
  for (const std::uint32_t simplex : simplices.simplices) {
    Tetrahedron& t = cavity.emplace_back();
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t corner = 4 * std::size_t{simplex} + k;
      t.rows[k] = query.triangulation().vertices[corner];
      t.at[k] = query.position(t.rows[k]);
      const std::uint32_t next = query.adjacency().neighbours[corner];
      const auto beyond = simplices.places.find(next);
      t.beyond[k] = beyond == simplices.places.end() ? Tetrahedron::kNone : beyond->second;
    }
  }
  // A plane of q and a side cuts the spheres on either side of it in one circle, which holds q: so
  // there is nothing on the other side.
  for (std::size_t i = 0; i < cavity.size(); ++i) {
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t corner = 4 * std::size_t{simplices.simplices[i]} + k;
      if (query.adjacency().neighbours[corner] != Query::kNone) continue;
      const std::array<glm::dvec3, 3> plane = {
          cavity[i].at[kFacets[k][0]], cavity[i].at[kFacets[k][1]], cavity[i].at[kFacets[k][2]]};
      if (orient3d(plane[0], plane[1], plane[2], q) == 0) {
        return neighbours_on_hull(query, cavity, plane, q);
      }
    }
  }
  auto shares = internal::shares_of_volume<double>(cavity, q);
  return shares ? *std::move(shares) : internal::wide_shares_of_volume(cavity, q);
}

}  // namespace

std::vector<NaturalNeighbour> natural_neighbours(const Query& query, const glm::dvec3& q) {
  const std::uint32_t first = query.locate(q);
  if (first == Query::kNone) return {};
  const int dim = query.triangulation().dim;
  const glm::dvec3 asked(q.x, q.y, dim == 3 ? q.z : 0.0);
  const auto corners = static_cast<std::size_t>(dim) + 1;
  for (std::size_t k = 0; k < corners; ++k) {
    const std::uint32_t row = query.triangulation().vertices[first * corners + k];
    if (query.position(row) == asked) return {{row, 1.0}};
  }
  const Cavity cavity = cavity_of(query, first, asked);
  return dim == 2 ? neighbours_in_plane(query, cavity, asked)
                  : neighbours_in_space(query, cavity, asked);
}

}  // namespace delray::delaunay
