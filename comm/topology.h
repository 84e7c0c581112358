// Networks as links between places: which links a message takes from one rank to another.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace delray::comm {

// Which places are joined, and how many messages go between them at a time: docs/networks.md.
enum class Shape : std::uint8_t { crossbar, bus, ring, grid, torus, hypercube, tree, fat_tree };

// How places are joined. Rank k is at place k; places without a rank pass messages on.
struct Topology {
  Shape shape = Shape::crossbar;
  std::vector<int> sides;  // of grid and torus, x first; empty: nearly square, of two dimensions
  int arity = 2;           // of tree and fat tree: children of a switch
  int channels = 1;        // of a bus: the number of messages that it carries at a time
};

// A row of the table of topologies.
struct TopologyKind {
  Shape shape;
  const char* name;
  const char* description;
  bool has_routes;  // else it is no graph of links, but one of the two that LogGP knows
  bool has_sides, has_arity, has_channels;
};
std::span<const TopologyKind> topologies();
const TopologyKind& kind_of(Shape shape);

// The links of a network and the routes over them, for shapes with routes. Each joins two places in
// one direction. Nothing is stored for a pair of ranks: a route costs its length.
//
// Routes, which never change: a ring the shorter way, up where both are equal; grid and torus along
// the first dimension, then the second (torus: the shorter way in each, up where both are equal); a
// hypercube by the lowest bit first (e-cube); trees up to the lowest common switch and down. Ranks
// are the leaves of a tree. An edge of a fat tree at level l above the leaves has arity^l links in
// each direction, so that each level carries as much as all leaves send; a message takes the one
// with the number of its destination, modulo their number, on its way up and down (Zahavi 2012).
class Routes {
 public:
  // Throws std::invalid_argument where the topology has no place for so many ranks, or a side,
  // arity or number of links that is none. REQUIRES: kind_of(topology.shape).has_routes; ranks
  // >= 1.
  Routes(const Topology& topology, int ranks);

  std::size_t places() const { return places_; }  // without the switches of trees
  std::size_t links() const { return links_; }
  // Replaces `route` by the links from one rank to another, in order; none from a rank to itself.
  void find(int from, int to, std::vector<std::uint32_t>& route) const;

 private:
  void find_in_grid(int from, int to, bool wraps, std::vector<std::uint32_t>& route) const;
  void find_in_tree(int from, int to, std::vector<std::uint32_t>& route) const;

  Shape shape_;
  std::vector<int> sides_;
  int arity_;
  int levels_ = 0;                               // of a tree; dimensions of a hypercube
  std::vector<std::size_t> first_link_, width_;  // of a tree's level
  std::size_t places_ = 0, links_ = 0;
};

}  // namespace delray::comm
