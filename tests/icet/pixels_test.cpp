#include "icet/pixels.h"

#include <gtest/gtest.h>

#include <limits>

namespace delray::icet {

TEST(Pixels, ChannelsBecomeBytesTowardsZero) {
  EXPECT_EQ(byte_of(0), 0);
  EXPECT_EQ(byte_of(0.5F), 127);
  EXPECT_EQ(byte_of(1), 255);
  EXPECT_EQ(byte_of(-3), 0);
  EXPECT_EQ(byte_of(1e30F), 255);
  EXPECT_EQ(byte_of(std::numeric_limits<float>::infinity()), 255);
  EXPECT_EQ(byte_of(std::numeric_limits<float>::quiet_NaN()), 0);
  EXPECT_EQ(byte_of(-std::numeric_limits<float>::quiet_NaN()), 0);
}

}  // namespace delray::icet
