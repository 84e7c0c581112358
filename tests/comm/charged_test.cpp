// Real code in its own time on the simulated machine, and its recordings on other networks.
#include "comm/charged.h"

#include <gtest/gtest.h>
#include <time.h>

#include <algorithm>
#include <numeric>

#include "comm/collectives.h"
#include "comm/recording.h"
#include "comm/replay.h"
#include "comm/simulated.h"

namespace delray::comm {
namespace {

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void spin(double seconds) {
  const double end = processor_seconds() + seconds;
  while (processor_seconds() < end) {
  }
}

Network free_network() {
  Network network;
  network.latency = network.overhead = network.seconds_per_byte = 0;
  return network;
}

// Ranks that wait for each other while they spin: everyone's time is its own.
TEST(Charged, ChargesEveryRankWhatItTookItself) {
  const std::vector<double> spent = {0.004, 0, 0.008, 0.001};
  std::vector<double> at(4);
  const std::vector<double> ends = run_simulated(4, free_network(), 1, [&](Communicator& inner) {
    Charged communicator(inner);
    const int rank = communicator.rank();
    communicator.work(Work::rays, 1'000'000'000);  // is in the time that passed, none
    spin(spent[rank]);
    at[rank] = communicator.seconds();
    auto half = communicator.split(rank % 2, rank);
    spin(0.002);
    barrier(*half);
    barrier(communicator);
  });
  for (int rank = 0; rank < 4; ++rank) {
    EXPECT_GE(at[rank], spent[rank]);
    EXPECT_LT(at[rank], 0.1);      // of rays it would be at least 200 s
    EXPECT_GE(ends[rank], 0.010);  // the slowest of all
  }
  EXPECT_LT(at[1], at[2]);
}

TEST(Replay, GivesWhatTheRunTookOnItsOwnNetworkAndMoreOnASlowerOne) {
  constexpr int kRanks = 5;
  Network slow;
  slow.latency = 1e-3;
  Network fast;
  const auto run = [&](const Network& network, Ledger* ledger) {
    return run_simulated(kRanks, network, 1, [&](Communicator& inner) {
      std::vector<Event> events;
      Recording communicator(inner, events);
      communicator.mark(Phase::trace, 0);
      communicator.work(Work::seconds_e9, 1000U * static_cast<unsigned>(communicator.rank()));
      communicator.work(Work::fragments, 500);
      std::vector<std::uint64_t> values(1000, 1);
      all_reduce(communicator, std::span(values), std::plus<>());
      gather(communicator, 0, Buffer(100));
      if (ledger == nullptr) return;
      Ledger all = gather_ledger(inner, events);
      if (inner.rank() == 0) *ledger = std::move(all);
    });
  };
  Ledger ledger;
  run(fast, &ledger);
  for (const Network& network : {fast, slow}) {
    const std::vector<double> expected = run(network, nullptr);
    const std::vector<double> replayed = replay(ledger, network);
    ASSERT_EQ(replayed.size(), expected.size());
    for (int rank = 0; rank < kRanks; ++rank)
      EXPECT_NEAR(replayed[rank], expected[rank], 1e-12) << rank;
  }
}

TEST(Replay, TakesALedgerOfNobody) { EXPECT_TRUE(replay({}, {}).empty()); }

}  // namespace
}  // namespace delray::comm
