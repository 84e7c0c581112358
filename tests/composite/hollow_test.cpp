#include "composite/hollow.h"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "comm/recording.h"
#include "comm/simulated.h"
#include "composite/codec.h"
#include "composite/scheme.h"
#include "image/image.h"

namespace delray::composite {
namespace {

using image::Image8;

struct Size {
  int width, height;
};

// A disc, a few pixels at random, everything or nothing.
Image8 partial_image(int rank, Size size) {
  Image8 image(size.width, size.height);
  clear(image);
  std::mt19937 random(77U + static_cast<unsigned>(rank));
  const int kind = static_cast<int>(random() % 8);
  const int x = static_cast<int>(random()) % (size.width + 1);
  const int y = static_cast<int>(random()) % (size.height + 1);
  for (int i = 0; i < size.width * size.height; ++i) {
    const int dx = i % size.width - x, dy = i / size.width - y;
    const bool in_disc = dx * dx + dy * dy < size.width * size.height / 6;
    const bool covered = kind == 0   ? false
                         : kind == 1 ? true
                         : kind == 2 ? random() % 20 == 0
                                     : in_disc;
    if (!covered) continue;
    image.colour[static_cast<std::size_t>(i)] = {1, 2, 3, 255};
    image.depth[static_cast<std::size_t>(i)] = static_cast<float>(random() % 5);
  }
  return image;
}

using MakeLayer = std::function<std::unique_ptr<Layer>(int rank)>;

// Of all ranks, while they composite and gather.
std::vector<comm::Tally> counts_of(const Scheme& scheme, int ranks, const MakeLayer& make) {
  std::vector<comm::Tally> result;
  for (int rank = 0; rank < ranks; ++rank) result.emplace_back(rank);
  comm::run_simulated(ranks, {}, 1, [&](comm::Communicator& communicator) {
    const int rank = communicator.rank();
    comm::Recording recording(communicator, result[static_cast<std::size_t>(rank)]);
    gather(recording, compose(recording, make(rank), scheme.name), 0);
  });
  return result;
}

void expect_equal(const comm::Totals& a, const comm::Totals& b) {
  EXPECT_EQ(a.bytes_sent, b.bytes_sent);
  EXPECT_EQ(a.bytes_received, b.bytes_received);
  EXPECT_EQ(a.messages_sent, b.messages_sent);
  EXPECT_EQ(a.messages_received, b.messages_received);
  EXPECT_EQ(a.rounds, b.rounds);
  EXPECT_EQ(a.work, b.work);
}

TEST(HollowLayers, CountWhatRealOnesDo) {
  for (const int ranks : {1, 2, 3, 4, 5, 6, 7, 8, 9, 13, 16, 17, 64}) {
    for (const Size size : {Size{1, 1}, Size{7, 3}, ranks < 10 ? Size{149, 127} : Size{97, 61}}) {
      std::vector<ImageMasks> masks;
      MaskMaker maker;
      for (int rank = 0; rank < ranks; ++rank) {
        masks.push_back(maker.add(partial_image(rank, size).depth.span()));
      }
      const std::uint64_t pixels = masks[0].covered.pixels();
      for (const Scheme& scheme : schemes()) {
        for (const std::string codec : {"dense", "active"}) {
          SCOPED_TRACE(scheme.name + (", " + codec) + ", " + std::to_string(ranks) + " ranks, " +
                       std::to_string(size.width) + " x " + std::to_string(size.height));
          const auto real = counts_of(scheme, ranks, [&](int rank) {
            return find_codec(codec)->make(partial_image(rank, size));
          });
          const auto hollow = counts_of(scheme, ranks, [&](int rank) {
            ImageMasks& image = masks[static_cast<std::size_t>(rank)];
            return codec == "dense" ? make_hollow_dense(pixels, kPixelBytes8, image.covered.empty())
                                    : make_hollow_active(image.copy(), kPixelBytes8);
          });
          for (int rank = 0; rank < ranks; ++rank) {
            SCOPED_TRACE("rank " + std::to_string(rank));
            for (const comm::Phase phase : {comm::Phase::compose, comm::Phase::gather}) {
              const auto i = static_cast<std::size_t>(rank);
              expect_equal(real[i].totals(phase), hollow[i].totals(phase));
            }
          }
          ASSERT_FALSE(::testing::Test::HasFailure());
        }
      }
    }
  }
}

TEST(HollowLayers, TakeTheTimeThatTheirCostsSay) {
  const auto finished = comm::run_simulated(2, {}, 1, [](comm::Communicator& communicator) {
    LayerClock clock{&communicator, {}};
    clock.costs = {.cut = 1,
                   .cut_pixel = 0.5,
                   .cut_byte = 0.25,
                   .merge = 1000,
                   .merge_pixel = 7,
                   .merge_covered = 1e9};
    const auto layer = make_hollow_dense(100, kPixelBytes8, false, clock);
    const comm::Buffer message = layer->cut({10, 20});
    if (communicator.rank() == 1) {
      EXPECT_EQ(layer->merge({10, 20}, message, Side::lower), 10U);
    }
  });
  EXPECT_NEAR(finished[0], 1 + 5 + 20, 1e-9);
  EXPECT_NEAR(finished[1], 1 + 5 + 20 + 1000 + 70, 1e-9);
}

}  // namespace
}  // namespace delray::composite
