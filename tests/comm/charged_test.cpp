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

// Where code only counts, what it tells is charged, and nothing else.
TEST(Charged, BelievesWhatIsToldInPhasesThatCountOnly) {
  constexpr Phase kTold[] = {Phase::compose};
  const std::vector<double> ends = run_simulated(2, free_network(), 1, [&](Communicator& inner) {
    Charged communicator(inner, kTold);
    communicator.work(Work::seconds_e9, 500'000'000);  // not told
    communicator.mark(Phase::compose, 0);
    spin(0.02);
    auto both = communicator.split(0, communicator.rank());  // of one clock with what it came from
    both->work(Work::seconds_e9, 1'000'000);
    spin(0.02);
    communicator.mark(Phase::other, 0);
    spin(0.003);
    communicator.mark(Phase::other, 1);
  });
  for (const double end : ends) {
    EXPECT_GE(end, 0.004);
    EXPECT_LT(end, 0.02);  // neither what was spun in between nor what was not told
  }
}

TEST(Charged, ChargesAllForWhatOneHasComputed) {
  int computed = 0;
  std::vector<std::shared_ptr<const void>> results(5);
  const std::vector<double> ends = run_simulated(5, free_network(), 1, [&](Communicator& inner) {
    Charged communicator(inner);
    const auto compute = [&]() -> Communicator::Replica {
      spin(0.004);
      return std::make_shared<int>(++computed);
    };
    results[communicator.rank()] = communicator.replicate(compute);
    auto half = communicator.split(communicator.rank() % 2, 0);  // counts for itself
    half->replicate(compute);
    communicator.replicate(compute);
  });
  EXPECT_EQ(computed, 4);
  for (int rank = 0; rank < 5; ++rank) {
    EXPECT_EQ(results[rank], results[0]);
    EXPECT_GE(ends[rank], 0.012);
  }
}

TEST(Replay, TellsWhereTheTimeOfEveryRankGoes) {
  Network network = free_network();
  network.latency = 0.5;
  network.overhead = 0.125;
  network.copy_seconds_per_byte = 0.25;
  network.seconds_per_byte = 1;
  Ledger ledger;
  ledger.ranks.resize(2);
  const auto event = [](Event::Kind kind, Phase phase, std::uint64_t amount, int peer) {
    Event one;
    one.kind = kind;
    one.phase = phase;
    one.amount = amount;
    one.peer = peer;
    one.tag = 1;
    return one;
  };
  ledger.ranks[0] = {event(Event::Kind::work, Phase::rasterize, 2'000'000'000, -1),
                     event(Event::Kind::send, Phase::gather, 4, 0),  // to itself, for nothing
                     event(Event::Kind::receive, Phase::gather, 4, 0),
                     event(Event::Kind::send, Phase::gather, 4, 1)};
  ledger.ranks[1] = {event(Event::Kind::work, Phase::transform, 1'000'000'000, -1),
                     event(Event::Kind::receive, Phase::gather, 4, 0)};
  const std::vector<ReplayedRank> ranks = replay_phases(ledger, network);
  EXPECT_EQ(ranks[0].in(Phase::rasterize).work, 2);
  EXPECT_EQ(ranks[0].in(Phase::gather).handling, 1.125);
  EXPECT_EQ(ranks[0].in(Phase::gather).waiting, 0);
  EXPECT_EQ(ranks[0].end, 3.125);
  EXPECT_EQ(ranks[1].in(Phase::transform).work, 1);
  EXPECT_EQ(ranks[1].in(Phase::gather).handling, 1.125);
  // From 1 on until the last byte is there, at 3.125 + 4 + 0.5.
  EXPECT_EQ(ranks[1].in(Phase::gather).waiting, 6.625);
  EXPECT_EQ(ranks[1].end, 8.75);
  EXPECT_EQ(replay(ledger, network), (std::vector<double>{3.125, 8.75}));
  network.shared_cores = 1;  // rank 0 is first or last to work
  for (const ReplayedRank& rank : replay_phases(ledger, network)) {
    double sum = 0;
    for (const PhaseSeconds& phase : rank.phases) sum += phase.all();
    EXPECT_EQ(sum, rank.end);
  }
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
