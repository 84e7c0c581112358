// Simplices that are unlocked before an insertion ends: the same triangulation, and what is
// counted.
#include <gtest/gtest.h>

#include <string>

#include "delaunay/combinations.h"
#include "delaunay/generate.h"
#include "delaunay/history/burglar_locks.h"
#include "delaunay/methods.h"
#include "tests/delaunay/same_simplices.h"

namespace delray::delaunay {
namespace {

constexpr std::uint64_t kUnlockSeed = 20261128;

// Insertions that undo what others have seen the edge of, burglaries, and vertices on edges.
TEST(EarlyUnlock, MakesTheSameSimplicesWithMoreThreadsThanCores) {
  for (const int dim : {2, 3}) {
    for (const char* const kind : {"uniform", "grid", "cluster", "arc", "sphere"}) {
      const auto points = generate_points(kind, dim == 2 ? 1500 : 400, dim, kUnlockSeed).positions;
      const Triangulation expected = expected_of(points, dim);
      for (Options options : combinations(dim)) {
        if (options.unlock != "early" || options.locks != "atomic") continue;
        options.seed = kUnlockSeed;
        options.threads = 8;
        options.split = "random";  // threads whose points lie among each other meet most
        ASSERT_NO_FATAL_FAILURE(expect_same(points, expected, options, kind));
      }
    }
  }
}

// What a burglar has locked keeps the thread asleep whose simplices it uses.
TEST(EarlyUnlock, WaitsForTheEndAfterABurglary) {
  using internal::BurglarLocks, internal::Grant;
  Dag<2> dag;
  Options options;
  options.locks = "atomic";
  options.unlock = "early";
  internal::Burglaries shared(2, options);
  parallel::Team team;
  BurglarLocks<2, true, false> burglar(dag, team, shared, 0), robbed(dag, team, shared, 1);
  burglar.reserve(2);
  const NodeNumber wanted = burglar.create({0, 1, 2}), other = burglar.create({2, 1, 3});
  burglar.commit();
  const auto owner = [&](NodeNumber node) { return dag.owner(node, dag.record_of(node)); };

  ASSERT_EQ(burglar.acquire({wanted}), Grant::kGranted);
  burglar.keep(wanted);
  EXPECT_EQ(owner(wanted), 0U);
  ASSERT_EQ(burglar.acquire({wanted}), Grant::kGranted);
  ASSERT_EQ(robbed.acquire({other}), Grant::kGranted);
  std::uint32_t holder = 0;
  ASSERT_TRUE(shared.waits.enter(dag, 1, {wanted, dag.record_of(wanted)}, holder));
  burglar.reserve(1);
  const NodeNumber made = burglar.create({3, 1, 4});
  ASSERT_EQ(burglar.acquire({other}), Grant::kGranted);
  ASSERT_TRUE(burglar.has_robbed());
  burglar.keep(wanted);
  burglar.keep(made);  // the other thread sees it by now
  EXPECT_EQ(owner(wanted), 1U);
  EXPECT_EQ(owner(made), 1U);
  burglar.commit();
  EXPECT_EQ(owner(wanted), 0U);
  EXPECT_EQ(owner(made), 0U);
  EXPECT_EQ(owner(other), 2U);
  ASSERT_EQ(burglar.acquire({wanted}), Grant::kGranted);
  burglar.keep(wanted);
  EXPECT_EQ(owner(wanted), 0U);
  EXPECT_EQ(burglar.counts().unlocked_early, 2U);
}

TEST(EarlyUnlock, IsCounted) {
  const std::size_t n = 2000;
  for (const char* const method : {"optimistic", "burglary"}) {
    for (const int dim : {2, 3}) {
      SCOPED_TRACE(std::string(method) + ", " + std::to_string(dim) + "D");
      const auto points = generate_points("uniform", n, dim, kUnlockSeed).positions;
      Options options;
      options.dim = dim;
      options.method = method;
      options.statistics = true;
      const Synchronization end = triangulate(view(points), options).statistics.synchronization;
      options.unlock = "early";
      const Synchronization early = triangulate(view(points), options).statistics.synchronization;
      EXPECT_EQ(end.unlocked_early, 0U);
      EXPECT_GT(early.unlocked_early, n);
      EXPECT_EQ(early.lock_lists.lists, end.lock_lists.lists);
      // One thread does the same either way: what it asks for again was unlocked before, and what
      // is left at the end of an insertion is what was not.
      EXPECT_EQ(early.lock_calls, end.lock_calls);
      EXPECT_EQ(early.free - end.free, end.already_locked - early.already_locked);
      EXPECT_EQ(early.lock_lists.entries,
                end.lock_lists.entries + (early.free - end.free) - early.unlocked_early);
      options.threads = 3;
      EXPECT_GT(triangulate(view(points), options).statistics.synchronization.unlocked_early, n);
    }
  }
}

}  // namespace
}  // namespace delray::delaunay
