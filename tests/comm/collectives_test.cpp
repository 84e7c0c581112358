// Collectives against their definitions, for many numbers of ranks, on every implementation.
#include "comm/collectives.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "tests/comm/machine.h"

namespace delray::comm::testing {
namespace {

class CollectivesTest : public ::testing::TestWithParam<Machine> {
 protected:
  void for_ranks(const Body& body) {
    for (int ranks = 1; ranks <= GetParam().most_ranks; ++ranks) {
      SCOPED_TRACE(std::to_string(ranks) + " ranks");
      GetParam().run(ranks, body);
    }
  }
};

Buffer text(const std::string& s) { return Buffer::of(std::span<const char>(s)); }
std::string text(const Buffer& buffer) {
  const std::span<const char> s = buffer.as<char>();
  return {s.begin(), s.end()};
}
// A different length for every rank; rank 2 has nothing.
std::string words_of(int rank, int round) {
  return rank == 2 ? ""
                   : std::string(rank + 1, static_cast<char>('a' + rank)) + std::to_string(round);
}

// Not commutative and not associative in the last bits: finds every change of order.
struct Mix {
  double operator()(double a, double b) const { return a + b * 1.0000001; }
};
// Associative, not commutative: composition of x -> scale x + shift modulo 2^64.
struct Affine {
  std::uint64_t scale = 1, shift = 0;
  bool operator==(const Affine&) const = default;
};
Affine then(const Affine& first, const Affine& second) {
  return {first.scale * second.scale, first.shift * second.scale + second.shift};
}
Affine affine_of(int rank, std::size_t i) { return {2u * rank + 3 + i, 5u * rank + i}; }

TEST_P(CollectivesTest, BarrierHoldsUntilAllHaveCome) {
  for_ranks([](Communicator& c) {
    // After the barrier a message that each rank sent before it has at least been sent: its
    // receiver needs to wait for nothing that anybody does later.
    for (int round = 0; round < 3; ++round) {
      const double before = c.seconds();
      if (c.rank() == round % c.size()) c.work(Work::rays, 100000);
      double latest = c.seconds();
      barrier(c);
      const double after = c.seconds();
      all_reduce(c, std::span(&latest, 1), [](double a, double b) { return std::max(a, b); });
      EXPECT_GE(after, before);
      // Clocks of ranks agree on the simulated machine and between threads, but for a start that
      // MPI processes make at different times.
      if (GetParam().name.rfind("mpi", 0) != 0) {
        EXPECT_GE(after, latest);
      }
    }
  });
}

TEST_P(CollectivesTest, BroadcastReachesAllFromEveryRoot) {
  for_ranks([](Communicator& c) {
    for (int root = 0; root < c.size(); ++root) {
      const std::string expected = words_of(root, 4);
      const Buffer got =
          broadcast(c, root, text(c.rank() == root ? expected : std::string("ignored")));
      EXPECT_EQ(text(got), expected);
    }
  });
}

TEST_P(CollectivesTest, GatherCollectsOnRootOnly) {
  for_ranks([](Communicator& c) {
    for (int root = 0; root < c.size(); ++root) {
      const std::vector<Buffer> all = gather(c, root, text(words_of(c.rank(), root)));
      if (c.rank() != root) {
        EXPECT_TRUE(all.empty());
        continue;
      }
      ASSERT_EQ(all.size(), static_cast<std::size_t>(c.size()));
      for (int rank = 0; rank < c.size(); ++rank) EXPECT_EQ(text(all[rank]), words_of(rank, root));
    }
  });
}

TEST_P(CollectivesTest, AllGatherCollectsEverywhere) {
  for_ranks([](Communicator& c) {
    for (int round = 0; round < 3; ++round) {
      const std::vector<Buffer> all = all_gather(c, text(words_of(c.rank(), round)));
      ASSERT_EQ(all.size(), static_cast<std::size_t>(c.size()));
      for (int rank = 0; rank < c.size(); ++rank) {
        EXPECT_EQ(text(all[rank]), words_of(rank, round));
      }
    }
  });
}

TEST_P(CollectivesTest, ReductionsKeepRankOrder) {
  for_ranks([](Communicator& c) {
    std::vector<Affine> expected(3);
    for (std::size_t i = 0; i < expected.size(); ++i) {
      for (int rank = 0; rank < c.size(); ++rank) {
        expected[i] = then(expected[i], affine_of(rank, i));
      }
    }
    std::vector<Affine> own;
    for (std::size_t i = 0; i < expected.size(); ++i) own.push_back(affine_of(c.rank(), i));
    for (int root = 0; root < c.size(); ++root) {
      std::vector<Affine> values = own;
      reduce(c, root, std::span(values), then);
      EXPECT_EQ(values, c.rank() == root ? expected : own);
    }
    std::vector<Affine> values = own;
    all_reduce(c, std::span(values), then);
    EXPECT_EQ(values, expected);
  });
}

TEST_P(CollectivesTest, ReductionsGoOnWhileRanksDoOtherThings) {
  for_ranks([](Communicator& c) {
    for (int round = 0; round < 6; ++round) {
      Affine expected, own = affine_of(c.rank(), static_cast<std::size_t>(round));
      for (int rank = 0; rank < c.size(); ++rank)
        expected = then(expected, affine_of(rank, static_cast<std::size_t>(round)));
      AllReduce reduction(c, Buffer::of_value(own), elementwise<Affine>(then));
      bool all = false;
      for (int asked = (c.rank() + round) % 4; asked > 0; --asked) {
        const bool now = reduction.advance();
        EXPECT_TRUE(now || !all);
        all = now;
      }
      EXPECT_EQ(reduction.finish().as<Affine>()[0], expected);
      // Another one may follow at once.
      EXPECT_EQ(all_reduce_value(c, 1, std::plus<>()), c.size());
    }
  });
}

TEST_P(CollectivesTest, FloatingPointSumsAreTheSameEverywhere) {
  // What the machine computed in its first run, for each number of ranks.
  static std::vector<double> first(64, 0);
  for_ranks([](Communicator& c) {
    std::mt19937_64 random(c.rank());
    const double own = std::ldexp(static_cast<double>(random() % 1000003), c.rank() % 7 * 5 - 20);
    const double all = all_reduce_value(c, own, Mix());
    double one = own;
    reduce(c, c.size() - 1, std::span(&one, 1), Mix());
    if (c.rank() == c.size() - 1) {
      EXPECT_EQ(one, all);
      if (first[c.size()] == 0) first[c.size()] = all;
      EXPECT_EQ(first[c.size()], all);
    }
    const Buffer everywhere = broadcast(c, 0, Buffer::of_value(all));
    EXPECT_EQ(everywhere.as<double>()[0], all);
  });
}

TEST_P(CollectivesTest, ExclusiveScanCombinesTheRanksBefore) {
  for_ranks([](Communicator& c) {
    std::vector<Affine> values, expected(3);
    for (std::size_t i = 0; i < expected.size(); ++i) {
      values.push_back(affine_of(c.rank(), i));
      for (int rank = 0; rank < c.rank(); ++rank) {
        expected[i] = then(expected[i], affine_of(rank, i));
      }
    }
    exclusive_scan(c, std::span(values), Affine(), then);
    EXPECT_EQ(values, expected);
  });
}

TEST_P(CollectivesTest, ReducesNothing) {
  for_ranks([](Communicator& c) {
    all_reduce(c, std::span<int>(), std::plus<>());
    reduce(c, 0, std::span<int>(), std::plus<>());
    exclusive_scan(c, std::span<int>(), 0, std::plus<>());
  });
}

// What rank `source` sends in a round of random exchanges: any number of parcels to anybody.
std::vector<int> receivers(int source, int round, int n) {
  std::mt19937_64 random(1000 * round + source);
  std::vector<int> to(random() % 4 == 0 ? 0 : random() % (2 * n + 1));
  for (int& rank : to) rank = static_cast<int>(random() % n);
  return to;
}

TEST_P(CollectivesTest, ExchangeDeliversEveryParcel) {
  for_ranks([](Communicator& c) {
    for (int round = 0; round < 3; ++round) {
      std::vector<Parcel> parcels;
      for (const int to : receivers(c.rank(), round, c.size())) {
        const std::string content = std::to_string(c.rank()) + "/" + std::to_string(round) + "/" +
                                    std::to_string(parcels.size());
        parcels.push_back({to, text(parcels.size() % 5 == 4 ? "" : content)});
      }
      std::vector<std::pair<int, std::string>> expected, got;
      for (int source = 0; source < c.size(); ++source) {
        std::size_t i = 0;
        for (const int to : receivers(source, round, c.size())) {
          const std::string content =
              std::to_string(source) + "/" + std::to_string(round) + "/" + std::to_string(i);
          if (to == c.rank()) expected.emplace_back(source, i % 5 == 4 ? "" : content);
          ++i;
        }
      }
      for (const Parcel& parcel : exchange(c, std::move(parcels))) {
        got.emplace_back(parcel.rank, text(parcel.message));
      }
      EXPECT_EQ(got, expected);
    }
  });
}

INSTANTIATE_TEST_SUITE_P(Machines, CollectivesTest, ::testing::ValuesIn(machines()),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace delray::comm::testing
