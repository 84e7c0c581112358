#include "composite/tiles.h"

#include <gtest/gtest.h>

#include "comm/simulated.h"
#include "composite/dense.h"

namespace delray::composite {
namespace {

using image::Image8;

constexpr int kRanks = 3, kWidth = 4, kHeight = 3;
constexpr comm::Tag kTagGo = 7;

// Depths and colours that tell who drew them in which frame.
Image8 drawn_by(int rank, int frame) {
  Image8 image(kWidth, kHeight);
  for (int i = 0; i < kWidth * kHeight; ++i) {
    image.colour[static_cast<std::size_t>(i)] = {static_cast<std::uint8_t>(rank),
                                                 static_cast<std::uint8_t>(frame),
                                                 static_cast<std::uint8_t>(i), 255};
    image.depth[static_cast<std::size_t>(i)] = static_cast<float>((i + 2 * rank + frame) % kRanks);
  }
  return image;
}

void expect_nearest(const OwnedPixels& part, int frame) {
  const Image8& image = dynamic_cast<const ImageLayer<image::Rgba8>&>(*part.layer).image();
  ASSERT_FALSE(part.ranges.empty());
  for (const PixelRange& range : part.ranges) {
    for (std::size_t i = range.begin; i < range.end; ++i) {
      Image8 nearest = drawn_by(0, frame);
      for (int rank = 1; rank < kRanks; ++rank) {
        const Image8 other = drawn_by(rank, frame);
        if (other.depth[i] < nearest.depth[i]) nearest = drawn_by(rank, frame);
      }
      EXPECT_EQ(image.colour[i], nearest.colour[i]) << "frame " << frame << ", pixel " << i;
      EXPECT_EQ(image.depth[i], nearest.depth[i]);
    }
  }
}

// A rank that is done speaks of the next frame's tiles to one that still waits for a third.
TEST(Tiles, OfTheNextFrameWaitForThoseOfThisOne) {
  comm::run_simulated(kRanks, {}, 1, [](comm::Communicator& communicator) {
    const int rank = communicator.rank();
    for (int frame = 0; frame < 4; ++frame) {
      TileCompositor compositor(communicator, make_dense(drawn_by(rank, frame)), {});
      ASSERT_EQ(compositor.tiles(), kRanks);
      const bool all_have_pixels = frame % 2 == 0;
      const auto hand_over = [&](int tile) {
        all_have_pixels || rank != 2 ? compositor.drawn(tile) : compositor.nothing_in(tile);
      };
      hand_over(2);
      hand_over(0);
      // Rank 2 lets rank 1 wait for its last tile of the first frame until rank 0 has spoken of the
      // second one; and so on.
      if (rank == 2 && frame < 3) communicator.receive(0, kTagGo);
      hand_over(1);
      if (rank == 0 && frame > 0) communicator.send(2, kTagGo, comm::Buffer());
      const OwnedPixels part = compositor.finish();
      if (all_have_pixels) expect_nearest(part, frame);
    }
  });
}

}  // namespace
}  // namespace delray::composite
