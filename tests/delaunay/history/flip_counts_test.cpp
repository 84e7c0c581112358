// Flips, journals and lock lists, as statistics tell them.
#include <gtest/gtest.h>

#include <string>

#include "delaunay/generate.h"
#include "delaunay/triangulate.h"

namespace delray::delaunay {
namespace {

constexpr std::uint64_t kPoints = 3000, kSeed = 20261127;

Result counted(int dim, const std::string& method, const std::string& location, int threads) {
  Options options;
  options.dim = dim;
  options.method = method;
  options.location = location;
  options.threads = threads;
  options.statistics = true;
  return triangulate(view(generate_points("uniform", kPoints, dim, kSeed).positions), options);
}

// Every node of a history was made by a subdivision or a flip.
TEST(FlipCounts, AccountForTheHistory) {
  for (const char* const method : {"insertion", "optimistic", "burglary", "pessimistic"}) {
    SCOPED_TRACE(method);
    const Statistics plane = counted(2, method, "dag", 1).statistics;
    EXPECT_EQ(plane.dag_nodes, 4 + 3 * (kPoints - 3) + 2 * plane.flips.two_two);
    EXPECT_EQ(plane.flips.sum(), plane.flips.two_two);
    const Statistics space = counted(3, method, "dag", 1).statistics;
    EXPECT_EQ(space.dag_nodes, 5 + 4 * (kPoints - 4) + 3 * space.flips.two_three +
                                   2 * space.flips.three_two +
                                   4 * (space.flips.four_four + space.flips.two_two));
    EXPECT_GT(space.flips.three_two, 0U);
  }
}

// Tetrahedra, ghosts among them, are what subdivisions and flips leave.
TEST(FlipCounts, AccountForTheTetrahedra) {
  const Result made = counted(3, "insertion", "walk", 1);
  const FlipCounts& flips = made.statistics.flips;
  EXPECT_EQ(made.triangulation.size() + made.triangulation.hull_facets,
            5 + 3 * (kPoints - 4) + flips.two_three - flips.three_two);
}

TEST(FlipCounts, AreThoseOfAllThreads) {
  for (const char* const method : {"batch", "pessimistic", "optimistic", "burglary"}) {
    SCOPED_TRACE(method);
    // Orders differ with the threads, and with them flips, but not by orders of magnitude.
    const std::uint64_t alone = counted(2, method, "dag", 1).statistics.flips.sum();
    const std::uint64_t together = counted(2, method, "dag", 3).statistics.flips.sum();
    EXPECT_GT(together, alone / 4);
  }
  EXPECT_EQ(counted(2, "divide-and-conquer", "auto", 1).statistics.flips.sum(), 0U);
}

TEST(ListLengths, AreThoseOfInsertions) {
  const Synchronization optimistic = counted(3, "optimistic", "auto", 3).statistics.synchronization;
  EXPECT_GE(optimistic.journals.lists, kPoints - 4);
  EXPECT_EQ(optimistic.journals.lists, optimistic.lock_lists.lists);
  EXPECT_GT(optimistic.journals.entries, optimistic.journals.lists);
  // A subdivision alone makes four simplices and holds the one that they replace.
  EXPECT_GE(optimistic.lock_lists.entries, 5 * (kPoints - 4));
  EXPECT_GE(optimistic.lock_lists.longest * optimistic.lock_lists.lists,
            optimistic.lock_lists.entries);
  const Synchronization burglary = counted(2, "burglary", "auto", 2).statistics.synchronization;
  EXPECT_EQ(burglary.journals.lists, 0U);
  EXPECT_GT(burglary.lock_lists.lists, 0U);
}

}  // namespace
}  // namespace delray::delaunay
