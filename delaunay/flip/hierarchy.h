// Finding triangles through ever coarser triangulations (Devillers 1998).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <glm/glm.hpp>
#include <span>
#include <utility>
#include <vector>

#include "delaunay/flip/flip_2d.h"
#include "delaunay/insertion/walk.h"
#include "delaunay/mesh/access.h"
#include "delaunay/mesh/array.h"
#include "delaunay/mesh/mesh.h"
#include "delaunay/mesh/random.h"
#include "delaunay/mesh/start_mesh.h"

namespace delray::delaunay::internal {

// Level 0 is the triangulation itself; every vertex of a level is in the next one too with a
// probability of 1 in 30, and those have one of their own. A walk through the coarsest leads to a
// triangle whose vertex nearest to the point is where the walk through the next finer one begins.
// O(log n) expected from anywhere, whatever the order of the points; a few percent more memory, and
// 4 bytes a vertex and level.
class Hierarchy {
 public:
  Hierarchy(std::span<const glm::dvec2> points, const std::array<VertexNumber, 3>& first,
            std::uint64_t seed)
      : points_(points), height_(points.size()), random_(static_cast<std::uint32_t>(seed) | 1) {
    std::array<std::size_t, kHighest + 1> sizes{};
    for (std::size_t vertex = 0; vertex < points.size(); ++vertex) {
      RowRandom random(seed, vertex);
      std::uint8_t height = 0;
      while (height < kHighest && random.below(kThinning) == 0) ++height;
      height_[vertex] = height;
      for (std::size_t k = 0; k <= height; ++k) ++sizes[k];
    }
    // A level of a few points is no shortcut.
    constexpr std::size_t kFewest = 20;
    const auto levels =
        std::ranges::find_if(sizes, [](std::size_t n) { return n < kFewest; }) - sizes.begin();
    highest_ = static_cast<std::size_t>(std::max<std::ptrdiff_t>(levels, 1)) - 1;
    for (const VertexNumber vertex : first) height_[vertex] = kHighest;
    for (std::size_t k = 0; k <= highest_; ++k) {
      // The first triangle may have come on top.
      levels_.emplace_back(2 * (sizes[k] + 3), k < highest_ ? points.size() : 0);
      start_mesh(levels_[k].mesh, first);
      if (k == highest_) continue;
      for (const VertexNumber vertex : first) levels_[k].at[vertex] = 0;
    }
  }

  Place locate(VertexNumber vertex) {
    const glm::dvec2& q = points_[vertex];
    SimplexNumber start = levels_[highest_].last;
    for (std::size_t k = highest_;; --k) {
      Level& level = levels_[k];
      level.place = walk(level.mesh, points_, start, q, random_);
      level.last = level.place.simplex;
      if (k == 0) return level.place;
      start = levels_[k - 1].at[nearest_vertex(level.mesh, level.place.simplex, q)];
    }
  }
  // REQUIRES: the vertex was located last.
  void subdivide(VertexNumber vertex, SimplexNumber) {
    for (std::size_t k = 0; k <= top_of(vertex); ++k) {
      Level& level = levels_[k];
      internal::subdivide(level.mesh, level.place.simplex, vertex, level.access, level.suspects);
    }
    vertex_ = vertex;
  }
  void legalize() {
    for (std::size_t k = 0; k <= top_of(vertex_); ++k) {
      Level& level = levels_[k];
      internal::legalize(level.mesh, points_, level.access, level.suspects);
      if (k < highest_) note_star(k);
    }
  }
  // Of the whole triangulation, not of coarser ones.
  const FlipCounts& flips() const { return levels_[0].access.flips(); }
  Mesh<2> take() {
    levels_[0].mesh.shrink(levels_[0].access.used());
    return std::move(levels_[0].mesh);
  }

 private:
  static constexpr std::uint64_t kThinning = 30;
  static constexpr std::uint8_t kHighest = 7;

  struct Level {
    Level(std::size_t simplices, std::size_t vertices) : mesh(simplices), at(vertices) {}

    Mesh<2> mesh;
    // A triangle, perhaps a ghost, at each vertex that is in the next level too.
    Array<SimplexNumber> at;
    SoleAccess access{4};
    std::vector<CornerNumber> suspects;
    SimplexNumber last = 0;  // where the last walk ended
    Place place{};           // of the point that is being inserted
  };

  std::size_t top_of(VertexNumber vertex) const {
    return std::min<std::size_t>(height_[vertex], highest_);
  }

  VertexNumber nearest_vertex(const Mesh<2>& mesh, SimplexNumber simplex,
                              const glm::dvec2& q) const {
    VertexNumber nearest = kInfiniteVertex;
    double least = 0;
    for (unsigned k = 0; k < 3; ++k) {
      const VertexNumber vertex = mesh.vertex(corner_of(simplex, k));
      if (vertex == kInfiniteVertex) continue;
      const glm::dvec2 way = points_[vertex] - q;
      const double distance = way.x * way.x + way.y * way.y;
      if (nearest != kInfiniteVertex && !(distance < least)) continue;
      nearest = vertex;
      least = distance;
    }
    return nearest;
  }

  // All vertices that have lost triangles to the new one are its neighbours now.
  void note_star(std::size_t k) {
    Level& level = levels_[k];
    // Flips leave the vertex in the corner that the subdivision gave it.
    const CornerNumber start = corner_of(level.place.simplex, 2);
    CornerNumber corner = start;
    do {
      const SimplexNumber simplex = simplex_of(corner);
      const VertexNumber next = level.mesh.vertex(next_corner(corner));
      if (next != kInfiniteVertex && top_of(next) > k) level.at[next] = simplex;
      // Counterclockwise around the vertex.
      corner = next_corner(level.mesh.neighbour(next_corner(corner)));
    } while (corner != start);
    if (top_of(vertex_) > k) level.at[vertex_] = simplex_of(start);
  }

  std::span<const glm::dvec2> points_;
  std::vector<std::uint8_t> height_;  // the last level of each vertex, if there are so many
  std::size_t highest_ = 0;
  std::deque<Level> levels_;
  VertexNumber vertex_ = 0;
  std::uint32_t random_;
};

}  // namespace delray::delaunay::internal
