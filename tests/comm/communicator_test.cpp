// What every implementation of Communicator promises. The same file runs over threads, over the
// simulated machine with many seeds, and over MPI.
#include "comm/communicator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <random>
#include <vector>

#include "comm/collectives.h"
#include "tests/comm/machine.h"

namespace delray::comm::testing {
namespace {

constexpr Tag kData = 5, kOther = 6;

class CommunicatorTest : public ::testing::TestWithParam<Machine> {
 protected:
  // On every number of ranks that the machine has, to 5, and its largest.
  // `once`: as Machine::run_once.
  void for_ranks(int least, const Body& body, bool once = false) {
    int last = 0;
    for (const int ranks : {1, 2, 3, 4, 5, GetParam().most_ranks}) {
      if (ranks < least || ranks > GetParam().most_ranks || ranks <= last) continue;
      SCOPED_TRACE(std::to_string(ranks) + " ranks");
      (once ? GetParam().run_once : GetParam().run)(ranks, body);
      last = ranks;
    }
    if (last == 0) GTEST_SKIP() << "needs " << least << " ranks";
  }
  void with_ranks(int ranks, const Body& body) {
    if (ranks > GetParam().most_ranks) GTEST_SKIP() << "needs " << ranks << " ranks";
    GetParam().run(ranks, body);
  }
};

Buffer numbers(std::initializer_list<std::uint64_t> values) {
  return Buffer::of(std::span<const std::uint64_t>(values.begin(), values.size()));
}
std::uint64_t number(const Buffer& buffer, std::size_t i = 0) {
  return buffer.as<std::uint64_t>()[i];
}

Buffer pattern(std::size_t bytes, std::uint64_t seed) {
  Buffer buffer(bytes);
  for (std::size_t i = 0; i < bytes; ++i) {
    buffer.data()[i] = static_cast<std::byte>((i * 31 + (i >> 9) + seed * 7) & 0xff);
  }
  return buffer;
}
bool is_pattern(const Buffer& buffer, std::size_t bytes, std::uint64_t seed) {
  if (buffer.size() != bytes) return false;
  for (std::size_t i = 0; i < bytes; ++i) {
    if (buffer.data()[i] != static_cast<std::byte>((i * 31 + (i >> 9) + seed * 7) & 0xff)) {
      return false;
    }
  }
  return true;
}

TEST_P(CommunicatorTest, NumbersRanksFromZero) {
  for_ranks(1, [](Communicator& c) {
    ASSERT_GE(c.rank(), 0);
    ASSERT_LT(c.rank(), c.size());
    for (int rank = 0; rank < c.size(); ++rank) EXPECT_EQ(c.world_rank(rank), rank);
    EXPECT_EQ(all_reduce_value(c, std::uint64_t{1} << c.rank(), std::plus<>()),
              (std::uint64_t{1} << c.size()) - 1);
  });
}

TEST_P(CommunicatorTest, KeepsOrderPerSourceAndTag) {
  for_ranks(2, [](Communicator& c) {
    constexpr std::uint64_t kCount = 20;
    const int next = (c.rank() + 1) % c.size(), previous = (c.rank() + c.size() - 1) % c.size();
    for (std::uint64_t i = 0; i < kCount; ++i) {
      c.send(next, kData, numbers({i}));
      c.send(next, kOther, numbers({100 + i}));
    }
    for (std::uint64_t i = 0; i < kCount; ++i) {
      EXPECT_EQ(number(c.receive(previous, kOther)), 100 + i);
    }
    for (std::uint64_t i = 0; i < kCount; ++i) EXPECT_EQ(number(c.receive(previous, kData)), i);
  });
}

TEST_P(CommunicatorTest, KeepsOrderPerSourceUnderAnyTag) {
  for_ranks(2, [](Communicator& c) {
    constexpr std::uint64_t kCount = 20;
    const int next = (c.rank() + 1) % c.size(), previous = (c.rank() + c.size() - 1) % c.size();
    // Sizes differ, so that an implementation that treats large messages apart cannot mix them up.
    for (std::uint64_t i = 0; i < kCount; ++i) {
      Buffer buffer = pattern(i % 3 == 0 ? 5000 : 8, i);
      buffer.as<std::uint64_t>()[0] = i;
      c.send(next, static_cast<Tag>(i % 4), std::move(buffer));
    }
    for (std::uint64_t i = 0; i < kCount; ++i) {
      EXPECT_EQ(number(c.receive(previous, kAnyTag)), i);
    }
  });
}

TEST_P(CommunicatorTest, TakesFromAnySourceInOrderOfEach) {
  for_ranks(2, [](Communicator& c) {
    constexpr std::uint64_t kCount = 10;
    if (c.rank() > 0) {
      for (std::uint64_t i = 0; i < kCount; ++i) {
        c.send(0, static_cast<Tag>(i % 2), numbers({static_cast<std::uint64_t>(c.rank()), i}));
      }
      return;
    }
    std::vector<std::uint64_t> next(c.size(), 0);
    for (std::uint64_t i = 0; i < kCount * (c.size() - 1); ++i) {
      const Buffer message = c.receive(kAnyRank, kAnyTag);
      EXPECT_EQ(number(message, 1), next[number(message)]++);
    }
    EXPECT_FALSE(c.probe(kAnyRank, kAnyTag, Deadline::now()));
  });
}

TEST_P(CommunicatorTest, ProbeTellsWhatReceiveTakes) {
  for_ranks(2, [](Communicator& c) {
    constexpr int kCount = 5;
    if (c.rank() > 0) {
      for (int i = 0; i < kCount; ++i) {
        c.send(0, i, pattern(100 * c.rank() + 1000 * i, c.rank()));
      }
      return;
    }
    for (int i = 0; i < kCount * (c.size() - 1); ++i) {
      const auto envelope = c.probe(kAnyRank, kAnyTag, Deadline::never());
      ASSERT_TRUE(envelope);
      const auto again = c.probe(envelope->source, envelope->tag, Deadline::now());
      ASSERT_TRUE(again);
      EXPECT_EQ(again->bytes, envelope->bytes);
      EXPECT_EQ(envelope->bytes, 100u * envelope->source + 1000u * envelope->tag);
      const Buffer message = c.receive(envelope->source, envelope->tag);
      EXPECT_TRUE(is_pattern(message, envelope->bytes, envelope->source));
    }
  });
}

TEST_P(CommunicatorTest, ProbeGivesUpAtItsDeadline) {
  for_ranks(1, [](Communicator& c) {
    EXPECT_FALSE(c.probe(kAnyRank, kAnyTag, Deadline::now()));
    const double begin = c.seconds();
    EXPECT_FALSE(c.probe(kAnyRank, kData, Deadline::in(std::chrono::milliseconds(2))));
    EXPECT_GE(c.seconds() - begin, 0.002 * 0.999);
    EXPECT_FALSE(c.probe(0, kAnyTag, Deadline::in(std::chrono::microseconds(10))));
    barrier(c);
  });
}

TEST_P(CommunicatorTest, ProbeWakesForAMessage) {
  with_ranks(2, [](Communicator& c) {
    if (c.rank() == 0) {
      c.receive(1, kOther);
      c.send(1, kData, numbers({42}));
    } else {
      c.send(0, kOther, Buffer());
      EXPECT_TRUE(c.probe(kAnyRank, kData, Deadline::in(std::chrono::seconds(60))));
      EXPECT_EQ(number(c.receive(0, kData)), 42u);
    }
  });
}

TEST_P(CommunicatorTest, PollingEnds) {
  with_ranks(2, [](Communicator& c) {
    if (c.rank() == 0) {
      while (!c.probe(1, kData, Deadline::now())) c.work(Work::rays, 1);
      EXPECT_EQ(number(c.receive(1, kData)), 7u);
    } else {
      c.work(Work::rays, 1000);
      c.send(0, kData, numbers({7}));
    }
  });
}

TEST_P(CommunicatorTest, SendsEmptyMessages) {
  for_ranks(1, [](Communicator& c) {
    for (int to = 0; to < c.size(); ++to) c.send(to, kData, Buffer());
    for (int from = 0; from < c.size(); ++from) EXPECT_TRUE(c.receive(from, kData).empty());
  });
}

TEST_P(CommunicatorTest, SendsToItself) {
  for_ranks(1, [](Communicator& c) {
    c.send(c.rank(), kData, numbers({1}));
    c.send(c.rank(), kOther, numbers({2}));
    c.send(c.rank(), kData, numbers({3}));
    EXPECT_EQ(number(c.receive(c.rank(), kAnyTag)), 1u);
    EXPECT_EQ(number(c.receive(kAnyRank, kData)), 3u);
    EXPECT_EQ(number(c.receive(kAnyRank, kAnyTag)), 2u);
  });
}

TEST_P(CommunicatorTest, MulticastsToEachInOrderWithOtherMessages) {
  for_ranks(1, [](Communicator& c) {
    const std::uint64_t big = 100'000;
    std::vector<int> all;
    for (int rank = c.size(); rank-- > 0;) all.push_back(rank);
    c.send(0, kData, numbers({1}));
    c.multicast(all, kData, pattern(big, static_cast<std::uint64_t>(c.rank())));
    c.multicast({}, kData, numbers({3}));
    c.multicast(all, kData, numbers({4}));
    for (int from = 0; from < c.size(); ++from) {
      if (c.rank() == 0) {
        EXPECT_EQ(number(c.receive(from, kData)), 1U);
      }
      EXPECT_TRUE(is_pattern(c.receive(from, kData), big, static_cast<std::uint64_t>(from)));
      EXPECT_EQ(number(c.receive(from, kData)), 4U);
    }
  });
}

TEST_P(CommunicatorTest, AnyTagLeavesCollectivesAlone) {
  for_ranks(2, [](Communicator& c) {
    // The others are in the barrier while rank 0 waits for anything.
    if (c.rank() == 0) {
      EXPECT_EQ(number(c.receive(kAnyRank, kAnyTag)), 9u);
      EXPECT_FALSE(c.probe(kAnyRank, kAnyTag, Deadline::now()));
    } else if (c.rank() == 1) {
      c.send(0, kData, numbers({9}));
    }
    barrier(c);
  });
}

TEST_P(CommunicatorTest, NeverBlocksOnLargeMessages) {
  constexpr std::size_t kBytes = std::size_t{64} << 20;
  if (GetParam().most_ranks < 2) GTEST_SKIP() << "needs 2 ranks";
  GetParam().run_once(2, [](Communicator& c) {
    const int other = 1 - c.rank();
    c.send(other, kData, pattern(kBytes + c.rank(), c.rank()));
    c.send(other, kOther, numbers({3}));
    EXPECT_EQ(number(c.receive(other, kOther)), 3u);
    EXPECT_TRUE(is_pattern(c.receive(other, kData), kBytes + other, other));
  });
}

TEST_P(CommunicatorTest, LetsMessagesBeKeptAndSentOn) {
  const auto keep_and_send_on = [](Communicator& communicator, std::size_t bytes) {
    const int rank = communicator.rank(), size = communicator.size();
    const auto seed = [&](int from, int i) { return static_cast<std::uint64_t>(10 * from + i); };
    std::vector<Buffer> kept;
    for (int i = 0; i < 10; ++i) {
      communicator.send((rank + 1) % size, kData, pattern(bytes, seed(rank, i)));
      Buffer taken = communicator.receive((rank + size - 1) % size, kData);
      if (i % 2 == 0) {
        communicator.send((rank + 1) % size, kOther, std::move(taken));
        taken = communicator.receive((rank + size - 1) % size, kOther);
      }
      kept.push_back(std::move(taken));
    }
    for (int i = 0; i < 10; ++i) {
      const int from = (rank + 2 * size - (i % 2 == 0 ? 2 : 1)) % size;
      EXPECT_TRUE(is_pattern(kept[static_cast<std::size_t>(i)], bytes, seed(from, i))) << i;
    }
  };
  // In every order that is tried, then in blocks of shared memory.
  for_ranks(2, [&](Communicator& communicator) { keep_and_send_on(communicator, 1500); });
  for_ranks(
      2, [&](Communicator& communicator) { keep_and_send_on(communicator, 150'000); }, true);
}

TEST_P(CommunicatorTest, DeliversSizesAroundAPiece) {
  for_ranks(2, [](Communicator& c) {
    const int next = (c.rank() + 1) % c.size(), previous = (c.rank() + c.size() - 1) % c.size();
    const std::vector<std::size_t> sizes = {0, 1, 999, 1000, 1001, 1999, 2000, 2001, 70000};
    for (const std::size_t bytes : sizes) c.send(next, kData, pattern(bytes, bytes));
    for (const std::size_t bytes : sizes) {
      EXPECT_TRUE(is_pattern(c.receive(previous, kData), bytes, bytes)) << bytes;
    }
  });
}

TEST_P(CommunicatorTest, SplitsByColourAndOrdersByKey) {
  for_ranks(1, [](Communicator& c) {
    for (int times = 0; times < 3; ++times) {
      const int color = c.rank() % 2 == 0 ? -7 : 1000;
      const auto part = c.split(color, -c.rank());
      std::vector<int> members;
      for (int rank = c.size() - 1; rank >= 0; --rank) {
        if (rank % 2 == c.rank() % 2) members.push_back(rank);
      }
      ASSERT_EQ(part->size(), static_cast<int>(members.size()));
      for (int i = 0; i < part->size(); ++i) EXPECT_EQ(part->world_rank(i), members[i]);
      EXPECT_EQ(members[part->rank()], c.rank());
    }
  });
}

TEST_P(CommunicatorTest, SplitOrdersEqualKeysByRank) {
  for_ranks(1, [](Communicator& c) {
    const auto part = c.split(0, 0);
    EXPECT_EQ(part->rank(), c.rank());
    EXPECT_EQ(part->size(), c.size());
  });
}

TEST_P(CommunicatorTest, PartsDoNotHearEachOther) {
  for_ranks(2, [](Communicator& c) {
    const auto twin = c.split(0, 0);
    const auto half = twin->split(c.rank() % 2, 0);
    const int next = (c.rank() + 1) % c.size(), previous = (c.rank() + c.size() - 1) % c.size();
    c.send(next, kData, numbers({1}));
    twin->send(next, kData, numbers({2}));
    half->send((half->rank() + 1) % half->size(), kData, numbers({3}));
    EXPECT_EQ(number(half->receive(kAnyRank, kAnyTag)), 3u);
    EXPECT_FALSE(half->probe(kAnyRank, kAnyTag, Deadline::now()));
    EXPECT_EQ(number(twin->receive(kAnyRank, kAnyTag)), 2u);
    EXPECT_EQ(number(c.receive(previous, kAnyTag)), 1u);
    // Each part works through collectives of its own, at its own pace.
    std::uint64_t expected = 0;
    for (int i = 0; i < half->size(); ++i) expected += half->world_rank(i);
    EXPECT_EQ(all_reduce_value(*half, static_cast<std::uint64_t>(c.rank()), std::plus<>()),
              expected);
    barrier(c);
  });
}

// Every rank sends many messages of random size and tag to random ranks, then all are received by
// patterns of random kinds: each exactly once, in order per source and tag.
TEST_P(CommunicatorTest, SurvivesAStorm) {
  for_ranks(1, [](Communicator& c) {
    constexpr int kCount = 60, kTags = 3;
    std::mt19937_64 random(17 + c.rank());
    std::vector<std::uint64_t> sent(c.size(), 0);
    std::map<std::pair<int, Tag>, std::uint64_t> next_out, next_in;
    std::uint64_t expected = 0, received = 0;
    const auto take = [&](int from, Tag tag) {
      const auto envelope = c.probe(from, tag, Deadline::never());
      const Buffer message = c.receive(from, tag);
      ++received;
      ASSERT_EQ(envelope->bytes, message.size());
      ASSERT_EQ(number(message, 0), static_cast<std::uint64_t>(envelope->source));
      ASSERT_EQ(number(message, 1), static_cast<std::uint64_t>(envelope->tag));
      ASSERT_EQ(number(message, 2), (next_in[{envelope->source, envelope->tag}]++))
          << "from " << envelope->source;
    };
    for (int i = 0; i < kCount; ++i) {
      const int to = static_cast<int>(random() % c.size());
      const Tag tag = static_cast<Tag>(random() % kTags);
      Buffer message((3 + random() % 4 * (random() % 100)) * 8);
      const std::span<std::uint64_t> words = message.as<std::uint64_t>();
      words[0] = c.rank();
      words[1] = tag;
      words[2] = next_out[{to, tag}]++;
      c.send(to, tag, std::move(message));
      ++sent[to];
      if (random() % 4 == 0) {
        if (const auto envelope = c.probe(kAnyRank, kAnyTag, Deadline::now())) {
          take(envelope->source, envelope->tag);
        }
      }
    }
    all_reduce(c, std::span<std::uint64_t>(sent), std::plus<>());
    expected = sent[c.rank()];
    while (received < expected && !::testing::Test::HasFatalFailure()) {
      const auto envelope = c.probe(kAnyRank, kAnyTag, Deadline::never());
      const int kind = static_cast<int>(random() % 4);
      take(kind & 1 ? envelope->source : kAnyRank, kind & 2 ? envelope->tag : kAnyTag);
    }
    barrier(c);
    EXPECT_FALSE(c.probe(kAnyRank, kAnyTag, Deadline::now()));
  });
}

INSTANTIATE_TEST_SUITE_P(Machines, CommunicatorTest, ::testing::ValuesIn(machines()),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace delray::comm::testing
