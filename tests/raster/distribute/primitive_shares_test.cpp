// Intervals of primitives that follow the work that ranks had with them.
#include "raster/distribute/primitive_shares.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "comm/collectives.h"
#include "comm/threads.h"

namespace delray::raster {
namespace {

using Intervals = std::vector<std::pair<std::uint64_t, std::uint64_t>>;

// Of primitives [begin, end), where i has the part work(i) of all work, evenly.
std::vector<std::uint64_t> samples(std::uint64_t begin, std::uint64_t end,
                                   const std::function<double(std::uint64_t)>& work) {
  constexpr double kSamples = 4000;
  std::vector<std::uint64_t> seen;
  double all = 0, before = 0;
  for (std::uint64_t i = begin; i < end; ++i) all += work(i);
  for (std::uint64_t i = begin; i < end; before += work(i++)) {
    for (auto k = std::ceil(before / all * kSamples); k < (before + work(i)) / all * kSamples; ++k)
      seen.push_back(i);
  }
  return seen;
}

// The intervals of all ranks after so many frames, where primitive i is work(i). At the frame
// `forgets` the last rank begins anew.
Intervals after(int frames, int ranks, std::uint64_t primitives,
                const std::function<double(std::uint64_t)>& work, int forgets = -1) {
  Intervals intervals(static_cast<std::size_t>(ranks));
  comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
    std::optional<PrimitiveShares> shares(std::in_place);
    auto& mine = intervals[static_cast<std::size_t>(communicator.rank())];
    for (int frame = 0; frame < frames; ++frame) {
      if (frame == forgets && communicator.rank() == ranks - 1) shares.emplace();
      mine = shares->next(communicator, primitives);
      const std::vector<std::uint64_t> seen = samples(mine.first, mine.second, work);
      double sum = 0;
      for (std::uint64_t i = mine.first; i < mine.second; ++i) sum += work(i);
      shares->measure(0, sum, seen);
    }
  });
  return intervals;
}

void expect_cover(const Intervals& intervals, std::uint64_t primitives) {
  std::uint64_t end = 0;
  for (const auto& interval : intervals) {
    EXPECT_EQ(interval.first, end);
    EXPECT_LE(interval.first, interval.second);
    end = interval.second;
  }
  EXPECT_EQ(end, primitives);
}

TEST(PrimitiveShares, AreEqualInTheFirstFrame) {
  for (const int ranks : {1, 2, 3, 9}) {
    for (const std::uint64_t primitives : {0U, 1U, 5U, 1000U}) {
      const Intervals intervals = after(1, ranks, primitives, [](std::uint64_t) { return 1.0; });
      expect_cover(intervals, primitives);
      for (const auto& [begin, end] : intervals)
        EXPECT_LE(end - begin, primitives / static_cast<std::uint64_t>(ranks) + 1);
    }
  }
}

TEST(PrimitiveShares, ComeToHaveEqualWork) {
  constexpr std::uint64_t kPrimitives = 20000;
  // All work but a little lies in a twentieth of the primitives, on one side of the middle.
  const auto work = [](std::uint64_t i) { return i >= 8000 && i < 9000 ? 100.0 : 0.1; };
  for (const int ranks : {2, 3, 5}) {
    const Intervals intervals = after(2, ranks, kPrimitives, work);
    expect_cover(intervals, kPrimitives);
    double most = 0, all = 0;
    for (const auto& [begin, end] : intervals) {
      double sum = 0;
      for (std::uint64_t i = begin; i < end; ++i) sum += work(i);
      most = std::max(most, sum);
      all += sum;
    }
    EXPECT_LT(most * ranks, 1.02 * all) << ranks;
  }
}

TEST(PrimitiveShares, StayWhereWorkIsEqualOrNone) {
  for (const double work : {0.0, 1.0}) {
    const Intervals intervals = after(5, 4, 1000, [&](std::uint64_t) { return work; });
    expect_cover(intervals, 1000);
    for (const auto& [begin, end] : intervals) EXPECT_EQ(end - begin, 250U);
  }
}

TEST(PrimitiveShares, BeginAnewWhereARankWasElsewhere) {
  const auto work = [](std::uint64_t i) { return i < 100 ? 1.0 : 0.0; };
  const Intervals kept = after(6, 2, 1000, work);
  EXPECT_EQ(kept[0].second, 50U);
  const Intervals anew = after(6, 2, 1000, work, 5);
  expect_cover(anew, 1000);
  EXPECT_EQ(anew[0].second, 500U);
}

// Neighbours that are seen as much as all others together, and more.
TEST(PrimitiveShares, AreCutBesidePrimitivesWithMuchWork) {
  const auto work = [](std::uint64_t i) { return i == 700 ? 9000.0 : i == 701 ? 6000.0 : 1.0; };
  const Intervals two = after(2, 2, 6000, work);
  EXPECT_EQ(two[0].second, 701U);
  const Intervals four = after(2, 4, 6000, work);
  expect_cover(four, 6000);
  EXPECT_EQ(four[1], (std::pair<std::uint64_t, std::uint64_t>{700, 701}));
  EXPECT_EQ(four[2], (std::pair<std::uint64_t, std::uint64_t>{701, 702}));
}

// Intervals stay from then on, though no cuts make ranks equal.
TEST(PrimitiveShares, StayBesidePrimitivesWithMuchWork) {
  const auto work = [](std::uint64_t i) { return i == 300 ? 5000.0 : 1.0; };
  for (const int ranks : {2, 3, 7}) {
    const Intervals once = after(2, ranks, 4000, work);
    for (const int frames : {3, 4, 6}) EXPECT_EQ(after(frames, ranks, 4000, work), once) << ranks;
  }
}

// Who has not measured its last frame does not say where its work lies.
TEST(PrimitiveShares, BeginAnewWhereARankHasNotMeasured) {
  for (const int silent : {0, 1, 2}) {
    comm::run_threads(3, 1, [&](comm::Communicator& communicator) {
      PrimitiveShares shares;
      std::pair<std::uint64_t, std::uint64_t> mine;
      for (int frame = 0; frame < 4; ++frame) {
        mine = shares.next(communicator, 900);
        if (frame == 2 && communicator.rank() == silent) continue;
        const std::vector<std::uint64_t> seen(mine.first == 0 && mine.second > 0 ? 9U : 0U, 0);
        shares.measure(1, mine.first == 0 ? 500 : 0, seen);
      }
      const auto k = static_cast<std::uint64_t>(communicator.rank());
      EXPECT_EQ(mine, (std::pair{300 * k, 300 * k + 300})) << silent;
    });
  }
}

// What is drawn counts where nothing is seen, too.
TEST(PrimitiveShares, CountWhatIsDrawn) {
  comm::run_threads(2, 1, [&](comm::Communicator& communicator) {
    PrimitiveShares shares;
    std::pair<std::uint64_t, std::uint64_t> mine;
    for (int frame = 0; frame < 2; ++frame) {
      mine = shares.next(communicator, 1000);
      const std::vector<std::uint64_t> seen(mine.first == 0 ? 10U : 0U, 0);
      shares.measure(1, mine.first == 0 ? 500 : 0, seen);
    }
    EXPECT_EQ(mine.first, communicator.rank() == 0 ? 0U : 250U);
  });
}

TEST(PrimitiveShares, CoverFewPrimitivesForManyRanks) {
  const auto work = [](std::uint64_t i) { return i == 0 ? 10.0 : 1.0; };
  expect_cover(after(10, 7, 3, work), 3);
  expect_cover(after(10, 7, 0, work), 0);
}

}  // namespace
}  // namespace delray::raster
