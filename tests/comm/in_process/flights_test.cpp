#include "comm/in_process/flights.h"

#include <gtest/gtest.h>

#include "comm/simulated.h"

namespace delray::comm {
namespace {

// A byte takes 0.1 s on each link, a link after the first 0.5 s more, every message 1 s.
Network routed(Shape shape) {
  Network n;
  n.latency = 1;
  n.overhead = 0;
  n.seconds_per_byte = 0.1;
  n.hop_seconds = 0.5;
  n.topology.shape = shape;
  return n;
}

TEST(Flights, AMessageTakesItsBytesOnceAndEachHop) {
  // 4 links: 3 hops after the first, 50 bytes of 0.1 s, 1 s.
  const auto finished = run_simulated(8, routed(Shape::ring), 0, [](Communicator& c) {
    if (c.rank() == 0) c.send(4, 1, Buffer(50));
    if (c.rank() == 4) c.receive(0, 1);
  });
  EXPECT_NEAR(finished[4], 3 * 0.5 + 5 + 1, 1e-12);
  EXPECT_EQ(finished[0], 0);
}

TEST(Flights, ALinkCarriesOneMessageAtATimeAndOthersPass) {
  // In the ring of 8: 0 -> 2 and 1 -> 2 share the link from 1 to 2; 2 -> 1 has one of its own.
  const auto finished = run_simulated(8, routed(Shape::ring), 0, [](Communicator& c) {
    if (c.rank() == 0) c.send(2, 1, Buffer(50));
    if (c.rank() == 1) {
      c.send(2, 1, Buffer(10));
      c.receive(2, 1);
    }
    if (c.rank() == 2) {
      c.send(1, 1, Buffer(30));
      c.receive(0, 1);
    }
    if (c.rank() == 3) c.receive(kAnyRank, 1);
    if (c.rank() == 4) c.send(3, 1, Buffer(0));
  });
  // The message of rank 1 has the link first, until 1.0; the other comes to it at 0.5 and waits.
  EXPECT_NEAR(finished[2], 1.0 + 5 + 1, 1e-12);
  EXPECT_NEAR(finished[1], 3 + 1, 1e-12);
  EXPECT_NEAR(finished[3], 1, 1e-12);
}

// A message that starts first but comes to a link later does not hold it before.
TEST(Flights, LinksServeInTheOrderInWhichMessagesCome) {
  Network n = routed(Shape::ring);
  n.hop_seconds = 10;
  const auto finished = run_simulated(16, n, 0, [](Communicator& c) {
    if (c.rank() == 0) c.send(2, 1, Buffer(50));  // comes to the second link at 10
    if (c.rank() == 1) {
      c.work(Work::seconds_e9, 6'000'000'000);
      c.send(2, 1, Buffer(30));  // has it from 6 to 9
    }
    if (c.rank() == 2) {
      c.receive(1, 1);
      EXPECT_NEAR(c.seconds(), 9 + 1, 1e-12);
      c.receive(0, 1);
    }
  });
  EXPECT_NEAR(finished[2], 10 + 5 + 1, 1e-12);
}

TEST(Flights, AllToAllOverEveryTopologyArrivesInOrder) {
  for (const TopologyKind& kind : topologies()) {
    Network n = routed(kind.shape);
    n.jitter = 0.3;
    for (const int ranks : {1, 2, 5, 9}) {
      run_simulated(ranks, n, 7, [&](Communicator& c) {
        for (int i = 0; i < 3; ++i)
          for (int to = 0; to < ranks; ++to) c.send(to, 1, Buffer::of_value(i));
        std::vector<int> next(static_cast<std::size_t>(ranks));
        for (int i = 0; i < 3 * ranks; ++i) {
          const auto envelope = c.probe(kAnyRank, kAnyTag, Deadline::never());
          const Buffer message = c.receive(envelope->source, envelope->tag);
          EXPECT_EQ(message.as<int>()[0], next[static_cast<std::size_t>(envelope->source)]++);
        }
      });
    }
  }
}

TEST(Flights, ABusOfTwoChannelsCarriesTwoMessages) {
  Network n = routed(Shape::bus);
  n.topology.channels = 2;
  const auto finished = run_simulated(4, n, 0, [](Communicator& c) {
    if (c.rank() == 3) {
      for (int from = 0; from < 3; ++from) c.receive(from, 1);
    } else {
      c.send(3, 1, Buffer(50));
    }
  });
  EXPECT_NEAR(finished[3], 10 + 1, 1e-12);
}

}  // namespace
}  // namespace delray::comm
