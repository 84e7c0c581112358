// Routes from the numbers of two places alone (Dally and Towles 2004): dimension order in rings,
// grids and tori, e-cube in hypercubes, up and down in trees (fat trees: Leiserson 1985).
//
// Links have numbers from 0: of a grid 2 for each place and dimension, of a hypercube one for each
// place and bit, of a tree those of a level behind those of the level below. O(length of the route)
// for a route, O(levels) memory. Degenerate: of one rank a network has no link that is used.
#include "comm/topology.h"

#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <stdexcept>
#include <string>

namespace delray::comm {
namespace {

constexpr std::array kTopologies = {
    TopologyKind{Shape::crossbar, "crossbar",
                 "Any number of messages between ranks, each of which sends and receives one at a "
                 "time",
                 false, false, false, false},
    TopologyKind{Shape::bus, "bus",
                 "One link (or `channels` of them) that all share; a multicast takes it once",
                 false, false, false, true},
    TopologyKind{Shape::ring, "ring", "Each rank joined to the next and the one before", true,
                 false, false, false},
    TopologyKind{Shape::grid, "grid", "Ranks in rows and columns (`sides`), neighbours joined",
                 true, true, false, false},
    TopologyKind{Shape::torus, "torus", "A grid whose rows and columns are closed to rings", true,
                 true, false, false},
    TopologyKind{Shape::hypercube, "hypercube", "Ranks joined whose numbers differ in one bit",
                 true, false, false, false},
    TopologyKind{Shape::tree, "tree",
                 "Ranks below switches of `arity` children, one link between any two levels", true,
                 false, true, false},
    TopologyKind{Shape::fat_tree, "fat-tree",
                 "A tree that has `arity` times as many links with each level up", true, false,
                 true, false},
};

constexpr std::size_t kMostLinks = std::size_t{1} << 28;  // each takes 8 bytes when simulated

[[noreturn]] void refuse(const std::string& what) { throw std::invalid_argument(what); }

int root_above(int ranks) {
  int root = static_cast<int>(std::sqrt(static_cast<double>(ranks)));
  while (root * root < ranks) ++root;
  return root;
}

}  // namespace

std::span<const TopologyKind> topologies() { return kTopologies; }

const TopologyKind& kind_of(Shape shape) { return kTopologies[static_cast<std::size_t>(shape)]; }

Routes::Routes(const Topology& topology, int ranks)
    : shape_(topology.shape), sides_(topology.sides), arity_(topology.arity) {
  const std::string name = kind_of(shape_).name;
  if (shape_ == Shape::ring) sides_ = {ranks};
  if (sides_.empty()) {
    const int columns = root_above(ranks);
    sides_ = {columns, (ranks + columns - 1) / columns};
  }
  switch (shape_) {
    case Shape::crossbar:
    case Shape::bus:
      refuse("a " + name + " has no routes");
    case Shape::ring:
    case Shape::grid:
    case Shape::torus:
      places_ = 1;
      for (const int side : sides_) {
        if (side < 1) refuse("a side of a " + name + " is at least 1");
        places_ *= static_cast<std::size_t>(side);
        if (places_ * sides_.size() * 2 > kMostLinks) refuse("the " + name + " is too large");
      }
      links_ = places_ * sides_.size() * 2;
      break;
    case Shape::hypercube:
      while ((1LL << levels_) < ranks) ++levels_;
      places_ = std::size_t{1} << levels_;
      links_ = places_ * static_cast<std::size_t>(levels_);
      break;
    case Shape::tree:
    case Shape::fat_tree:
      if (arity_ < 2) refuse("a switch of a " + name + " has at least 2 children");
      places_ = static_cast<std::size_t>(ranks);
      // Level l has an edge for each subtree of arity^l leaves.
      for (std::size_t below = 1; below < places_; below *= static_cast<std::size_t>(arity_)) {
        first_link_.push_back(links_);
        width_.push_back(shape_ == Shape::tree ? 1 : below);
        links_ += 2 * ((places_ + below - 1) / below) * width_.back();
      }
      levels_ = static_cast<int>(width_.size());
      break;
  }
  if (places_ < static_cast<std::size_t>(ranks)) {
    std::string sides;
    for (const int side : sides_) sides += (sides.empty() ? "" : " x ") + std::to_string(side);
    refuse("a " + name + " of " + sides + " has no place for " + std::to_string(ranks) + " ranks");
  }
  if (links_ > kMostLinks) refuse("the " + name + " is too large");
}

void Routes::find(int from, int to, std::vector<std::uint32_t>& route) const {
  route.clear();
  switch (shape_) {
    case Shape::crossbar:
    case Shape::bus:
      return;
    case Shape::ring:
    case Shape::torus:
      return find_in_grid(from, to, true, route);
    case Shape::grid:
      return find_in_grid(from, to, false, route);
    case Shape::hypercube:
      for (int bit = 0; bit < levels_; ++bit) {
        if (((from ^ to) >> bit & 1) == 0) continue;
        route.push_back(static_cast<std::uint32_t>(from * levels_ + bit));
        from ^= 1 << bit;
      }
      return;
    case Shape::tree:
    case Shape::fat_tree:
      return find_in_tree(from, to, route);
  }
}

void Routes::find_in_grid(int from, int to, bool wraps, std::vector<std::uint32_t>& route) const {
  const std::size_t dimensions = sides_.size();
  int stride = 1;
  for (std::size_t k = 0; k < dimensions; ++k) {
    const int side = sides_[k];
    int at = from / stride % side;
    const int end = to / stride % side;
    const int up = (end - at + side) % side;
    const bool ascends = wraps ? up <= side - up : end > at;
    while (at != end) {
      route.push_back(static_cast<std::uint32_t>(
          (static_cast<std::size_t>(from) * dimensions + k) * 2 + (ascends ? 0 : 1)));
      const int next = ascends ? (at + 1) % side : (at + side - 1) % side;
      from += (next - at) * stride;
      at = next;
    }
    stride *= side;
  }
}

void Routes::find_in_tree(int from, int to, std::vector<std::uint32_t>& route) const {
  const auto link = [&](std::size_t level, int child, bool down) {
    const std::size_t width = width_[level];
    return static_cast<std::uint32_t>(
        first_link_[level] +
        (static_cast<std::size_t>(child) * width + static_cast<std::size_t>(to) % width) * 2 +
        (down ? 1 : 0));
  };
  std::size_t level = 0;
  int above_from = from, above_to = to;
  for (; above_from != above_to; above_from /= arity_, above_to /= arity_)
    route.push_back(link(level++, above_from, false));
  std::size_t below = 1;
  for (std::size_t i = 1; i < level; ++i) below *= static_cast<std::size_t>(arity_);
  for (; level > 0; below /= static_cast<std::size_t>(arity_))
    route.push_back(link(--level, to / static_cast<int>(below), true));
}

}  // namespace delray::comm
