// How runs over threads and on the simulated machine end when a rank fails.
#include "comm/failure.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <latch>
#include <optional>
#include <ostream>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <vector>

#include "comm/agree_on_failure.h"
#include "comm/collectives.h"
#include "comm/simulated.h"
#include "comm/threads.h"
#include "files/error.h"
#include "parallel/progress.h"

namespace delray::comm {
namespace {

using Body = std::function<void(Communicator&)>;
struct Runner {
  const char* name;
  void (*run)(int ranks, const Body&);
  friend void PrintTo(const Runner& runner, std::ostream* out) { *out << runner.name; }
};
class FailureTest : public ::testing::TestWithParam<Runner> {
 protected:
  std::optional<RankFailure> failure_of(int ranks, const Body& body) {
    try {
      GetParam().run(ranks, body);
    } catch (const RankFailure& failure) {
      return failure;
    }
    return std::nullopt;
  }
};

struct Boom : std::runtime_error {
  using std::runtime_error::runtime_error;
};

TEST_P(FailureTest, NamesTheRankThatThrew) {
  for (int failing = 0; failing < 4; ++failing) {
    const auto failure = failure_of(4, [&](Communicator& c) {
      c.mark(Phase::compose, 1);
      if (c.rank() == failing) throw Boom("no more memory on the moon");
      c.receive(failing, 1);
    });
    ASSERT_TRUE(failure);
    EXPECT_EQ(failure->rank(), failing);
    EXPECT_EQ(failure->phase(), Phase::compose);
    EXPECT_EQ(failure->why(), "no more memory on the moon");
    EXPECT_STREQ(failure->what(), ("rank " + std::to_string(failing) +
                                   " failed in phase compose: no more memory on the moon")
                                      .c_str());
    EXPECT_THROW(std::rethrow_exception(failure->cause()), Boom);
  }
}

TEST_P(FailureTest, WakesRanksOutOfEveryKindOfWaiting) {
  const auto failure = failure_of(6, [](Communicator& c) {
    switch (c.rank()) {
      case 0:
        c.receive(5, 1);
        break;
      case 1:
        c.receive(kAnyRank, kAnyTag);
        break;
      case 2:
        c.probe(kAnyRank, 3, Deadline::never());
        break;
      case 3:
        c.probe(5, kAnyTag, Deadline::in(std::chrono::hours(1)));
        break;
      case 4:
        c.split(0, 0);
        break;
      default:
        // Most of the others sleep by now.
        c.probe(kAnyRank, 9, Deadline::in(std::chrono::milliseconds(20)));
        c.abort("enough");
    }
    ADD_FAILURE() << "rank " << c.rank() << " went on";
  });
  ASSERT_TRUE(failure);
  EXPECT_EQ(failure->rank(), 5);
  EXPECT_EQ(failure->why(), "enough");
  EXPECT_EQ(failure->cause(), nullptr);
}

TEST_P(FailureTest, EndsRanksThatOnlySend) {
  const auto failure = failure_of(2, [](Communicator& c) {
    if (c.rank() == 1) throw Boom("x");
    c.receive(1, 1);
    for (;;) c.send(0, 1, Buffer());
  });
  ASSERT_TRUE(failure);
  EXPECT_EQ(failure->rank(), 1);
}

TEST_P(FailureTest, UnwindsObjectsOfAllRanks) {
  struct Guard {
    explicit Guard(std::atomic<int>& n) : alive(n) { ++alive; }
    ~Guard() { --alive; }
    std::atomic<int>& alive;
  };
  std::atomic<int> alive{0};
  const auto failure = failure_of(5, [&](Communicator& c) {
    const Guard guard(alive);
    const auto part = c.split(0, 0);
    if (c.rank() == 3) throw Boom("x");
    part->receive(kAnyRank, 1);
  });
  ASSERT_TRUE(failure);
  EXPECT_EQ(alive, 0);
}

TEST_P(FailureTest, FindsADeadlock) {
  const auto failure = failure_of(3, [](Communicator& c) {
    c.mark(Phase::gather, 0);
    barrier(c);
    if (c.rank() == 0) return;
    c.receive(c.rank() == 1 ? 2 : 1, 77);
  });
  ASSERT_TRUE(failure);
  EXPECT_EQ(failure->rank(), 1);
  EXPECT_EQ(failure->phase(), Phase::gather);
  EXPECT_EQ(failure->why(),
            "deadlock: it waits for a message from rank 2 with tag 77, and 1 more rank(s) wait in "
            "vain");
}

TEST_P(FailureTest, FindsADeadlockInOnePartOfASplit) {
  const auto failure = failure_of(4, [](Communicator& c) {
    const auto part = c.split(c.rank() / 2, 0);
    // The right message, but on another communicator.
    c.send(c.rank() ^ 1, 1, Buffer());
    part->receive(kAnyRank, 1);
  });
  ASSERT_TRUE(failure);
  EXPECT_EQ(failure->rank(), 0);
}

TEST_P(FailureTest, DoesNotTakeALateMessageForADeadlock) {
  for (int times = 0; times < 50; ++times) {
    const auto failure = failure_of(3, [](Communicator& c) {
      for (int i = 0; i < 20; ++i) {
        c.send((c.rank() + 1) % 3, i, Buffer());
        c.receive((c.rank() + 2) % 3, i);
      }
      if (c.rank() == 0) {
        c.probe(kAnyRank, 5, Deadline::in(std::chrono::microseconds(50)));
        c.send(1, 5, Buffer());
      } else if (c.rank() == 1) {
        c.receive(0, 5);
        c.send(2, 6, Buffer());
      } else {
        c.receive(1, 6);
      }
    });
    ASSERT_FALSE(failure) << failure->what();
  }
}

TEST_P(FailureTest, PassesBadInputAndInterruptionThrough) {
  EXPECT_THROW(
      {
        try {
          GetParam().run(3, [](Communicator& c) {
            if (c.rank() == 1) {
              throw files::FileError(files::Cause::input, "a.ply", "line 3", "not a number");
            }
            c.receive(1, 1);
          });
        } catch (const files::FileError& error) {
          EXPECT_STREQ(error.what(), "a.ply: line 3: not a number");
          throw;
        }
      },
      files::FileError);
  EXPECT_THROW(GetParam().run(3,
                              [](Communicator& c) {
                                if (c.rank() == 2) throw parallel::Interrupted();
                                barrier(c);
                              }),
               parallel::Interrupted);
}

TEST_P(FailureTest, ArgumentsThatCannotBeAreNoRanksFault) {
  EXPECT_THROW(GetParam().run(3,
                              [](Communicator& c) {
                                if (c.rank() == 2) throw std::invalid_argument("x");
                                barrier(c);
                              }),
               std::invalid_argument);
  EXPECT_THROW(GetParam().run(3,
                              [](Communicator& c) {
                                all_or_none(c, Phase::load, [&] {
                                  if (c.rank() == 2) throw std::invalid_argument("x");
                                });
                              }),
               std::invalid_argument);
}

TEST_P(FailureTest, MessagesGoToRanksThatThereAre) {
  const std::vector<std::function<void(Communicator&)>> wrong = {
      [](Communicator& c) { c.send(2, 1, Buffer()); },
      [](Communicator& c) { c.send(-1, 1, Buffer()); },
      [](Communicator& c) { c.send(0, -1, Buffer()); },
      [](Communicator& c) { broadcast(c, 2, Buffer()); },
      [](Communicator& c) { gather(c, -1, Buffer()); },
      [](Communicator& c) { reduce_buffers(c, 7, Buffer(), [](Buffer&, Buffer&) {}); },
      [](Communicator& c) {
        std::vector<Parcel> parcels(1);
        parcels[0].rank = 5;
        exchange(c, std::move(parcels));
      }};
  for (const auto& send : wrong) {
    EXPECT_THROW(GetParam().run(2, [&](Communicator& c) { send(c); }), std::invalid_argument);
  }
}

TEST_P(FailureTest, MemoryThatIsNotThereIsNoLostRank) {
  const std::vector<std::function<void()>> ways = {
      [] { throw std::bad_alloc(); }, [] { std::vector<double>().reserve(std::size_t{1} << 62); },
      [] {
        throw std::system_error(std::make_error_code(std::errc::resource_unavailable_try_again));
      }};
  for (const auto& way : ways) {
    for (const bool agreed : {false, true}) {
      try {
        GetParam().run(3, [&](Communicator& c) {
          c.mark(Phase::bin, 0);
          const auto fail = [&] {
            if (c.rank() == 1) way();
          };
          if (!agreed) fail();
          all_or_none(c, Phase::bin, fail);
        });
        ADD_FAILURE() << "did not fail";
      } catch (const OutOfMemory& error) {
        EXPECT_STREQ(error.what(), "out of memory: rank 1, in phase bin");
      }
    }
  }
}

TEST_P(FailureTest, TellsThatSomethingElseWasThrown) {
  const auto failure = failure_of(2, [](Communicator& c) {
    if (c.rank() == 0) throw 42;
    c.receive(0, 1);
  });
  ASSERT_TRUE(failure);
  EXPECT_EQ(failure->why(), "an exception that is no std::exception");
}

TEST_P(FailureTest, RanksCatchWhileOthersCatch) {
  // Exceptions in flight on several ranks at once must not mix.
  GetParam().run(4, [](Communicator& c) {
    for (int i = 0; i < 10; ++i) {
      try {
        throw Boom(std::to_string(c.rank()));
      } catch (const Boom& boom) {
        barrier(c);
        EXPECT_EQ(std::uncaught_exceptions(), 0);
        try {
          if ((c.rank() + i) % 2) throw;
        } catch (const Boom& again) {
          barrier(c);
          EXPECT_EQ(again.what(), std::to_string(c.rank()));
          continue;
        }
        barrier(c);
        EXPECT_EQ(boom.what(), std::to_string(c.rank()));
      }
    }
  });
}

TEST_P(FailureTest, AllRanksAgreeOnBadInput) {
  std::atomic<int> thrown{0};
  EXPECT_THROW(GetParam().run(5,
                              [&](Communicator& c) {
                                EXPECT_EQ(all_or_none(c, Phase::load, [] { return 3; }), 3);
                                try {
                                  all_or_none(c, Phase::load, [&] {
                                    if (c.rank() < 3) return;
                                    throw files::FileError(files::Cause::input, "scene.glb",
                                                           c.rank() == 3 ? "byte 12" : "",
                                                           "truncated");
                                  });
                                } catch (const files::FileError& error) {
                                  EXPECT_STREQ(error.what(), "scene.glb: byte 12: truncated");
                                  EXPECT_EQ(error.place(), "byte 12");
                                  EXPECT_EQ(error.cause(), files::Cause::input);
                                  ++thrown;
                                  throw;
                                }
                              }),
               files::FileError);
  // The first to leave may end the others before they have heard.
  EXPECT_GE(thrown, 1);
}

TEST_P(FailureTest, AllRanksAgreeOnAnyException) {
  const auto failure = failure_of(4, [&](Communicator& c) {
    try {
      all_or_none(c, Phase::bin, [&] {
        if (c.rank() == 2) throw Boom("lost");
        return 1.5;
      });
    } catch (const AgreedFailure&) {
      throw;
    }
  });
  ASSERT_TRUE(failure);
  EXPECT_EQ(failure->rank(), 2);
  EXPECT_EQ(failure->phase(), Phase::bin);
  EXPECT_EQ(failure->why(), "lost");
}

INSTANTIATE_TEST_SUITE_P(
    Machines, FailureTest,
    ::testing::Values(
        Runner{"threads", [](int ranks, const Body& body) { run_threads(ranks, 1, body); }},
        Runner{"simulated",
               [](int ranks, const Body& body) { run_simulated(ranks, Network(), 0, body); }},
        Runner{"simulated_any_order",
               [](int ranks, const Body& body) { run_simulated(ranks, any_order(), 5, body); }}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(ThreadsFailure, TakesALongWaitForAStall) {
  ThreadsOptions options;
  options.timeout = std::chrono::milliseconds(30);
  try {
    run_threads(
        2, 1,
        [](Communicator& c) {
          c.mark(Phase::trace, 0);
          if (c.rank() == 0) c.receive(1, 4);
          // Alive, but of no use.
          while (true) c.probe(0, 1, Deadline::in(std::chrono::milliseconds(1)));
        },
        options);
    FAIL() << "did not end";
  } catch (const RankFailure& failure) {
    EXPECT_EQ(failure.rank(), 1);
    EXPECT_EQ(failure.phase(), Phase::trace);
    EXPECT_EQ(failure.why(), "stalled: rank 0 waited 0.03 s for a message from rank 1 with tag 4");
  }
}

// Rank 2 is at fault, whoever of the others has waited the longest.
TEST(ThreadsFailure, NamesTheRankThatAllWaitForInTheEnd) {
  for (int i = 0; i < 5; ++i) {
    std::latch begun(4);  // a rank that has not begun waits for nobody
    try {
      run_threads(4, 1,
                  [&](Communicator& c) {
                    begun.arrive_and_wait();
                    c.mark(Phase::load, 0);
                    if (c.rank() != 2) c.receive((c.rank() + 1) % 4, 4);
                    c.mark(Phase::shade, 0);
                    while (true) c.probe(0, 1, Deadline::in(std::chrono::milliseconds(1)));
                  },
                  {.timeout = std::chrono::milliseconds(100)});
      FAIL() << "did not end";
    } catch (const RankFailure& failure) {
      EXPECT_EQ(failure.rank(), 2);
      EXPECT_EQ(failure.phase(), Phase::shade);
    }
  }
}

TEST(ThreadsFailure, TellsOfARankThatNeitherSendsNorWaits) {
  std::atomic<bool> released{false};
  int told_of = -1;
  ThreadsOptions options;
  options.timeout = std::chrono::milliseconds(20);
  options.on_stuck = [&](const RankFailure& failure) {
    told_of = failure.rank();
    released = true;
  };
  EXPECT_THROW(run_threads(
                   3, 1,
                   [&](Communicator& c) {
                     if (c.rank() != 1) c.receive(1, 0);
                     while (!released) std::this_thread::yield();
                   },
                   options),
               RankFailure);
  EXPECT_EQ(told_of, 1);
}

TEST(ThreadsFailure, RefusesNumbersOfRanksAndThreadsThatCannotBe) {
  const auto nothing = [](Communicator&) {};
  for (const int wrong : {0, -3}) {
    EXPECT_THROW(run_threads(wrong, 1, nothing), std::invalid_argument);
    EXPECT_THROW(run_threads(1, wrong, nothing), std::invalid_argument);
  }
  EXPECT_THROW(run_threads(1, 100000, nothing), std::invalid_argument);
}

}  // namespace
}  // namespace delray::comm
