#include "raster/distribute/agreement.h"

#include <gtest/gtest.h>

#include "comm/threads.h"
#include "tests/raster/allow_threads.h"

namespace delray::raster {
namespace {

TEST(Agreement, HoldsWhereNothingChangesForAnybody) {
  comm::run_threads(4, 1, [](comm::Communicator& all) {
    Agreement agreement;
    EXPECT_FALSE(agreement.holds(all, true));  // on what?
    EXPECT_TRUE(agreement.holds(all, true));
    EXPECT_TRUE(agreement.holds(all, true));
    EXPECT_FALSE(agreement.holds(all, all.rank() != 2));
    EXPECT_TRUE(agreement.holds(all, true));
    EXPECT_FALSE(agreement.holds(all, false));
    EXPECT_TRUE(agreement.holds(all, true));
  });
}

TEST(Agreement, IsOfThoseWhoWereThere) {
  comm::run_threads(4, 1, [](comm::Communicator& all) {
    Agreement agreement;
    const auto half = all.split(all.rank() / 2, 0);
    EXPECT_FALSE(agreement.holds(*half, true));
    EXPECT_TRUE(agreement.holds(*half, true));
    // As often in both halves, but of two different calls.
    EXPECT_FALSE(agreement.holds(all, true));
    EXPECT_TRUE(agreement.holds(all, true));
    EXPECT_TRUE(agreement.holds(*half, true));  // they were all there
  });
}

}  // namespace
}  // namespace delray::raster
