#include "delaunay/distributed/remote_nodes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <vector>

#include "comm/collectives.h"
#include "comm/simulated.h"

namespace delray::delaunay {
namespace {

// Two nodes at home on each rank, made by it.
NodeId node_id(int rank, std::uint64_t number) {
  const auto home = static_cast<std::uint32_t>(rank);
  return {home, home, number};
}

struct Rank {
  comm::Communicator& communicator;
  RemoteNodes<2>& nodes;
  DistributedStatistics& statistics;

  // Lets all ranks serve each other until nobody has anything to do.
  void settle() {
    while (nodes.wait_for_work()) continue;
    comm::barrier(communicator);
  }
};

void on_ranks(int ranks, const std::function<void(Rank&)>& body) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    comm::run_simulated(ranks, comm::any_order(), seed, [&](comm::Communicator& communicator) {
      DistributedStatistics statistics;
      RemoteNodes<2> nodes(communicator, statistics);
      for (const std::uint64_t number : {0, 1}) {
        Node<2> node;
        node.id = node_id(communicator.rank(), number);
        nodes.put(node);
      }
      Rank rank{communicator, nodes, statistics};
      body(rank);
    });
  }
}

TEST(RemoteNodes, AsksForAllAtOnceAndWaitsOnce) {
  on_ranks(3, [](Rank& rank) {
    if (rank.communicator.rank() == 0) {
      std::vector<NodeId> all;
      for (int home = 0; home < 3; ++home) {
        for (const std::uint64_t number : {0, 1}) all.push_back(node_id(home, number));
      }
      rank.nodes.begin({1, 0});
      EXPECT_TRUE(rank.nodes.lock(all));
      for (const NodeId& id : all) EXPECT_EQ(rank.nodes.held(id).id, id);
      EXPECT_EQ(rank.statistics.waits, 1U);
      EXPECT_EQ(rank.statistics.requests, 2U);  // a message for each of the other ranks
      EXPECT_TRUE(rank.nodes.lock(all));        // they are its own already
      EXPECT_EQ(rank.statistics.waits, 1U);
    }
    rank.settle();
    for (const std::uint64_t number : {0, 1}) {
      EXPECT_TRUE(rank.nodes.is_locked(node_id(rank.communicator.rank(), number)));
    }
    comm::barrier(rank.communicator);
    if (rank.communicator.rank() == 0) rank.nodes.rollback();
    rank.settle();
    for (const std::uint64_t number : {0, 1}) {
      EXPECT_FALSE(rank.nodes.is_locked(node_id(rank.communicator.rank(), number)));
    }
  });
}

// Wait-die: who is refused one of the nodes gives back those that it was granted.
TEST(RemoteNodes, OneRefusalRefusesAll) {
  on_ranks(3, [](Rank& rank) {
    const std::vector<NodeId> held = {node_id(2, 0)};
    const std::vector<NodeId> wanted = {node_id(2, 0), node_id(2, 1), node_id(1, 0), node_id(0, 1)};
    if (rank.communicator.rank() == 0) {
      rank.nodes.begin({1, 0});
      EXPECT_TRUE(rank.nodes.lock(held));
    }
    rank.settle();
    if (rank.communicator.rank() == 1) {
      rank.nodes.begin({2, 1});  // younger
      EXPECT_FALSE(rank.nodes.lock(wanted));
      EXPECT_EQ(rank.statistics.refusals, 1U);
      EXPECT_EQ(rank.statistics.waits, 1U);
      rank.nodes.rollback();
    }
    rank.settle();
    for (const std::uint64_t number : {0, 1}) {
      const NodeId id = node_id(rank.communicator.rank(), number);
      EXPECT_EQ(rank.nodes.is_locked(id), id == held[0]) << id.home << " " << id.number;
    }
    comm::barrier(rank.communicator);
    if (rank.communicator.rank() == 0) rank.nodes.rollback();
    rank.settle();
  });
}

// An older insertion waits for the younger one's nodes, and gets them when these are given back.
TEST(RemoteNodes, AnOlderInsertionWaits) {
  on_ranks(2, [](Rank& rank) {
    const std::vector<NodeId> both = {node_id(0, 0), node_id(1, 0)};
    if (rank.communicator.rank() == 1) {
      rank.nodes.begin({2, 1});
      EXPECT_TRUE(rank.nodes.lock({&both[1], 1}));
    }
    rank.settle();
    if (rank.communicator.rank() == 1) rank.nodes.rollback();
    if (rank.communicator.rank() == 0) {
      rank.nodes.begin({1, 0});
      EXPECT_TRUE(rank.nodes.lock(both));
      rank.nodes.rollback();
    }
    rank.settle();
  });
}

}  // namespace
}  // namespace delray::delaunay
