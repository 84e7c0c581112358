#include "comm/topology.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>

namespace delray::comm {
namespace {

std::vector<std::uint32_t> route(const Routes& routes, int from, int to) {
  std::vector<std::uint32_t> result = {1234};
  routes.find(from, to, result);
  return result;
}

// The number of links between two ranks, from what the shape means.
std::size_t distance(const Topology& topology, const Routes& routes, int ranks, int a, int b) {
  const auto around = [](int x, int y, int side) {
    return std::min((x - y + side) % side, (y - x + side) % side);
  };
  int columns = 1;
  while (columns * columns < ranks) ++columns;
  if (!topology.sides.empty()) columns = topology.sides[0];
  const int rows = static_cast<int>(routes.places()) / columns;
  switch (topology.shape) {
    case Shape::ring:
      return around(a, b, ranks);
    case Shape::grid:
      return std::abs(a % columns - b % columns) + std::abs(a / columns - b / columns);
    case Shape::torus:
      return around(a % columns, b % columns, columns) + around(a / columns, b / columns, rows);
    case Shape::hypercube:
      return static_cast<std::size_t>(__builtin_popcount(static_cast<unsigned>(a ^ b)));
    default: {
      std::size_t levels = 0;
      for (; a != b; a /= topology.arity, b /= topology.arity) ++levels;
      return 2 * levels;
    }
  }
}

TEST(Topology, TheTableHasEachShapeAtItsPlace) {
  std::set<std::string> names;
  for (const TopologyKind& kind : topologies()) {
    EXPECT_EQ(&kind_of(kind.shape), &kind);
    names.insert(kind.name);
  }
  EXPECT_EQ(names.size(), topologies().size());
}

TEST(Topology, RoutesAreShortestAndTheirLinksJoinAsAPath) {
  for (const TopologyKind& kind : topologies()) {
    if (!kind.has_routes) continue;
    for (const int ranks : {1, 2, 3, 7, 8, 12, 16, 27}) {
      Topology topology;
      topology.shape = kind.shape;
      if (kind.has_sides && ranks == 12) topology.sides = {3, 4};
      if (kind.has_arity && ranks == 27) topology.arity = 3;
      const Routes routes(topology, ranks);
      for (int from = 0; from < ranks; ++from) {
        for (int to = 0; to < ranks; ++to) {
          const std::vector<std::uint32_t> links = route(routes, from, to);
          EXPECT_EQ(links.size(), distance(topology, routes, ranks, from, to))
              << kind.name << ' ' << ranks << ": " << from << " to " << to;
          EXPECT_EQ(std::set(links.begin(), links.end()).size(), links.size());
          for (const std::uint32_t link : links) EXPECT_LT(link, routes.links());
        }
      }
    }
  }
}

// From the routes of neighbours follows where each link leads; all others must be such steps.
TEST(Topology, RoutesGoFromNeighbourToNeighbour) {
  for (const Shape shape : {Shape::ring, Shape::grid, Shape::torus, Shape::hypercube}) {
    Topology topology;
    topology.shape = shape;
    const int ranks = 16;
    const Routes routes(topology, ranks);
    std::map<std::uint32_t, std::pair<int, int>> ends;
    for (int from = 0; from < ranks; ++from) {
      for (int to = 0; to < ranks; ++to) {
        const auto links = route(routes, from, to);
        if (links.size() != 1) continue;
        EXPECT_TRUE(ends.try_emplace(links[0], from, to).second);
      }
    }
    for (int from = 0; from < ranks; ++from) {
      for (int to = 0; to < ranks; ++to) {
        int at = from;
        for (const std::uint32_t link : route(routes, from, to)) {
          ASSERT_TRUE(ends.contains(link));
          EXPECT_EQ(ends[link].first, at);
          at = ends[link].second;
        }
        EXPECT_EQ(at, to);
      }
    }
  }
}

TEST(Topology, OrderOfDimensionsAndTies) {
  Topology ring{Shape::ring, {}, 2, 1};
  const Routes four(ring, 4);
  EXPECT_EQ(route(four, 0, 2), (std::vector<std::uint32_t>{0, 2}));  // as far either way: up
  EXPECT_EQ(route(four, 0, 3), (std::vector<std::uint32_t>{1}));
  Topology grid{Shape::grid, {3, 2}, 2, 1};
  const Routes six(grid, 6);
  // Along the row to rank 2, then up the column: links of places 0, 1 (x, up) and 2 (y, up).
  EXPECT_EQ(route(six, 0, 5), (std::vector<std::uint32_t>{0, 4, 10}));
  const Routes cube({Shape::hypercube, {}, 2, 1}, 8);
  EXPECT_EQ(route(cube, 0, 6), (std::vector<std::uint32_t>{0 * 3 + 1, 2 * 3 + 2}));
}

TEST(Topology, AFatTreeHasALinkForEachLeafAtEachLevelAndATreeOne) {
  for (const int level : {1, 2, 3}) {
    const int ranks = 1 << level;
    EXPECT_EQ(Routes({Shape::fat_tree, {}, 2, 1}, ranks).links(),
              2U * static_cast<unsigned>(ranks * level));
    EXPECT_EQ(Routes({Shape::tree, {}, 2, 1}, ranks).links(), 2U * (2U * ranks - 2U));
  }
  // Ranks of one half that send to different ones of the other share no link.
  const Routes fat({Shape::fat_tree, {}, 2, 1}, 8);
  std::multiset<std::uint32_t> used;
  for (int from = 0; from < 4; ++from)
    for (const std::uint32_t link : route(fat, from, from + 4)) used.insert(link);
  for (const std::uint32_t link : used) EXPECT_EQ(used.count(link), 1U);
}

TEST(Topology, MemoryGrowsWithPlacesNotWithPairs) {
  const int many = 1 << 14;
  for (const TopologyKind& kind : topologies()) {
    if (!kind.has_routes) continue;
    EXPECT_LE(Routes({kind.shape, {}, 2, 1}, many).links(), 28U * many) << kind.name;
  }
}

TEST(Topology, WhatHasNoPlaceOrIsNoneIsRefused) {
  EXPECT_THROW(Routes({Shape::grid, {3, 2}, 2, 1}, 7), std::invalid_argument);
  EXPECT_THROW(Routes({Shape::torus, {3, 0}, 2, 1}, 1), std::invalid_argument);
  EXPECT_THROW(Routes({Shape::grid, {1 << 20, 1 << 20}, 2, 1}, 1), std::invalid_argument);
  EXPECT_THROW(Routes({Shape::tree, {}, 1, 1}, 4), std::invalid_argument);
  EXPECT_THROW(Routes({Shape::crossbar, {}, 2, 1}, 4), std::invalid_argument);
}

}  // namespace
}  // namespace delray::comm
