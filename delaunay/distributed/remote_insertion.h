// The insertion of a point into a triangulation that ranks hold in parts: the simplices that are in
// conflict with it, its cavity, give way to those that join it to the cavity's border (Bowyer 1981,
// Watson 1981). In the plane and in space, hull or not, the same steps.
//
// Kohout (2004) subdivides a simplex and flips. That ends at the same simplices; a cavity needs
// fewer nodes of other ranks on the way.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "delaunay/distributed/areas.h"
#include "delaunay/distributed/node.h"
#include "delaunay/distributed/remote_nodes.h"

namespace delray::delaunay {

// Facets between what goes and what stays.
template <int D>
struct Cavity {
  struct Facet {
    NodeId inside, outside;
    unsigned corner = 0;  // of `inside`, opposite to the facet
  };
  std::vector<NodeId> inside;
  std::vector<Facet> border;
};

// Walks from a node towards q until one is in conflict with it, over facets that q lies beyond;
// from a dead node, to one in its place. `get(id)` gives a node or null. Returns the node that was
// found, or the one that get did not have.
//
// In a triangulation that does not change meanwhile no node comes twice (Edelsbrunner 1990).
struct WalkEnd {
  NodeId node;
  bool found = false;
};
template <int D, class Get>
WalkEnd walk(const FirstSimplex<D>& first, const glm::dvec3& q, NodeId id, const Get& get) {
  for (unsigned step = 0;; ++step) {
    const Node<D>* node = get(id);
    if (node == nullptr) return {id, false};
    if (node->is_dead()) {
      id = node->successor;
      continue;
    }
    const unsigned infinite = node->infinite_corner();
    const unsigned exit = infinite <= D ? (conflict(*node, first, q) ? D + 1 : infinite)
                                        : facet_towards(*node, q, step % (D + 1));
    if (exit > D) return {id, true};
    id = node->neighbours[exit];
  }
}

// Locks the cavity of q and the nodes around it, which get new neighbours; waits for others once
// for each ring of nodes around the start. Nothing where a lock was refused: then rollback() is
// due. REQUIRES: `start` is locked and in conflict with q.
template <int D>
std::optional<Cavity<D>> lock_cavity(RemoteNodes<D>& nodes, const NodeId& start,
                                     const FirstSimplex<D>& first, const glm::dvec3& q);

// The nodes that join the point to the border of its cavity, and what else changes with them.
// `home_of` names the rank where each will be at home.
template <int D>
Changes<D> make_star(RemoteNodes<D>& nodes, const Cavity<D>& cavity, const RowPoint& point,
                     const std::function<std::uint32_t(const Node<D>&)>& home_of);

// Points in the order in which a rank inserts them (`brio`, insertion/insertion_order.h).
template <int D>
std::vector<RowPoint> in_insertion_order(std::vector<RowPoint> points, std::uint64_t seed);

// The simplices that are at home on this rank.
template <int D>
TiledTriangulation extract_simplices(const RemoteNodes<D>& nodes);

// How many of them have corners in areas of several ranks.
template <int D>
std::uint64_t count_shared(const RemoteNodes<D>& nodes, const Areas& areas);

}  // namespace delray::delaunay
