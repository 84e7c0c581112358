// Ledgers and tallies of what goes through a communicator.
#include "comm/recording.h"

#include <gtest/gtest.h>

#include <array>
#include <mutex>
#include <vector>

#include "comm/collectives.h"
#include "comm/replay.h"
#include "comm/simulated.h"
#include "comm/threads.h"

namespace delray::comm {
namespace {

using Body = std::function<void(Communicator&)>;

// The ledger that rank 0 gathers of a run of `body`.
Ledger record(bool simulated, int ranks, const Body& body) {
  Ledger ledger;
  const auto recorded = [&](Communicator& c) {
    std::vector<Event> events;
    {
      Recording recording(c, events);
      body(recording);
    }
    Ledger all = gather_ledger(c, events);
    if (c.rank() == 0) ledger = std::move(all);
  };
  if (simulated) {
    run_simulated(ranks, Network(), 1, recorded);
  } else {
    run_threads(ranks, 1, recorded);
  }
  return ledger;
}

class RecordingTest : public ::testing::TestWithParam<bool> {};

TEST_P(RecordingTest, WritesMessagesInProgramOrder) {
  const Ledger ledger = record(GetParam(), 3, [](Communicator& c) {
    c.mark(Phase::compose, 0);
    if (c.rank() == 0) {
      c.send(1, 7, Buffer(100));
      c.mark(Phase::compose, 1);
      c.send(2, 8, Buffer(10));
      c.send(0, 9, Buffer(1000));  // to itself: in the events, not in the totals
      c.receive(0, 9);
    } else {
      c.receive(kAnyRank, kAnyTag);
      c.work(Work::pixels_composited, 25);
    }
    c.mark(Phase::gather, 0);
    if (c.rank() == 2) c.send(0, 3, Buffer(5));
    if (c.rank() == 0) c.receive(2, 3);
  });
  ASSERT_EQ(ledger.ranks.size(), 3u);
  const std::vector<Event>& zero = ledger.ranks[0];
  ASSERT_EQ(zero.size(), 8u);
  EXPECT_EQ(zero[1].kind, Event::Kind::send);
  EXPECT_EQ(zero[1].peer, 1);
  EXPECT_EQ(zero[1].tag, 7);
  EXPECT_EQ(zero[1].amount, 100u);
  EXPECT_EQ(zero[1].phase, Phase::compose);
  EXPECT_EQ(zero[1].round, 0);
  EXPECT_EQ(zero[3].round, 1);
  EXPECT_EQ(zero[7].kind, Event::Kind::receive);
  EXPECT_EQ(zero[7].peer, 2);
  EXPECT_EQ(zero[7].phase, Phase::gather);
  const Event& received = ledger.ranks[1][1];
  EXPECT_EQ(received.peer, 0);
  EXPECT_EQ(received.tag, 7);
  EXPECT_EQ(received.amount, 100u);
  for (const auto& events : ledger.ranks) {
    double last = 0;
    for (const Event& event : events) {
      EXPECT_LE(last, event.begin);
      EXPECT_LE(event.begin, event.end);
      last = event.end;
    }
  }

  const Totals own = totals(zero, 0);
  EXPECT_EQ(own.bytes_sent, 110u);
  EXPECT_EQ(own.messages_sent, 2u);
  EXPECT_EQ(own.bytes_received, 5u);
  EXPECT_EQ(own.messages_received, 1u);
  EXPECT_EQ(own.rounds, 3u);
  const Totals all = totals(ledger);
  EXPECT_EQ(all.bytes_sent, 115u);
  EXPECT_EQ(all.bytes_received, 115u);
  EXPECT_EQ(all.messages_sent, 3u);
  EXPECT_EQ(all.work[static_cast<std::size_t>(Work::pixels_composited)], 50u);
  const Totals composed = totals(ledger, Phase::compose);
  EXPECT_EQ(composed.bytes_sent, 110u);
  EXPECT_EQ(composed.rounds, 2u);
  EXPECT_EQ(totals(ledger, Phase::gather).bytes_sent, 5u);
  EXPECT_EQ(totals(ledger, Phase::trace).messages_sent, 0u);
}

TEST_P(RecordingTest, ATallyAddsUpLikeTheEvents) {
  const auto body = [](Communicator& c) {
    const int n = c.size(), next = (c.rank() + 1) % n, last = (c.rank() + n - 1) % n;
    for (int round = 0; round < 5; ++round) {
      c.mark(round % 2 == 0 ? Phase::compose : Phase::gather, round / 3);
      c.send(next, 1, Buffer(static_cast<std::size_t>(10 * round + c.rank())));
      c.receive(last, 1);
      c.work(Work::pixels_composited, 3);
    }
  };
  const Ledger ledger = record(GetParam(), 3, body);
  for (int rank = 0; rank < 3; ++rank) {
    Tally tally(rank);
    for (const Event& event : ledger.ranks[static_cast<std::size_t>(rank)]) tally.add(event);
    for (const Phase phase : {Phase::compose, Phase::gather, Phase::trace}) {
      const Totals sum = totals(ledger.ranks[static_cast<std::size_t>(rank)], rank, phase);
      const Totals& tallied = tally.totals(phase);
      EXPECT_EQ(tallied.bytes_sent, sum.bytes_sent);
      EXPECT_EQ(tallied.bytes_received, sum.bytes_received);
      EXPECT_EQ(tallied.messages_sent, sum.messages_sent);
      EXPECT_EQ(tallied.messages_received, sum.messages_received);
      EXPECT_EQ(tallied.rounds, sum.rounds);
      EXPECT_EQ(tallied.work, sum.work);
    }
    EXPECT_EQ(tally.totals(Phase::compose).rounds, 2U);
  }
  run_threads(3, 1, [&](Communicator& c) {
    Tally tally(c.rank());
    Recording recording(c, tally);
    body(recording);
    EXPECT_EQ(tally.totals(Phase::compose).messages_sent, 3U);
  });
}

TEST_P(RecordingTest, CountsAMulticastAsAMessageToEach) {
  const Ledger ledger = record(GetParam(), 4, [](Communicator& c) {
    c.mark(Phase::compose, 2);
    if (c.rank() == 2) {
      c.send(3, 4, Buffer(1));
      c.multicast(std::vector{3, 0, 1}, 4, Buffer(100));
      c.multicast(std::vector{0}, 4, Buffer(10));
      c.multicast({}, 4, Buffer(1000));
    } else {
      if (c.rank() == 3) c.receive(2, 4);
      EXPECT_EQ(c.receive(2, 4).size(), 100U);
      if (c.rank() == 0) {
        EXPECT_EQ(c.receive(2, 4).size(), 10U);
      }
    }
  });
  const std::vector<Event>& events = ledger.ranks[2];
  ASSERT_EQ(events.size(), 6U);
  const std::array peers = {3, 3, 0, 1, 0};
  const std::array<std::uint64_t, 5> bytes = {1, 100, 100, 100, 10};
  for (std::size_t i = 0; i < peers.size(); ++i) {
    EXPECT_EQ(events[i + 1].kind, Event::Kind::send);
    EXPECT_EQ(events[i + 1].peer, peers[i]);
    EXPECT_EQ(events[i + 1].amount, bytes[i]);
    EXPECT_EQ(events[i + 1].round, 2);
    EXPECT_EQ(events[i + 1].is_repeated, i == 2 || i == 3);
  }
  EXPECT_EQ(totals(ledger).bytes_sent, 311U);
  EXPECT_EQ(totals(ledger).bytes_received, 311U);
  EXPECT_EQ(totals(ledger).messages_sent, 5U);
  // Once over the bus, the message of 100 bytes.
  Network bus;
  bus.latency = bus.overhead = 0;
  bus.seconds_per_byte = 1;
  bus.topology.shape = Shape::bus;
  const std::vector<double> finished = replay(ledger, bus);
  EXPECT_DOUBLE_EQ(finished[0], 111);
  EXPECT_DOUBLE_EQ(finished[1], 101);
  EXPECT_DOUBLE_EQ(finished[3], 101);
}

TEST_P(RecordingTest, TranslatesPeersOfSplitCommunicators) {
  const Ledger ledger = record(GetParam(), 6, [](Communicator& c) {
    const auto odd_even = c.split(c.rank() % 2, -c.rank());
    c.mark(Phase::shade, 4);
    const auto pair = odd_even->split(odd_even->rank() == 0 ? 0 : 1, 0);
    if (pair->size() == 2) {
      const int other = 1 - pair->rank();
      pair->send(other, 1, Buffer(3));
      pair->receive(other, 1);
    }
  });
  // {0, 2, 4} by descending number: 4 alone, 2 with 0; likewise 5, 3 with 1.
  const auto peer_of = [&](int rank) {
    for (const Event& event : ledger.ranks[rank]) {
      if (event.kind == Event::Kind::send) {
        EXPECT_EQ(event.phase, Phase::shade);
        EXPECT_EQ(event.round, 4);
        return event.peer;
      }
    }
    return -1;
  };
  EXPECT_EQ(peer_of(0), 2);
  EXPECT_EQ(peer_of(2), 0);
  EXPECT_EQ(peer_of(1), 3);
  EXPECT_EQ(peer_of(3), 1);
  EXPECT_EQ(peer_of(4), -1);
  EXPECT_EQ(totals(ledger).messages_sent, 4u);
}

TEST_P(RecordingTest, CountsCollectivesExactly) {
  for (int n = 1; n <= 9; ++n) {
    int log = 0;
    while ((1 << log) < n) ++log;
    const auto messages = [&](const Body& body) {
      return totals(record(GetParam(), n, body)).messages_sent;
    };
    const std::uint64_t ranks = n, rounds = log;
    EXPECT_EQ(messages([](Communicator& c) { barrier(c); }), ranks * rounds) << n;
    EXPECT_EQ(messages([](Communicator& c) { broadcast(c, 0, Buffer(8)); }), ranks - 1) << n;
    EXPECT_EQ(messages([](Communicator& c) { gather(c, 0, Buffer(8)); }), ranks - 1) << n;
    EXPECT_EQ(messages([](Communicator& c) { all_gather(c, Buffer(8)); }), ranks * rounds) << n;
    EXPECT_EQ(messages([](Communicator& c) {
                int value = 1;
                reduce(c, 0, std::span(&value, 1), std::plus<>());
              }),
              ranks - 1)
        << n;
    // Nobody has anything to exchange: only headers travel.
    EXPECT_EQ(messages([](Communicator& c) { exchange(c, {}); }), ranks * rounds) << n;
  }
}

INSTANTIATE_TEST_SUITE_P(Machines, RecordingTest, ::testing::Bool(), [](const auto& test) {
  return std::string(test.param ? "simulated" : "threads");
});

}  // namespace
}  // namespace delray::comm
