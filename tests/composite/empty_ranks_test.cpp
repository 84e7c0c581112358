// Ranks that have nothing take no part and cost next to nothing.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>

#include "comm/collectives.h"
#include "comm/simulated.h"
#include "composite/metadata_only.h"
#include "composite/scheme.h"

namespace delray::composite {
namespace {

// Virtual seconds until the last of `ranks` ranks is done.
double seconds_of(int ranks, const std::function<void(comm::Communicator&)>& body) {
  const auto ends = comm::run_simulated(ranks, {}, 1, body);
  return *std::max_element(ends.begin(), ends.end());
}

TEST(EmptyRanks, CostNoMoreThanFindingThem) {
  constexpr std::uint64_t kPixels = 1920 * 1080;
  for (const Scheme& scheme : schemes()) {
    for (const int busy : {2, 3, 8}) {
      const int all = 10 * busy;
      const double alone = seconds_of(busy, [&](comm::Communicator& communicator) {
        compose(communicator, make_metadata_only_dense(kPixels, kPixelBytes8, false), scheme.name);
      });
      const double among_empty = seconds_of(all, [&](comm::Communicator& communicator) {
        const bool empty = communicator.rank() % 10 != 7;
        const OwnedPixels part = compose(
            communicator, make_metadata_only_dense(kPixels, kPixelBytes8, empty), scheme.name);
        if (empty) {
          EXPECT_TRUE(part.ranges.empty());
        }
      });
      const double all_reduce = seconds_of(all, [](comm::Communicator& communicator) {
        comm::all_reduce_value(communicator, 1, std::plus<>());
      });
      EXPECT_LE(among_empty, 1.2 * alone + all_reduce) << scheme.name << ", " << busy;
    }
  }
}

TEST(EmptyRanks, ShareAnEmptyPicture) {
  for (const Scheme& scheme : schemes()) {
    std::uint64_t pixels = 0;
    comm::run_simulated(7, {}, 1, [&](comm::Communicator& communicator) {
      const OwnedPixels part =
          compose(communicator, make_metadata_only_dense(1000, kPixelBytes8, true), scheme.name);
      for (const PixelRange& range : part.ranges) pixels += range.size();
    });
    EXPECT_EQ(pixels, 1000U) << scheme.name;
  }
}

}  // namespace
}  // namespace delray::composite
