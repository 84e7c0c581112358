// A cavity is connected, so a search over facets from one node finds it, ring by ring: nodes around
// those that are known are asked for at once. New nodes are neighbours
// where they share a ridge, the D - 1 corners besides the point and the one opposite.
//
// Degenerate: the perturbed rule of conflict leaves no flat simplices. O(border log border).
#include "delaunay/distributed/remote_insertion.h"

#include <algorithm>
#include <array>
#include <unordered_map>

#include "delaunay/insertion/insertion_order.h"

namespace delray::delaunay {

template <int D>
std::optional<Cavity<D>> lock_cavity(RemoteNodes<D>& nodes, const NodeId& start,
                                     const FirstSimplex<D>& first, const glm::dvec3& q) {
  Cavity<D> cavity;
  std::unordered_map<NodeId, bool, NodeIdHash> is_inside = {{start, true}};
  cavity.inside.push_back(start);
  std::vector<NodeId> ring;
  for (std::size_t begin = 0; begin < cavity.inside.size();) {
    const std::size_t end = cavity.inside.size();
    ring.clear();
    for (std::size_t i = begin; i < end; ++i) {
      for (const NodeId& neighbour : nodes.held(cavity.inside[i]).neighbours) {
        if (is_inside.emplace(neighbour, false).second) ring.push_back(neighbour);
      }
    }
    if (!nodes.lock(ring)) return std::nullopt;
    for (const NodeId& id : ring) {
      if (!conflict(nodes.held(id), first, q)) continue;
      is_inside[id] = true;
      cavity.inside.push_back(id);
    }
    begin = end;
  }
  for (const NodeId& inside : cavity.inside) {
    const std::array<NodeId, D + 1>& neighbours = nodes.held(inside).neighbours;
    for (unsigned k = 0; k <= D; ++k) {
      if (!is_inside.at(neighbours[k])) cavity.border.push_back({inside, neighbours[k], k});
    }
  }
  return cavity;
}

template <int D>
Changes<D> make_star(RemoteNodes<D>& nodes, const Cavity<D>& cavity, const RowPoint& point,
                     const std::function<std::uint32_t(const Node<D>&)>& home_of) {
  struct Ridge {
    std::array<std::uint64_t, D - 1> rows;
    std::size_t node;
    unsigned corner;  // opposite to the facet of the point and the ridge
  };
  const std::uint64_t number = nodes.new_numbers(cavity.border.size());
  std::vector<Ridge> ridges;
  Changes<D> changes;
  changes.row = point.row;
  changes.killed = cavity.inside;
  changes.successors = cavity.border.size();
  for (const auto& facet : cavity.border) {
    Node<D> node;
    node.corners = nodes.held(facet.inside).corners;
    node.corners[facet.corner] = point;
    node.neighbours[facet.corner] = facet.outside;
    const std::size_t i = changes.made.size();
    node.id = {home_of(node), static_cast<std::uint32_t>(nodes.rank()), number + i};
    changes.relinked.push_back({facet.outside, facet.inside, node.id});
    for (unsigned k = 0; k <= D; ++k) {
      if (k == facet.corner) continue;
      Ridge ridge{{}, i, k};
      std::size_t rows = 0;
      for (unsigned j = 0; j <= D; ++j) {
        if (j != k && j != facet.corner) ridge.rows[rows++] = node.corners[j].row;
      }
      std::ranges::sort(ridge.rows);
      ridges.push_back(ridge);
    }
    changes.made.push_back(node);
  }
  changes.successor = changes.made.at(0).id;
  std::ranges::sort(ridges, {}, &Ridge::rows);
  for (std::size_t i = 0; i + 1 < ridges.size(); i += 2) {
    const Ridge &a = ridges[i], &b = ridges[i + 1];
    changes.made[a.node].neighbours[a.corner] = changes.made[b.node].id;
    changes.made[b.node].neighbours[b.corner] = changes.made[a.node].id;
  }
  return changes;
}

template <int D>
std::vector<RowPoint> in_insertion_order(std::vector<RowPoint> points, std::uint64_t seed) {
  std::vector<Position<D>> positions;
  positions.reserve(points.size());
  for (const RowPoint& point : points) positions.push_back(Position<D>(point.position));
  std::vector<RowPoint> ordered;
  for (const std::uint32_t i :
       insertion_order(std::span<const Position<D>>(positions), "brio", seed)) {
    ordered.push_back(points[i]);
  }
  return ordered;
}

template <int D>
TiledTriangulation extract_simplices(const RemoteNodes<D>& nodes) {
  TiledTriangulation result;
  result.dim = D;
  nodes.for_each_living([&](const Node<D>& node) {
    if (node.is_ghost()) {
      ++result.hull_facets;
      return;
    }
    for (const RowPoint& corner : node.corners) result.vertices.push_back(corner.row);
  });
  return result;
}

template <int D>
std::uint64_t count_shared(const RemoteNodes<D>& nodes, const Areas& areas) {
  std::uint64_t shared = 0;
  nodes.for_each_living([&](const Node<D>& node) {
    if (node.is_ghost()) return;
    const int rank = areas.rank_of(node.corners[0].position);
    shared += std::ranges::any_of(node.corners, [&](const RowPoint& corner) {
      return areas.rank_of(corner.position) != rank;
    });
  });
  return shared;
}

template std::optional<Cavity<2>> lock_cavity<2>(RemoteNodes<2>&, const NodeId&,
                                                 const FirstSimplex<2>&, const glm::dvec3&);
template std::optional<Cavity<3>> lock_cavity<3>(RemoteNodes<3>&, const NodeId&,
                                                 const FirstSimplex<3>&, const glm::dvec3&);
template Changes<2> make_star<2>(RemoteNodes<2>&, const Cavity<2>&, const RowPoint&,
                                 const std::function<std::uint32_t(const Node<2>&)>&);
template Changes<3> make_star<3>(RemoteNodes<3>&, const Cavity<3>&, const RowPoint&,
                                 const std::function<std::uint32_t(const Node<3>&)>&);
template std::vector<RowPoint> in_insertion_order<2>(std::vector<RowPoint>, std::uint64_t);
template std::vector<RowPoint> in_insertion_order<3>(std::vector<RowPoint>, std::uint64_t);
template TiledTriangulation extract_simplices<2>(const RemoteNodes<2>&);
template TiledTriangulation extract_simplices<3>(const RemoteNodes<3>&);
template std::uint64_t count_shared<2>(const RemoteNodes<2>&, const Areas&);
template std::uint64_t count_shared<3>(const RemoteNodes<3>&, const Areas&);

}  // namespace delray::delaunay
