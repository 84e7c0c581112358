#include "composite/metadata_only.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <random>
#include <string>
#include <type_traits>
#include <vector>

#include "comm/recording.h"
#include "comm/simulated.h"
#include "composite/codec.h"
#include "composite/deep.h"
#include "composite/scheme.h"
#include "image/image.h"

namespace delray::composite {
namespace {

using image::Image8;
using image::ImageF;

struct Size {
  int width, height;
};

// A disc, a few pixels at random, everything or nothing; opaque or not.
template <class Image>
Image partial_image(int rank, Size size) {
  Image image(size.width, size.height);
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
    auto& colour = image.colour[static_cast<std::size_t>(i)];
    colour.g = 1;
    colour.a = 1;
    if (std::is_same_v<Image, Image8>) colour.a = random() % 3 == 0 ? 255 : 2;
    image.depth[static_cast<std::size_t>(i)] = static_cast<float>(random() % 5);
  }
  return image;
}

using MakeLayer = std::function<std::unique_ptr<Layer>(int rank)>;

// Of all ranks, while they composite and gather.
std::vector<comm::Tally> counts_of(const Scheme& scheme, int ranks, const ComposeOptions& options,
                                   const MakeLayer& make) {
  std::vector<comm::Tally> result;
  result.reserve(static_cast<std::size_t>(ranks));
  for (int rank = 0; rank < ranks; ++rank) result.emplace_back(rank);
  comm::run_simulated(ranks, {}, 1, [&](comm::Communicator& communicator) {
    const int rank = communicator.rank();
    comm::Recording recording(communicator, result[static_cast<std::size_t>(rank)]);
    gather(recording, compose(recording, make(rank), scheme.name, options), 0);
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

void expect_equal_counts(const std::vector<comm::Tally>& real,
                         const std::vector<comm::Tally>& metadata_only) {
  for (std::size_t rank = 0; rank < real.size(); ++rank) {
    SCOPED_TRACE("rank " + std::to_string(rank));
    for (const comm::Phase phase : {comm::Phase::compose, comm::Phase::gather}) {
      expect_equal(real[rank].totals(phase), metadata_only[rank].totals(phase));
    }
  }
}

// What a picture is made of, and how.
struct Case {
  const char* name;
  Operator how;
  bool is_float, interlace, backwards;
  std::size_t pixel_bytes;
};
constexpr std::array kCases = {
    Case{"nearest", Operator::nearest, false, false, false, kPixelBytes8},
    Case{"nearest, interlaced", Operator::nearest, false, true, false, kPixelBytes8},
    Case{"over", Operator::over, false, false, false, kColourBytes8},
    Case{"nearest, float", Operator::nearest, true, false, false, kPixelBytesF},
    Case{"over, backwards, interlaced", Operator::over, false, true, true, kColourBytes8},
    Case{"over, float, backwards", Operator::over, true, false, true, kColourBytesF},
    Case{"over with depth", Operator::over_with_depth, false, false, true, kPixelBytes8},
};

template <class Image>
void compare(const Scheme& scheme, const std::string& codec, const Case& c, int ranks, Size size) {
  SCOPED_TRACE(scheme.name + (", " + codec) + ", " + c.name + ", " + std::to_string(ranks) +
               " ranks, " + std::to_string(size.width) + " x " + std::to_string(size.height));
  ComposeOptions options;
  options.interlace = c.interlace;
  std::vector<int> order(static_cast<std::size_t>(ranks));
  std::iota(order.begin(), order.end(), 0);
  if (c.backwards) std::reverse(order.begin(), order.end());
  if (c.backwards) options.order = order;
  std::map<int, ImageMasks> masks;
  MaskMaker maker;
  for (const int rank : order) {
    masks.emplace(rank, maker.add(partial_image<Image>(rank, size), c.how));
  }
  const auto real = counts_of(scheme, ranks, options, [&](int rank) {
    return find_codec(codec)->make(partial_image<Image>(rank, size), c.how);
  });
  const auto metadata_only = counts_of(scheme, ranks, options, [&](int rank) {
    ImageMasks& image = masks.at(rank);
    switch (*metadata_only_of(codec)) {
      case MetadataOnly::dense:
        return make_metadata_only_dense(image.covered.pixels(), c.pixel_bytes,
                                        image.covered.empty());
      case MetadataOnly::bounds:
        return make_metadata_only_bounds(image.copy(), static_cast<std::uint64_t>(size.width),
                                         c.pixel_bytes);
      case MetadataOnly::active:
      case MetadataOnly::deep:
        break;
    }
    return make_metadata_only_active(image.copy(), c.pixel_bytes);
  });
  expect_equal_counts(real, metadata_only);
}

TEST(MetadataOnlyLayers, CountWhatRealOnesDo) {
  std::size_t turn = 0;
  for (const int ranks : {1, 2, 3, 4, 5, 6, 7, 8, 9, 13, 16, 17, 64}) {
    for (const Size size : {Size{1, 1}, Size{7, 3}, ranks < 10 ? Size{149, 127} : Size{97, 61}}) {
      for (const Scheme& scheme : schemes()) {
        for (const char* codec : {"dense", "bounds", "active"}) {
          const Case& c = kCases[turn++ % kCases.size()];
          if (c.is_float) {
            compare<ImageF>(scheme, codec, c, ranks, size);
          } else {
            compare<Image8>(scheme, codec, c, ranks, size);
          }
          ASSERT_FALSE(::testing::Test::HasFailure());
        }
      }
    }
  }
}

// Up to three surfaces at a pixel of a part of the image, of few depths, some of them opaque.
DeepImage<image::RgbaF> deep_image(int rank, int ranks, Size size) {
  DeepImage<image::RgbaF> image(size.width, size.height);
  std::mt19937 random(55U + static_cast<unsigned>(rank));
  const bool empty = random() % 5 == 0;
  const std::size_t pixels = image.lists.size(), begin = random() % (pixels + 1);
  for (std::size_t i = begin; i < pixels && !empty; ++i) {
    std::vector<Fragment> list;
    for (unsigned k = random() % 4; k > 0; --k) {
      const auto primitive = static_cast<std::uint32_t>((random() % 9 * 4 + k) * ranks + rank);
      list.push_back({{0, 0, 0, random() % 3 == 0 ? 1.0F : 0.5F},
                      static_cast<float>(random() % 3),
                      primitive,
                      primitive % 2});
    }
    if (!list.empty()) image.set(i, list);
  }
  return image;
}

TEST(MetadataOnlyLayers, CountWhatDeepOnesDo) {
  bool interlace = false;
  for (const int ranks : {1, 2, 3, 5, 8, 13, 31}) {
    for (const Size size : {Size{1, 1}, Size{7, 3}, Size{97, 61}}) {
      for (const Scheme& scheme : schemes()) {
        SCOPED_TRACE(scheme.name + (", " + std::to_string(ranks)) + " ranks, " +
                     std::to_string(size.width) + " x " + std::to_string(size.height));
        interlace = !interlace;
        const ComposeOptions options{.interlace = interlace};
        const auto real = counts_of(scheme, ranks, options, [&](int rank) {
          return make_deep(deep_image(rank, ranks, size));
        });
        const auto metadata_only = counts_of(scheme, ranks, options, [&](int rank) {
          return make_metadata_only_deep(DeepShape(deep_image(rank, ranks, size)));
        });
        expect_equal_counts(real, metadata_only);
        ASSERT_FALSE(::testing::Test::HasFailure());
      }
    }
  }
}

TEST(MetadataOnlyLayers, TakeTheTimeThatTheirCostsSay) {
  const auto finished = comm::run_simulated(2, {}, 1, [](comm::Communicator& communicator) {
    LayerClock clock{&communicator, {}};
    clock.costs = {.encode = 1,
                   .encode_pixel = 0.5,
                   .encode_byte = 0.25,
                   .merge = 1000,
                   .merge_pixel = 7,
                   .merge_covered = 1e9};
    const auto layer = make_metadata_only_dense(100, kPixelBytes8, false, clock);
    const comm::Buffer message = layer->encode({10, 20});
    if (communicator.rank() == 1) {
      EXPECT_EQ(layer->merge({10, 20}, message, Side::lower), 10U);
    }
  });
  EXPECT_NEAR(finished[0], 1 + 5 + 20, 1e-9);
  EXPECT_NEAR(finished[1], 1 + 5 + 20 + 1000 + 70, 1e-9);
}

}  // namespace
}  // namespace delray::composite
