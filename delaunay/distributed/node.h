// A simplex of a triangulation that ranks hold in parts: it names its neighbours by rank and
// number, and has the positions of its corners with it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "delaunay/tiles.h"

namespace delray::delaunay {

template <int D>
using Position = glm::vec<D, double, glm::defaultp>;

// Row of the infinite vertex: a corner of ghosts, the simplices beyond the hull (mesh/mesh.h).
constexpr std::uint64_t kInfiniteRow = ~std::uint64_t{0};

// The rank that has a node, and the rank that made it with its number there. Nodes that one
// insertion makes have consecutive numbers.
struct NodeId {
  std::uint32_t home = ~0U, maker = ~0U;
  std::uint64_t number = 0;
  bool operator==(const NodeId&) const = default;
};
constexpr NodeId kNoNodeId = {};

struct NodeIdHash {
  std::size_t operator()(const NodeId& id) const {
    std::uint64_t x = (id.number ^ (std::uint64_t{id.maker} << 40)) * 0x9e3779b97f4a7c15U;
    return static_cast<std::size_t>(x ^ (x >> 29));
  }
};

// Corners are positively oriented, with the infinite vertex anywhere on the far side. Neighbour k
// is that across the facet opposite to corner k.
template <int D>
struct Node {
  NodeId id;
  std::array<RowPoint, D + 1> corners;
  std::array<NodeId, D + 1> neighbours;
  // Of a node that is no more, those in its place: the first of them, and how many. A point that
  // is in conflict with it is in conflict with one of them.
  NodeId successor;
  std::uint64_t successors = 0;

  bool is_dead() const { return successors > 0; }
  // The corner with the infinite vertex; D + 1 if there is none.
  unsigned infinite_corner() const {
    unsigned k = 0;
    while (k <= D && corners[k].row != kInfiniteRow) ++k;
    return k;
  }
  bool is_ghost() const { return infinite_corner() <= D; }
};

// The first simplex of a triangulation: its corners, positively oriented.
template <int D>
using FirstSimplex = std::array<RowPoint, D + 1>;

// Whether q must not be left outside the node's circumsphere, by the rule of
// predicates/conflict.h. REQUIRES: q is no corner; the first simplex is one of the triangulation's.
template <int D>
bool conflict(const Node<D>& node, const FirstSimplex<D>& first, const glm::dvec3& q);

// The facet that q lies strictly beyond, one of them tried in order from `begin` on; D + 1 if the
// simplex contains q. REQUIRES: the node is no ghost.
template <int D>
unsigned facet_towards(const Node<D>& node, const glm::dvec3& q, unsigned begin);

// The first simplex and the ghosts around it, numbered from 0, made by rank 0, at home there.
template <int D>
std::vector<Node<D>> first_nodes(const FirstSimplex<D>& first);

}  // namespace delray::delaunay
