// Ranks that differ in a fact are all told which, at a logarithmic cost.
#include "comm/handshake.h"

#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "comm/ledger.h"
#include "comm/recording.h"
#include "comm/simulated.h"
#include "comm/threads.h"

namespace delray::comm {
namespace {

// What all of so many ranks are told, each of which has the facts that `facts_of(rank)` gives.
std::vector<std::string> told(int ranks, const std::function<std::vector<Fact>(int)>& facts_of) {
  std::vector<std::string> texts(static_cast<std::size_t>(ranks));
  try {
    run_simulated(ranks, Network(), 1, [&](Communicator& communicator) {
      std::string& text = texts[static_cast<std::size_t>(communicator.rank())];
      try {
        handshake(communicator, facts_of(communicator.rank()));
      } catch (const std::invalid_argument& error) {
        text = error.what();
      }
    });
  } catch (...) {
    ADD_FAILURE() << "nothing else is thrown";
  }
  return texts;
}

TEST(Handshake, RanksThatAgreeGoOn) {
  for (const int ranks : {1, 2, 3, 8}) {
    const auto texts = told(ranks, [](int) {
      return std::vector<Fact>{{"build", "1"}, {"--size", "640x480"}};
    });
    EXPECT_EQ(texts, std::vector<std::string>(static_cast<std::size_t>(ranks)));
  }
}

TEST(Handshake, AllAreToldWhichRankDiffersInWhat) {
  const auto texts = told(7, [](int rank) {
    return std::vector<Fact>{{"build", "1"},
                             {"--size", rank == 4 || rank == 5 ? "32x24" : "64x48"}};
  });
  for (const std::string& text : texts) {
    EXPECT_EQ(text, texts.front());
    EXPECT_TRUE(text.starts_with("ranks differ in --size: rank 0 (")) << text;
    EXPECT_NE(text.find("has 64x48, rank 4 ("), std::string::npos) << text;
    EXPECT_TRUE(text.ends_with("has 32x24; 1 more differ")) << text;
  }
}

TEST(Handshake, WhatOnlySomeHaveIsADifference) {
  for (const int odd_one : {0, 1}) {
    const auto texts = told(2, [&](int rank) {
      std::vector<Fact> facts = {{"build", "1"}};
      if (rank == odd_one) facts.push_back({"--seed", "3"});
      return facts;
    });
    EXPECT_NE(texts[1].find("ranks differ in --seed"), std::string::npos) << texts[1];
    EXPECT_NE(texts[1].find("has nothing"), std::string::npos) << texts[1];
  }
}

// Neither messages nor bytes of a rank grow with the ranks, but by their logarithm.
TEST(Handshake, CostsALogarithmicNumberOfMessages) {
  for (const bool differ : {false, true}) {
    for (const int ranks : {4, 64, 512}) {
      std::vector<Tally> tallies;
      for (int rank = 0; rank < ranks; ++rank) tallies.emplace_back(rank);
      run_simulated(ranks, Network(), 1, [&](Communicator& communicator) {
        const int rank = communicator.rank();
        Recording recording(communicator, tallies[static_cast<std::size_t>(rank)]);
        const std::vector<Fact> facts = {
            {"build", differ && rank > 0 ? std::string(1000, 'x') : std::string(1000, 'y')}};
        try {
          handshake(recording, facts);
          EXPECT_FALSE(differ);
        } catch (const std::invalid_argument&) {
          EXPECT_TRUE(differ);
        }
      });
      std::uint64_t log = 0;
      while ((1 << log) < ranks) ++log;
      for (const Tally& tally : tallies) {
        const Totals totals = tally.totals(Phase::other);
        EXPECT_LE(totals.messages_sent, (differ ? 7 : 1) * log);
        EXPECT_LE(totals.bytes_sent, differ ? 8000 * log : 32 * log);
      }
    }
  }
}

}  // namespace
}  // namespace delray::comm
