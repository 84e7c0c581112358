// The dual of a Delaunay triangulation: circumcentres relative to the first corner, edges between
// neighbours, rays from hull facets. In 2D a cell is listed by turning about its vertex over
// neighbours, in 3D by a counting sort of the corners by vertex. O(n) expected.
#include "delaunay/voronoi.h"

#include "delaunay/mesh/arguments.h"
#include "parallel/parallel_for.h"

namespace delray::delaunay {
namespace {

struct Dual {
  PointView<double> points;
  const Triangulation& triangulation;
  const Adjacency& adjacency;

  std::size_t corners() const { return static_cast<std::size_t>(triangulation.dim) + 1; }
  std::uint32_t row(std::size_t simplex, std::size_t k) const {
    return triangulation.vertices[simplex * corners() + k];
  }
  glm::dvec3 at(std::size_t simplex, std::size_t k) const {
    const std::uint32_t i = row(simplex, k);
    return {points(i, 0), points(i, 1), triangulation.dim == 3 ? points(i, 2) : 0.0};
  }
};

glm::dvec3 circumcentre(const Dual& dual, std::size_t simplex) {
  const glm::dvec3 origin = dual.at(simplex, 0);
  const glm::dvec3 a = dual.at(simplex, 1) - origin, b = dual.at(simplex, 2) - origin;
  if (dual.triangulation.dim == 2) {
    const double aa = glm::dot(a, a), bb = glm::dot(b, b), twice = 2 * (a.x * b.y - a.y * b.x);
    return origin + glm::dvec3(b.y * aa - a.y * bb, a.x * bb - b.x * aa, 0) / twice;
  }
  const glm::dvec3 c = dual.at(simplex, 3) - origin;
  const glm::dvec3 sum = glm::dot(a, a) * glm::cross(b, c) + glm::dot(b, b) * glm::cross(c, a) +
                         glm::dot(c, c) * glm::cross(a, b);
  return origin + sum / (2 * glm::dot(a, glm::cross(b, c)));
}

glm::dvec3 outward_normal(const Dual& dual, std::size_t simplex, std::size_t k) {
  const glm::dvec3 inner = dual.at(simplex, k);
  if (dual.triangulation.dim == 2) {
    const glm::dvec3 edge = dual.at(simplex, (k + 2) % 3) - dual.at(simplex, (k + 1) % 3);
    return glm::normalize(glm::dvec3(edge.y, -edge.x, 0));
  }
  const glm::dvec3 a = dual.at(simplex, (k + 1) % 4);
  const glm::dvec3 normal = glm::normalize(
      glm::cross(dual.at(simplex, (k + 2) % 4) - a, dual.at(simplex, (k + 3) % 4) - a));
  return glm::dot(normal, inner - a) > 0 ? -normal : normal;
}

// The triangles around a vertex counterclockwise, from the hull on if it is there.
void append_in_turn(const Dual& dual, std::uint32_t vertex, std::vector<std::uint32_t>& cells) {
  const auto corner_in = [&](std::uint32_t t) -> std::size_t {
    return dual.row(t, 0) == vertex ? 0 : dual.row(t, 1) == vertex ? 1 : 2;
  };
  const auto beyond = [&](std::uint32_t t, std::size_t turn) {
    return dual.adjacency.neighbours[3 * std::size_t{t} + (corner_in(t) + turn) % 3];
  };
  const std::uint32_t known = dual.adjacency.simplex_at[vertex];
  std::uint32_t first = known;
  // Clockwise, over the edge from the vertex to the next one of the triangle.
  for (std::uint32_t t = beyond(known, 2); t != Adjacency::kNone && t != known; t = beyond(t, 2))
    first = t;
  if (beyond(first, 2) != Adjacency::kNone) first = known;
  std::uint32_t t = first;
  do {
    cells.push_back(t);
    t = beyond(t, 1);
  } while (t != Adjacency::kNone && t != first);
}

}  // namespace

Voronoi voronoi(PointView<double> points, const Triangulation& triangulation,
                const Adjacency& adjacency) {
  internal::check_view(points, triangulation.dim);
  internal::check_triangulation(triangulation, points.size());
  if (adjacency.neighbours.size() != triangulation.vertices.size() ||
      adjacency.simplex_at.size() != points.size())
    throw std::invalid_argument("the adjacency is of another triangulation");
  const Dual dual{points, triangulation, adjacency};
  const std::size_t corners = dual.corners();
  Voronoi result;
  result.vertices.resize(triangulation.size());
  constexpr std::size_t kGrain = 8192;  // simplices: about 0.2 ms
  parallel::parallel_for(0, triangulation.size(), kGrain,
                         [&](std::size_t t) { result.vertices[t] = circumcentre(dual, t); });
  for (std::size_t i = 0; i < triangulation.vertices.size(); ++i) {
    const auto t = static_cast<std::uint32_t>(i / corners);
    const std::uint32_t next = adjacency.neighbours[i];
    if (next == Adjacency::kNone) {
      result.ray_starts.push_back(t);
      result.ray_directions.push_back(outward_normal(dual, t, i % corners));
    } else if (t < next) {
      result.edges.push_back(t);
      result.edges.push_back(next);
    }
  }
  const std::size_t rows = adjacency.simplex_at.size();
  result.cell_begin.assign(rows + 1, 0);
  if (triangulation.dim == 2) {
    for (std::uint32_t row = 0; row < rows; ++row) {
      if (adjacency.simplex_at[row] != Adjacency::kNone) append_in_turn(dual, row, result.cells);
      result.cell_begin[row + 1] = static_cast<std::uint32_t>(result.cells.size());
    }
    return result;
  }
  for (const std::uint32_t row : triangulation.vertices) ++result.cell_begin[row + 1];
  for (std::size_t row = 0; row < rows; ++row) result.cell_begin[row + 1] += result.cell_begin[row];
  result.cells.resize(triangulation.vertices.size());
  std::vector<std::uint32_t> next(result.cell_begin.begin(), result.cell_begin.end() - 1);
  for (std::size_t i = 0; i < triangulation.vertices.size(); ++i) {
    result.cells[next[triangulation.vertices[i]]++] = static_cast<std::uint32_t>(i / corners);
  }
  return result;
}

}  // namespace delray::delaunay
