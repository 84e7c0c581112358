// A Delaunay mesh whose vertices come and go.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "delaunay/mesh/mesh.h"

namespace delray::delaunay::internal {

// The slots of a mesh: those that removals left are used first. A policy for access as in access.h.
template <int D>
class Slots {
 public:
  const Mesh<D>& mesh() const { return mesh_; }
  Mesh<D>& mesh() { return mesh_; }
  SimplexNumber used() const { return used_; }  // slots from here on are free

  // All free but the first `used`.
  void restart(SimplexNumber used) {
    used_ = 0;
    free_.clear();
    reserve(used);
    used_ = used;
  }
  // Room for so many more simplices.
  void reserve(std::size_t more) {
    const std::size_t wanted = used_ + more;
    if (wanted <= mesh_.size()) return;
    mesh_.grow(std::min(std::max<std::size_t>({wanted, 2 * mesh_.size(), 64}), kMaximumSimplices));
  }
  bool acquire(SimplexNumber) const { return true; }
  SimplexNumber create() {
    if (free_.empty()) return used_++;
    const SimplexNumber slot = free_.back();
    free_.pop_back();
    return slot;
  }
  void retire(SimplexNumber simplex) {
    mesh_.set_vertex(corner_of(simplex, 0), kDeadVertex);
    free_.push_back(simplex);
  }

 private:
  Mesh<D> mesh_;
  SimplexNumber used_ = 0;
  std::vector<SimplexNumber> free_;
};

// For all functions: `points` are the positions of the vertices, `near` is a live simplex, better
// close than not.
template <int D>
class DynamicMesh;

template <>
class DynamicMesh<2> {
 public:
  const Mesh<2>& mesh() const { return slots_.mesh(); }
  SimplexNumber used() const { return slots_.used(); }
  void reserve_vertices(std::size_t n) { slots_.reserve(2 * n + 2); }

  // The first simplex. REQUIRES: the triangle turns left.
  void start(const std::array<VertexNumber, 3>& triangle);
  // Returns a simplex of the new vertex. REQUIRES: no vertex is in the same place.
  SimplexNumber insert(std::span<const glm::dvec2> points, VertexNumber vertex, SimplexNumber near);
  // Returns a simplex near where the vertex was; none, with the mesh as it was, if the `others`
  // vertices that there are beside it are all on one line.
  std::optional<SimplexNumber> remove(std::span<const glm::dvec2> points, VertexNumber vertex,
                                      SimplexNumber near, std::size_t others);
  // The neighbours of the last vertex removed.
  std::span<const VertexNumber> link() const { return link_; }

 private:
  Slots<2> slots_;
  std::vector<CornerNumber> suspects_;
  std::vector<VertexNumber> link_;
  std::uint32_t random_ = 1;
};

// Insertion by the cavity of simplices in conflict (Bowyer 1981, Watson 1981).
//
// Removal fills the hole with simplices of the triangulation of the neighbours: those of the
// triangulation without the vertex that lie in the hole have no other vertices, and a simplex in
// conflict with none of all points is in conflict with none of some (Devillers and Teillaud 2003).
template <>
class DynamicMesh<3> {
 public:
  const Mesh<3>& mesh() const { return slots_.mesh(); }
  SimplexNumber used() const { return slots_.used(); }
  // Evenly spread points have less than seven tetrahedra each.
  void reserve_vertices(std::size_t n) { slots_.reserve(7 * n + 64); }

  // As in 2D. REQUIRES: the tetrahedron is positively oriented.
  void start(const std::array<VertexNumber, 4>& tetrahedron);
  SimplexNumber insert(std::span<const glm::dvec3> points, VertexNumber vertex, SimplexNumber near);
  // None if the others are in one plane.
  std::optional<SimplexNumber> remove(std::span<const glm::dvec3> points, VertexNumber vertex,
                                      SimplexNumber near, std::size_t others);
  std::span<const VertexNumber> link() const { return link_; }

 private:
  // A simplex of a new vertex, or one that had an old one: the vertices with that vertex in
  // `corner`, and what lies beyond the facet opposite to it.
  struct Side {
    std::array<VertexNumber, 4> vertices;
    unsigned corner;
    CornerNumber outer;
    SimplexNumber number;
  };

  SimplexNumber locate(std::span<const glm::dvec3> points, const glm::dvec3& q,
                       SimplexNumber near) const;
  bool visit(SimplexNumber simplex);
  void visit_none();
  void link_sides();
  void find_star(VertexNumber vertex, SimplexNumber simplex);
  bool triangulate_link(std::span<const glm::dvec3> points);
  void fill();

  Slots<3> slots_;
  std::vector<std::uint32_t> visited_;  // per slot: the last round that saw it
  std::uint32_t round_ = 0;
  std::vector<SimplexNumber> cavity_;
  std::vector<Side> sides_;
  std::vector<VertexNumber> link_;
  std::unique_ptr<DynamicMesh> hole_;        // the triangulation of the neighbours
  std::vector<glm::dvec3> hole_points_;      // its points
  std::vector<VertexNumber> hole_vertices_;  // and their numbers here
};

}  // namespace delray::delaunay::internal
