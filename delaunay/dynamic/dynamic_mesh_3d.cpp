// Insertion and removal of a vertex in a 3D Delaunay mesh.
//
// An insertion replaces the tetrahedra in conflict with the point by those between it and the
// boundary of their cavity (Bowyer 1981, Watson 1981). A removal triangulates the neighbours of the
// vertex apart and copies the tetrahedra that lie within the hole (Devillers and Teillaud 2003),
// matched with the hole's facets by their sorted vertices. A removal costs a triangulation of the
// neighbours.
//
// Degenerate: where all neighbours lie in one plane vertices beyond the hole are added until one
// lies outside it; if none does, the remaining vertices are coplanar and nothing is changed.
#include <cassert>

#include "delaunay/dynamic/dynamic_mesh.h"
#include "delaunay/insertion/facet_walk.h"
#include "delaunay/insertion/first_tetrahedron.h"
#include "delaunay/mesh/edge_pairs.h"
#include "delaunay/mesh/start_mesh.h"
#include "delaunay/predicates.h"
#include "delaunay/predicates/conflict.h"

namespace delray::delaunay::internal {
namespace {

constexpr std::uint32_t kNoWall = 0xffffffffU;

// A facet of a positively oriented simplex, and the side of it that the simplex is on: simplices on
// the same side of a facet are equal here.
struct Facet {
  std::array<VertexNumber, 3> vertices;  // ascending
  bool side;
  auto operator<=>(const Facet&) const = default;
};

Facet facet_of(const std::array<VertexNumber, 4>& simplex, unsigned corner) {
  Facet facet{};
  unsigned next = 0;
  for (unsigned k = 0; k < 4; ++k) {
    if (k != corner) facet.vertices[next++] = simplex[k];
  }
  // The parity of the order (corner, vertices ascending) of the simplex.
  facet.side = corner % 2 != 0;
  const auto sort = [&](unsigned i, unsigned j) {
    if (facet.vertices[i] < facet.vertices[j]) return;
    std::swap(facet.vertices[i], facet.vertices[j]);
    facet.side = !facet.side;
  };
  sort(0, 1);
  sort(1, 2);
  sort(0, 1);
  return facet;
}

std::array<VertexNumber, 4> vertices_of(const Mesh<3>& mesh, SimplexNumber simplex) {
  std::array<VertexNumber, 4> result;
  for (unsigned k = 0; k < 4; ++k) result[k] = mesh.vertex(corner_of(simplex, k));
  return result;
}

}  // namespace

void DynamicMesh<3>::start(const std::array<VertexNumber, 4>& tetrahedron) {
  slots_.restart(5);
  start_mesh(slots_.mesh(), tetrahedron);
}

void DynamicMesh<3>::visit_none() {
  visited_.resize(mesh().size(), 0);
  if (++round_ != 0) return;
  std::ranges::fill(visited_, 0U);
  round_ = 1;
}

// Whether this is the first visit.
bool DynamicMesh<3>::visit(SimplexNumber simplex) {
  if (visited_[simplex] == round_) return false;
  visited_[simplex] = round_;
  return true;
}

// A finite simplex that contains q, or a ghost whose facet q is strictly beyond.
SimplexNumber DynamicMesh<3>::locate(std::span<const glm::dvec3> points, const glm::dvec3& q,
                                     SimplexNumber near) const {
  SimplexNumber start = near;
  for (unsigned k = 0; k < 4; ++k) {
    const CornerNumber corner = corner_of(near, k);
    if (mesh().vertex(corner) == kInfiniteVertex) start = simplex_of(mesh().neighbour(corner));
  }
  return walk_over_facets(mesh(), start, [&](SimplexNumber here, unsigned entered) {
    if (entered != kNoFacet && mesh().vertex(corner_of(here, entered)) == kInfiniteVertex)
      return kNoFacet;
    std::array<glm::dvec3, 4> p;
    for (unsigned k = 0; k < 4; ++k) p[k] = points[mesh().vertex(corner_of(here, k))];
    return exit_facet(0, entered, [&](unsigned k) {
      std::array<glm::dvec3, 4> turned = p;
      turned[k] = q;
      return orient3d(turned[0], turned[1], turned[2], turned[3]) < 0;
    });
  });
}

// Links the sides with each other over the edges that they have in common.
void DynamicMesh<3>::link_sides() {
  EdgePairs<CornerNumber> pairs(3 * sides_.size());
  for (const Side& side : sides_) {
    for (unsigned k = 0; k < 4; ++k) {
      if (k == side.corner) continue;
      std::array<VertexNumber, 2> ends{};
      unsigned next = 0;
      for (unsigned j = 0; j < 4; ++j) {
        if (j != k && j != side.corner) ends[next++] = side.vertices[j];
      }
      pairs.add(ends[0], ends[1], corner_of(side.number, k));
    }
  }
  pairs.for_each([&](CornerNumber a, CornerNumber b) { slots_.mesh().link(a, b); });
}

SimplexNumber DynamicMesh<3>::insert(std::span<const glm::dvec3> points, VertexNumber vertex,
                                     SimplexNumber near) {
  const glm::dvec3& q = points[vertex];
  visit_none();
  sides_.clear();
  cavity_ = {locate(points, q, near)};
  visit(cavity_[0]);
  for (std::size_t i = 0; i < cavity_.size(); ++i) {
    for (unsigned k = 0; k < 4; ++k) {
      const CornerNumber outer = mesh().neighbour(corner_of(cavity_[i], k));
      const SimplexNumber other = simplex_of(outer);
      if (visited_[other] == round_) continue;
      if (conflict(mesh(), points, other, q)) {
        visit(other);
        cavity_.push_back(other);
        continue;
      }
      Side side{vertices_of(mesh(), cavity_[i]), k, outer, 0};
      side.vertices[k] = vertex;
      sides_.push_back(side);
    }
  }
  for (const SimplexNumber simplex : cavity_) slots_.retire(simplex);
  slots_.reserve(sides_.size());
  for (Side& side : sides_) {
    side.number = slots_.create();
    for (unsigned k = 0; k < 4; ++k) {
      slots_.mesh().set_vertex(corner_of(side.number, k), side.vertices[k]);
    }
    slots_.mesh().link(corner_of(side.number, side.corner), side.outer);
  }
  link_sides();
  return sides_.back().number;
}

// The simplices around a vertex, as cavity and sides, and its neighbours.
void DynamicMesh<3>::find_star(VertexNumber vertex, SimplexNumber simplex) {
  visit_none();
  sides_.clear();
  link_.clear();
  cavity_ = {simplex};
  visit(simplex);
  for (std::size_t i = 0; i < cavity_.size(); ++i) {
    const auto vertices = vertices_of(mesh(), cavity_[i]);
    for (unsigned k = 0; k < 4; ++k) {
      const CornerNumber outer = mesh().neighbour(corner_of(cavity_[i], k));
      if (vertices[k] == vertex) {
        sides_.push_back({vertices, k, outer, cavity_[i]});
        continue;
      }
      if (vertices[k] != kInfiniteVertex) link_.push_back(vertices[k]);
      if (visit(simplex_of(outer))) cavity_.push_back(simplex_of(outer));
    }
  }
  std::ranges::sort(link_);
  link_.erase(std::unique(link_.begin(), link_.end()), link_.end());
}

// Triangulates the neighbours. If they are in one plane, something beside it is needed that tells
// above from below; false if there is nothing.
bool DynamicMesh<3>::triangulate_link(std::span<const glm::dvec3> points) {
  hole_vertices_ = link_;
  hole_points_.clear();
  for (const VertexNumber vertex : link_) hole_points_.push_back(points[vertex]);
  auto start = first_tetrahedron(hole_points_);
  for (std::size_t i = 0; i < sides_.size() && !start; ++i) {
    const VertexNumber beyond = mesh().vertex(sides_[i].outer);
    if (mesh().is_ghost(simplex_of(sides_[i].outer))) continue;
    hole_vertices_.push_back(beyond);
    hole_points_.push_back(points[beyond]);
    start = first_tetrahedron(hole_points_);
  }
  if (!start) return false;
  if (!hole_) hole_ = std::make_unique<DynamicMesh>();
  hole_->start(*start);
  SimplexNumber near = 0;
  for (VertexNumber i = 0; i < hole_points_.size(); ++i) {
    if (std::ranges::find(*start, i) == start->end()) near = hole_->insert(hole_points_, i, near);
  }
  return true;
}

// Copies what the triangulation of the neighbours has within the sides.
void DynamicMesh<3>::fill() {
  const Mesh<3>& hole = hole_->mesh();
  std::vector<std::pair<Facet, std::uint32_t>> walls;
  for (std::uint32_t i = 0; i < sides_.size(); ++i) {
    walls.emplace_back(facet_of(sides_[i].vertices, sides_[i].corner), i);
  }
  std::ranges::sort(walls);
  const auto name = [&](VertexNumber vertex) {
    return vertex == kInfiniteVertex ? vertex : hole_vertices_[vertex];
  };
  std::vector<std::uint32_t> wall_at(4 * std::size_t{hole_->used()}, kNoWall);
  std::vector<SimplexNumber> number(hole_->used(), kNoWall), inside;
  const auto take = [&](SimplexNumber simplex) {
    if (number[simplex] != kNoWall) return;
    number[simplex] = 0;
    inside.push_back(simplex);
  };
  for (SimplexNumber t = 0; t < hole_->used(); ++t) {
    if (hole.is_dead(t)) continue;
    auto vertices = vertices_of(hole, t);
    for (VertexNumber& vertex : vertices) vertex = name(vertex);
    for (unsigned k = 0; k < 4; ++k) {
      const Facet facet = facet_of(vertices, k);
      const auto wall = std::ranges::lower_bound(
          walls, facet, {}, [](const auto& w) -> const Facet& { return w.first; });
      if (wall == walls.end() || wall->first != facet) continue;
      wall_at[corner_of(t, k)] = wall->second;
      take(t);
    }
  }
  for (std::size_t i = 0; i < inside.size(); ++i) {
    for (unsigned k = 0; k < 4; ++k) {
      const CornerNumber corner = corner_of(inside[i], k);
      if (wall_at[corner] == kNoWall) take(simplex_of(hole.neighbour(corner)));
    }
  }
  for (const SimplexNumber simplex : cavity_) slots_.retire(simplex);
  slots_.reserve(inside.size());
  Mesh<3>& mesh = slots_.mesh();
  for (const SimplexNumber t : inside) number[t] = slots_.create();
  for (const SimplexNumber t : inside) {
    for (unsigned k = 0; k < 4; ++k) {
      const CornerNumber from = corner_of(t, k), to = corner_of(number[t], k);
      mesh.set_vertex(to, name(hole.vertex(from)));
      if (wall_at[from] != kNoWall) {
        mesh.link(to, sides_[wall_at[from]].outer);
        continue;
      }
      const CornerNumber other = hole.neighbour(from);
      mesh.set_neighbour(to, corner_of(number[simplex_of(other)], other & 3U));
    }
  }
  cavity_.assign(1, number[inside.front()]);
}

std::optional<SimplexNumber> DynamicMesh<3>::remove(std::span<const glm::dvec3> points,
                                                    VertexNumber vertex, SimplexNumber near,
                                                    std::size_t others) {
  find_star(vertex, locate(points, points[vertex], near));
  const bool has_volume = triangulate_link(points);
  assert(has_volume || link_.size() == others);
  (void)others;
  if (!has_volume) return std::nullopt;
  fill();
  return cavity_[0];
}

}  // namespace delray::delaunay::internal
