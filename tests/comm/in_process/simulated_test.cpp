// The simulated machine: costs of its model, determinism, deadlocks and failures.
#include "comm/simulated.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

#include "comm/collectives.h"

namespace delray::comm {
namespace {

Network simple() {
  Network network;
  network.latency = 1.0;
  network.overhead = 0.01;
  network.seconds_per_byte = 0.1;
  return network;
}

TEST(Simulated, AMessageCostsWhatTheModelSays) {
  const Network n = simple();
  const auto finished = run_simulated(2, n, 0, [](Communicator& c) {
    if (c.rank() == 0) {
      c.send(1, 1, Buffer(50));
    } else {
      c.receive(0, 1);
    }
  });
  EXPECT_DOUBLE_EQ(finished[0], n.overhead);
  EXPECT_DOUBLE_EQ(finished[1], n.overhead + 50 * n.seconds_per_byte + n.latency + n.overhead);
}

TEST(Simulated, LinksCarryOneMessageAtATime) {
  const Network n = simple();
  const auto fan_out = run_simulated(4, n, 0, [](Communicator& c) {
    if (c.rank() == 0) {
      for (int to = 1; to < 4; ++to) c.send(to, 1, Buffer(50));
    } else {
      c.receive(0, 1);
    }
  });
  // The sender's link is busy from its first overhead on.
  for (int k = 1; k < 4; ++k) {
    EXPECT_NEAR(fan_out[k], 0.01 + k * 5.0 + 1.0 + 0.01, 1e-12) << k;
  }
  EXPECT_NEAR(fan_out[0], 0.03, 1e-12);

  const auto fan_in = run_simulated(4, n, 0, [](Communicator& c) {
    if (c.rank() > 0) {
      c.send(0, 1, Buffer(50));
    } else {
      for (int i = 1; i < 4; ++i) c.receive(kAnyRank, 1);
    }
  });
  EXPECT_NEAR(fan_in[0], 0.01 + 1.0 + 3 * 5.0 + 0.01, 1e-12);
}

TEST(Simulated, ABusCarriesOneMessageAtATimeFirstComeFirstServed) {
  Network n = simple();
  n.topology.shape = Shape::bus;
  // Rank 2 - k sends after k seconds: what is simulated first is not what comes first.
  const auto finished = run_simulated(4, n, 0, [](Communicator& c) {
    if (c.rank() == 3) {
      for (int from = 0; from < 3; ++from) c.receive(from, 1);
      return;
    }
    c.work(Work::seconds_e9, static_cast<std::uint64_t>(2 - c.rank()) * 1'000'000'000);
    c.send(3, 1, Buffer(50));
    EXPECT_NEAR(c.seconds(), 2 - c.rank() + 0.01, 1e-12);
  });
  // Rank 2's message is on the bus from 0.01 to 5.01, rank 1's until 10.01, rank 0's until 15.01.
  EXPECT_NEAR(finished[3], 15.01 + 1.0 + 3 * 0.01, 1e-12);

  // Two pairs that do not meet anywhere but on the bus.
  const auto pairs = run_simulated(4, n, 0, [](Communicator& c) {
    if (c.rank() < 2) {
      c.send(c.rank() + 2, 1, Buffer(50));
    } else {
      c.receive(c.rank() - 2, 1);
    }
  });
  EXPECT_NEAR(std::max(pairs[2], pairs[3]), 0.01 + 10 + 1 + 0.01, 1e-12);
  EXPECT_NEAR(std::min(pairs[2], pairs[3]), 0.01 + 5 + 1 + 0.01, 1e-12);
}

TEST(Simulated, ABusCarriesAMulticastOnce) {
  for (const bool is_bus : {true, false}) {
    Network n = simple();
    n.topology.shape = is_bus ? Shape::bus : Shape::crossbar;
    double sent = 0;
    const auto finished = run_simulated(4, n, 0, [&](Communicator& c) {
      if (c.rank() == 1) {
        c.multicast(std::vector{3, 1, 0, 2}, 1, Buffer(50));
        sent = c.seconds();
      }
      EXPECT_EQ(c.receive(1, 1).size(), 50U);
    });
    if (is_bus) {
      EXPECT_NEAR(sent, 0.01, 1e-12);
      for (const int rank : {0, 2, 3}) EXPECT_NEAR(finished[rank], 0.01 + 5 + 1 + 0.01, 1e-12);
    } else {
      EXPECT_NEAR(sent, 0.03, 1e-12);
      EXPECT_NEAR(finished[3], 0.01 + 5 + 1 + 0.01, 1e-12);
      EXPECT_NEAR(finished[0], 0.01 + 10 + 1 + 0.01, 1e-12);
      EXPECT_NEAR(finished[2], 0.01 + 15 + 1 + 0.01, 1e-12);
    }
    EXPECT_NEAR(finished[1], sent, 1e-12);
  }
}

TEST(Simulated, RanksTakeTurnsOnSharedCores) {
  Network n;
  n.shared_cores = 2;
  const auto work = [](Communicator& c) { c.work(Work::seconds_e9, 1'000'000'000); };
  for (const int ranks : {1, 2, 3, 4, 7}) {
    const auto finished = run_simulated(ranks, n, 0, work);
    // In turns of some milliseconds: all are done at about the same time.
    EXPECT_NEAR(*std::max_element(finished.begin(), finished.end()), std::max(1.0, 0.5 * ranks),
                0.01);
  }
  // A rank that waits for a message takes no core.
  n.latency = 10;
  n.overhead = 0;
  n.seconds_per_byte = 0;
  const auto finished = run_simulated(4, n, 0, [&](Communicator& c) {
    if (c.rank() == 0) c.send(1, 1, Buffer(8));
    if (c.rank() == 1) c.receive(0, 1);
    work(c);
  });
  EXPECT_NEAR(finished[1], 11, 1e-9);
  EXPECT_NEAR(std::max({finished[0], finished[2], finished[3]}), 1.5, 0.01);
}

TEST(Simulated, CopyingTakesTheProcessorOnBothSides) {
  Network n = simple();
  n.copy_seconds_per_byte = 0.5;
  const auto finished = run_simulated(2, n, 0, [](Communicator& c) {
    if (c.rank() == 0) c.send(1, 1, Buffer(10));
    if (c.rank() == 1) c.receive(0, 1);
    c.send(c.rank(), 1, Buffer(1000));  // to itself: free
    c.receive(c.rank(), 1);
  });
  EXPECT_DOUBLE_EQ(finished[0], 0.01 + 5);
  EXPECT_DOUBLE_EQ(finished[1], 0.01 + 5 + 1 + 1 + 0.01 + 5);
}

TEST(Simulated, MessagesCostWhatTheyStandFor) {
  const Network n = simple();
  const auto finished = run_simulated(2, n, 0, [](Communicator& c) {
    if (c.rank() == 0) {
      c.send(1, 1, Buffer::standing_for(std::size_t{1} << 40, Buffer::of_value(7)));
      return;
    }
    EXPECT_EQ(c.probe(0, 1, Deadline::never())->bytes, std::size_t{1} << 40);
    const Buffer message = c.receive(0, 1);
    EXPECT_EQ(message.counted_bytes(), std::size_t{1} << 40);
    EXPECT_EQ(message.copy().counted_bytes(), std::size_t{1} << 40);
    EXPECT_EQ(message.as<int>()[0], 7);
  });
  EXPECT_NEAR(finished[1], 0x1p40 * 0.1 + 1.02, 1e-3);
}

TEST(Networks, AreFoundByNameAndCostSomething) {
  for (const NamedNetwork& network : networks()) {
    EXPECT_EQ(find_network(network.name), &network);
    EXPECT_GT(network.network.latency, 0);
    EXPECT_GT(network.network.seconds_per_byte, 0);
  }
  EXPECT_EQ(find_network("nonsense"), nullptr);
}

TEST(Simulated, WorkTakesTimeByKindAndSlowness) {
  Network n;
  n.seconds_per_work[static_cast<std::size_t>(Work::rays)] = 0.5;
  SimulationOptions options;
  options.slowness = {1, 10};
  const auto finished = run_simulated(
      3, n, 0,
      [](Communicator& c) {
        c.work(Work::rays, 4);
        c.work(Work::seconds_e9, 1'000'000'000);
      },
      options);
  EXPECT_DOUBLE_EQ(finished[0], 3);
  EXPECT_DOUBLE_EQ(finished[1], 30);
  EXPECT_DOUBLE_EQ(finished[2], 3);
}

TEST(Simulated, ASlowRankIsOvertaken) {
  // Ranks fetch tasks from rank 0, which hands out 100: a rank that is 10 times slower gets about a
  // tenth of what others get.
  Network n;
  n.seconds_per_work[static_cast<std::size_t>(Work::rays)] = 1e-3;
  SimulationOptions options;
  options.slowness = {1, 1, 10, 1};
  std::vector<int> done(4, 0);
  run_simulated(
      4, n, 3,
      [&](Communicator& c) {
        if (c.rank() == 0) {
          int left = 210;
          for (int working = 3; working > 0;) {
            const auto request = c.probe(kAnyRank, 1, Deadline::never());
            c.receive(request->source, 1);
            if (left == 0) --working;
            c.send(request->source, 2, Buffer::of_value(left > 0));
            left -= left > 0;
          }
          return;
        }
        for (;;) {
          c.send(0, 1, Buffer());
          if (!c.receive(0, 2).as<bool>()[0]) return;
          c.work(Work::rays, 1);
          ++done[c.rank()];
        }
      },
      options);
  EXPECT_EQ(done[1] + done[2] + done[3], 210);
  EXPECT_NEAR(done[1], 100, 2);
  EXPECT_NEAR(done[2], 10, 2);
}

TEST(Simulated, ProbeWaitsInVirtualTime) {
  run_simulated(2, simple(), 0, [](Communicator& c) {
    if (c.rank() == 1) {
      c.work(Work::seconds_e9, 100'000'000'000);  // 100 s
      c.send(0, 1, Buffer());
      return;
    }
    EXPECT_FALSE(c.probe(1, 1, Deadline::in(std::chrono::seconds(100))));
    EXPECT_DOUBLE_EQ(c.seconds(), 100);
    // On its way, but not here: it arrives at 101.01.
    EXPECT_FALSE(c.probe(kAnyRank, kAnyTag, Deadline::in(std::chrono::seconds(1))));
    EXPECT_DOUBLE_EQ(c.seconds(), 101);
    EXPECT_TRUE(c.probe(1, 1, Deadline::in(std::chrono::hours(1))));
    EXPECT_NEAR(c.seconds(), 101.01, 1e-9);
    c.receive(1, 1);
  });
}

TEST(Simulated, AnyRankTakesWhatArrivesFirstNotWhatIsSimulatedFirst) {
  run_simulated(3, simple(), 0, [](Communicator& c) {
    if (c.rank() == 1) {
      c.work(Work::seconds_e9, 5'000'000'000);
      c.send(0, 1, Buffer());
    } else if (c.rank() == 2) {
      // Many steps, but all of them earlier.
      for (int i = 0; i < 10; ++i) {
        c.send(2, 2, Buffer());
        c.receive(kAnyRank, 2);
        c.work(Work::seconds_e9, 100'000'000);
      }
      c.send(0, 1, Buffer());
    } else {
      EXPECT_EQ(c.probe(kAnyRank, 1, Deadline::never())->source, 2);
      c.receive(2, 1);
      c.receive(1, 1);
    }
  });
}

std::vector<int> order_of_arrival(std::uint64_t seed) {
  std::vector<int> order;
  run_simulated(4, any_order(), seed, [&](Communicator& c) {
    if (c.rank() > 0) {
      c.send(0, 1, Buffer());
      c.send(0, 1, Buffer());
      return;
    }
    for (int i = 0; i < 6; ++i) {
      order.push_back(c.probe(kAnyRank, 1, Deadline::never())->source);
      c.receive(order.back(), 1);
    }
  });
  return order;
}

TEST(Simulated, SeedsGiveEveryOrderAndEqualSeedsEqualRuns) {
  std::set<std::vector<int>> orders;
  std::uint64_t tried = 0;
  // 6! / 2^3 interleavings of three sources with two messages each.
  while (orders.size() < 90 && tried < 5000) orders.insert(order_of_arrival(tried++));
  EXPECT_EQ(orders.size(), 90u);
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    EXPECT_EQ(order_of_arrival(seed), order_of_arrival(seed)) << "seed " << seed;
  }
}

TEST(Simulated, RunsThousandsOfRanks) {
#if defined(DELRAY_ASAN) || defined(DELRAY_TSAN)
  const int ranks = 128, rounds = 7;
#else
  const int ranks = 4096, rounds = 12;
#endif
  const Network n = simple();
  const auto finished = run_simulated(ranks, n, 0, [](Communicator& c) { barrier(c); });
  for (const double seconds : finished) {
    ASSERT_NEAR(seconds, rounds * (n.latency + 2 * n.overhead), 1e-9);
  }
  run_simulated(ranks, n, 0, [](Communicator& c) {
    const auto half = c.split(c.rank() % 2, -c.rank());
    EXPECT_EQ(all_reduce_value(*half, 1, std::plus<>()), c.size() / 2);
  });
}

TEST(Simulated, NestsInItself) {
  run_simulated(2, simple(), 0, [](Communicator& outer) {
    barrier(outer);
    const auto finished =
        run_simulated(3, simple(), 1, [](Communicator& inner) { barrier(inner); });
    EXPECT_EQ(finished.size(), 3u);
    barrier(outer);
  });
}

}  // namespace
}  // namespace delray::comm
