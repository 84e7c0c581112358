#include "composite/compose_images.h"

#include <gtest/gtest.h>

#include <vector>

#include "comm/threads.h"

namespace delray::composite {
namespace {

using image::Image8;
using image::Rgba8;

// Of others, whose empty depth is 1: rank k covers every pixel that k + 1 divides.
TEST(ComposeImages, MergesBuffersOfTheCaller) {
  constexpr int kWidth = 90, kHeight = 70, kRanks = 4;
  comm::run_threads(kRanks, 1, [&](comm::Communicator& communicator) {
    const auto k = static_cast<std::size_t>(communicator.rank());
    std::vector<Rgba8> colour(kWidth * kHeight, Rgba8{1, 2, 3, 255});
    std::vector<float> depth(colour.size(), 1);
    for (std::size_t i = 0; i < colour.size(); i += k + 1) {
      colour[i] = {static_cast<std::uint8_t>(k), 0, 0, 255};
      depth[i] = 0.9F - static_cast<float>(k) / 8;
    }
    const ImageBuffers<Rgba8> buffers{kWidth, kHeight, colour.data(), depth.data()};
    const Image8 image = compose_images(communicator, buffers, 1.0F, {.root = 2});
    if (communicator.rank() != 2) {
      EXPECT_EQ(image.pixels(), 0U);
      return;
    }
    ASSERT_EQ(image.pixels(), colour.size());
    for (std::size_t i = 0; i < image.pixels(); ++i) {
      std::size_t nearest = kRanks - 1;
      while (i % (nearest + 1) != 0) --nearest;
      EXPECT_EQ(image.colour[i], (Rgba8{static_cast<std::uint8_t>(nearest), 0, 0, 255}));
    }
  });
}

TEST(ComposeImages, BlendsBuffersWithoutDepth) {
  comm::run_threads(3, 1, [&](comm::Communicator& communicator) {
    const auto k = static_cast<std::uint8_t>(communicator.rank());
    const std::vector<Rgba8> colour = {{k, 0, 0, 255}, k == 1 ? Rgba8{9, 9, 9, 255} : Rgba8{}, {}};
    const ImageBuffers<Rgba8> buffers{3, 1, colour.data(), nullptr};
    const Image8 image = compose_images(communicator, buffers, 1.0F, {.how = Operator::over});
    if (communicator.rank() != 0) return;
    EXPECT_EQ(image.colour[0], (Rgba8{0, 0, 0, 255}));
    EXPECT_EQ(image.colour[1], (Rgba8{9, 9, 9, 255}));
    EXPECT_EQ(image.colour[2], Rgba8{});
  });
}

}  // namespace
}  // namespace delray::composite
