// Turns simplices to be positively oriented, asks the verifier whether they triangulate the points,
// links them and hands them to the flips of their dimension.
#include "delaunay/improve.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

#include "delaunay/construction/flip_edges.h"
#include "delaunay/construction/flip_facets.h"
#include "delaunay/insertion/insertion_start.h"
#include "delaunay/mesh/arguments.h"
#include "delaunay/mesh/build_mesh.h"
#include "delaunay/mesh/equal_points.h"
#include "delaunay/mesh/facets.h"
#include "delaunay/predicates.h"

namespace delray::delaunay {
namespace {

using internal::Position;

int orientation_of(const std::vector<glm::dvec2>& p, const std::uint32_t* v) {
  return orient2d(p[v[0]], p[v[1]], p[v[2]]);
}
int orientation_of(const std::vector<glm::dvec3>& p, const std::uint32_t* v) {
  return orient3d(p[v[0]], p[v[1]], p[v[2]], p[v[3]]);
}

// Vertices that are no rows are left to the verifier.
template <int D>
std::uint64_t turn(const std::vector<Position<D>>& points, std::vector<std::uint32_t>& vertices) {
  std::uint64_t turned = 0;
  for (std::size_t first = 0; first < vertices.size(); first += D + 1) {
    std::uint32_t* const simplex = vertices.data() + first;
    if (std::any_of(simplex, simplex + D + 1, [&](std::uint32_t v) { return v >= points.size(); }))
      continue;
    if (orientation_of(points, simplex) >= 0) continue;
    std::swap(simplex[0], simplex[1]);
    ++turned;
  }
  return turned;
}

// mesh_of() leaves ghosts without each other.
void link_ghosts(Mesh<3>& mesh) {
  std::vector<SimplexNumber> ghosts;
  std::vector<std::uint32_t> triangles;
  VertexNumber last = 0;
  for (SimplexNumber t = 0; t < mesh.size(); ++t) {
    if (mesh.vertex(t, 3) != kInfiniteVertex) continue;
    ghosts.push_back(t);
    for (unsigned k = 0; k < 3; ++k) {
      triangles.push_back(mesh.vertex(t, k));
      last = std::max(last, triangles.back());
    }
  }
  const FacetMates edges = match_facets(2, triangles, std::size_t{last} + 1);
  for (std::uint32_t edge = 0; edge < triangles.size(); ++edge) {
    const std::uint32_t mate = edges.mates[edge];
    mesh.set_neighbour(ghosts[edge / 3], edge % 3, corner_of(ghosts[mate / 3], mate % 3));
  }
}

void flip_all(Mesh<2>& mesh, const std::vector<glm::dvec2>& points, Criterion criterion,
              Improved& result, std::vector<CornerNumber>&) {
  result.flips.two_two = criterion == Criterion::circle
                             ? internal::flip_to_delaunay(mesh, points)
                             : internal::flip_to_largest_angles(mesh, points);
}
void flip_all(Mesh<3>& mesh, const std::vector<glm::dvec3>& points, Criterion, Improved& result,
              std::vector<CornerNumber>& blocked) {
  link_ghosts(mesh);
  internal::FacetFlips made = internal::flip_facets(mesh, points);
  result.flips = made.flips;
  blocked = std::move(made.blocked);
}

template <int D>
Improved improve_in(PointView<double> points, const Triangulation& given, Criterion criterion) {
  Improved result;
  Triangulation simplices = given;
  const std::vector<Position<D>> positions = internal::positions<D>(points);
  result.turned = turn<D>(positions, simplices.vertices);
  result.given = verify_simplices(D, points, simplices.vertices);
  if (!result.given.valid) return result;
  const std::vector<std::uint32_t> lowest = lowest_equal_rows(points, D);
  for (std::uint32_t& vertex : simplices.vertices) vertex = lowest[vertex];
  result.triangulation.dim = D;
  result.triangulation.distinct = result.given.distinct;
  const FacetMates facets = match_facets(D, simplices.vertices, points.size());
  simplices.hull_facets = result.triangulation.hull_facets =
      static_cast<std::uint64_t>(std::ranges::count(facets.mates, FacetMates::kNone));
  Mesh<D> mesh = mesh_of<D>(simplices, points.size()).mesh;
  std::vector<CornerNumber> blocked;
  flip_all(mesh, positions, criterion, result, blocked);
  result.blocked = blocked.size();
  std::vector<bool> is_at_blocked(mesh.size());
  for (const CornerNumber corner : blocked) {
    is_at_blocked[simplex_of(corner)] = is_at_blocked[simplex_of(mesh.neighbour(corner))] = true;
  }
  for (SimplexNumber t = 0; t < mesh.size(); ++t) {
    if (mesh.is_dead(t) || mesh.is_ghost(t)) continue;
    if (is_at_blocked[t] && !result.first_blocked) {
      result.first_blocked = result.triangulation.size();
    }
    for (unsigned k = 0; k <= D; ++k) result.triangulation.vertices.push_back(mesh.vertex(t, k));
  }
  return result;
}

}  // namespace

std::span<const CriterionChoice> criteria() {
  static const std::vector<CriterionChoice> table = {
      {"circle",
       "an edge or a face goes when the circle or sphere of one side holds the vertex of the other",
       Criterion::circle,
       {2, 3}},
      {"angle",
       "an edge goes when that makes the smallest angle of its two triangles larger; in 2D only",
       Criterion::angle,
       {2}},
  };
  return table;
}

Improved improve(PointView<double> points, const Triangulation& given, Criterion criterion) {
  internal::check_view(points, given.dim);
  internal::check_simplices(given.dim, given.vertices, std::numeric_limits<std::size_t>::max());
  const auto choice = std::ranges::find(criteria(), criterion, &CriterionChoice::criterion);
  if (std::ranges::find(choice->dims, given.dim) == choice->dims.end()) {
    throw std::invalid_argument("criterion \"" + std::string(choice->name) + "\" is not for " +
                                std::to_string(given.dim) + "D");
  }
  return given.dim == 2 ? improve_in<2>(points, given, criterion)
                        : improve_in<3>(points, given, criterion);
}

}  // namespace delray::delaunay
