// Termination is detected when all work is done, and not before.
#include "comm/termination.h"

#include <gtest/gtest.h>

#include <random>

#include "comm/collectives.h"
#include "tests/comm/machine.h"

namespace delray::comm::testing {
namespace {

constexpr Tag kWork = 1, kControl = 2;

class TerminationTest : public ::testing::TestWithParam<Machine> {};

// Work that makes work: a task of generation g sends tasks of generation g - 1 to random ranks.
// When everybody has ended, as many tasks must have been done as were made.
void spread_work(Communicator& c, std::uint64_t seed) {
  std::mt19937_64 random(seed * 100 + c.rank());
  Termination termination(c, kControl);
  std::int64_t made = 0, done = 0;
  const auto make = [&](int generation) {
    c.send(static_cast<int>(random() % c.size()), kWork, Buffer::of_value(generation));
    termination.count_sent();
    ++made;
  };
  const auto run = [&](int generation) {
    ++done;
    c.work(Work::rays, random() % 100);
    if (generation == 0) return;
    for (auto i = random() % 3; i > 0; --i) make(generation - 1);
  };
  if (c.rank() == c.size() / 2) make(8);
  if (c.rank() == 0) make(6);
  for (;;) {
    termination.idle();
    if (termination.is_over()) break;
    const auto next = c.probe(kAnyRank, kAnyTag, Deadline::never());
    if (next->tag == kControl) {
      termination.handle(*next);
    } else {
      const int generation = c.receive(next->source, kWork).as<int>()[0];
      termination.count_received();
      run(generation);
    }
  }
  EXPECT_FALSE(c.probe(kAnyRank, kAnyTag, Deadline::now()));
  const std::int64_t difference = all_reduce_value(c, made - done, std::plus<>());
  EXPECT_EQ(difference, 0);
  EXPECT_GE(all_reduce_value(c, done, std::plus<>()), 2);
  EXPECT_GE(termination.waves(), 2u);
}

TEST_P(TerminationTest, EndsWhenAllWorkIsDoneAndNotBefore) {
  for (const int ranks : {1, 2, 3, 4, 7}) {
    if (ranks > GetParam().most_ranks) break;
    SCOPED_TRACE(std::to_string(ranks) + " ranks");
    for (std::uint64_t seed = 0; seed < 3; ++seed) {
      GetParam().run(ranks, [&](Communicator& c) { spread_work(c, seed); });
    }
  }
}

TEST_P(TerminationTest, EndsWithoutAnyWork) {
  for (const int ranks : {1, 2, 5, 9}) {
    if (ranks > GetParam().most_ranks) break;
    GetParam().run(ranks, [](Communicator& c) {
      Termination termination(c, kControl);
      for (termination.idle(); !termination.is_over(); termination.idle()) {
        const auto next = c.probe(kAnyRank, kControl, Deadline::never());
        termination.handle(*next);
      }
      EXPECT_EQ(termination.waves(), 2u);
    });
  }
}

INSTANTIATE_TEST_SUITE_P(Machines, TerminationTest, ::testing::ValuesIn(machines()),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace delray::comm::testing
