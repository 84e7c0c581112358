#include "composite/borrowed.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "comm/threads.h"
#include "composite/codec.h"
#include "composite/scheme.h"
#include "tests/support/guarded.h"

namespace delray::composite {
namespace {

using image::BasicImage;
using image::Rgba8;
using image::RgbaF;

Rgba8 random_colour(std::mt19937& random, Rgba8 /*type*/) {
  return {static_cast<std::uint8_t>(random()), static_cast<std::uint8_t>(random()), 3,
          static_cast<std::uint8_t>(random() % 3 * 100)};
}
RgbaF random_colour(std::mt19937& random, RgbaF /*type*/) {
  return {static_cast<float>(random() % 64) / 64, 0.5F, 0.25F,
          static_cast<float>(random() % 3) / 2};
}

// Pixels of a renderer: rows with gaps, some nearer than 1, some as deep or deeper, some NaN. No
// memory is behind the last pixel of the window.
template <class Colour>
struct Rendered {
  int width = 0, height = 0;
  test::Guarded<Colour> colour;
  test::Guarded<float> depth;
  BorrowedPixels<Colour> pixels;
};

template <class Colour>
Rendered<Colour> render(int width, int height, unsigned seed, bool without_colour = false) {
  std::mt19937 random(seed);
  const bool has_gaps = random() % 2 == 0;
  const int stride = has_gaps ? width + 1 + static_cast<int>(random() % 20) : width;
  const int before = has_gaps ? static_cast<int>(random() % 100) : 0;
  geometry::Rect window{0, 0, width, height};
  if (random() % 3 != 0) {
    const auto below = [&](int end) {
      return static_cast<int>(random() % static_cast<unsigned>(end + 1));
    };
    window = {below(width), below(height), width, height};
    window.x1 = window.x0 + below(width - window.x0);
    window.y1 = window.y0 + below(height - window.y0);
  }
  const int size = window.empty() ? 0 : before + stride * (window.y1 - 1) + window.x1;
  const auto pixels = static_cast<std::size_t>(size);
  Rendered<Colour> made{
      width, height, test::Guarded<Colour>(pixels), test::Guarded<float>(pixels), {}};
  for (std::size_t i = 0; i < pixels; ++i) {
    made.colour[i] = random_colour(random, Colour{});
    const float depths[] = {0.25F, 0.5F, 0.75F, 1, 2, std::numeric_limits<float>::quiet_NaN()};
    made.depth[i] = depths[random() % 6];
  }
  made.pixels = {
      without_colour ? nullptr : made.colour.data(), made.depth.data(), before, stride, window, 1};
  return made;
}

// The same pixels as a layer has them, by the definition.
template <class Colour>
BasicImage<Colour> copy_of(const Rendered<Colour>& from, Operator how) {
  BasicImage<Colour> image(from.width, from.height);
  clear(image);
  const BorrowedPixels<Colour>& pixels = from.pixels;
  std::fill_n(image.colour.data(), image.pixels(), pixels.background);
  for (int y = 0; y < from.height; ++y) {
    for (int x = 0; x < from.width; ++x) {
      const auto at = static_cast<std::size_t>(pixels.origin + y * pixels.stride + x);
      const bool covered = pixels.window.contains(x, y) &&
                           (how == Operator::nearest ? from.depth[at] < 1 : from.colour[at].a != 0);
      if (!covered) continue;
      const int pixel = y * from.width + x;
      const auto to = static_cast<std::size_t>(pixel);
      image.colour[to] = pixels.colour != nullptr ? from.colour[at] : Colour{};
      image.depth[to] = from.depth[at];
    }
  }
  return image;
}

bool same_bytes(const comm::Buffer& a, const comm::Buffer& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size()) == 0;
}

template <class Colour>
ImageLayer<Colour>& image_layer(Layer& layer) {
  return dynamic_cast<ImageLayer<Colour>&>(layer);
}

template <class Colour>
void expect_same_messages(Operator how, Colour background = {}) {
  std::mt19937 random(7);
  for (unsigned seed = 1; seed <= 60; ++seed) {
    const int width = 1 + static_cast<int>(random() % 300);
    const int height = 1 + static_cast<int>(random() % 120);
    auto front = render<Colour>(width, height, seed, seed % 7 == 0 && how != Operator::over);
    auto back = render<Colour>(width, height, seed + 1000);
    front.pixels.background = back.pixels.background = background;
    const Codec& active = *find_codec("active");
    const auto borrowed = make_borrowed(BasicImage<Colour>(width, height), front.pixels, how);
    const auto copied = active.make(copy_of(front, how), how);
    const auto other = active.make(copy_of(back, how), how);
    image_layer<Colour>(*copied).set_background(background);
    image_layer<Colour>(*other).set_background(background);
    EXPECT_EQ(borrowed->empty(), copied->empty()) << "seed " << seed;
    const auto random_range = [&] {
      const std::uint64_t pixels = borrowed->pixels();
      PixelRange range{random() % (pixels + 1), random() % (pixels + 1)};
      if (range.begin > range.end) std::swap(range.begin, range.end);
      return range;
    };
    const int steps = seed % 4 == 0 ? 1 : 12;  // after which all has been looked at mostly
    for (int step = 0; step < steps; ++step) {
      const PixelRange range = random_range();
      EXPECT_TRUE(same_bytes(borrowed->encode(range), copied->encode(range)))
          << "seed " << seed << ", step " << step;
      const comm::Buffer message = other->encode(range);
      switch (random() % 5) {
        case 0:
          EXPECT_EQ(borrowed->merge(range, message, Side::lower),
                    copied->merge(range, message, Side::lower));
          break;
        case 1:
          borrowed->merge(range, message, Side::higher);
          copied->merge(range, message, Side::higher);
          break;
        case 2:
          borrowed->replace(range, message);
          copied->replace(range, message);
          break;
        case 3:
          EXPECT_EQ(borrowed->prune(range, message), copied->prune(range, message));
          break;
        default:
          settle(*borrowed, range);
          settle(*copied, range);
      }
    }
    const PixelRange all{0, borrowed->pixels()}, some{all.end / 5, all.end / 2};
    const bool colours_alone = how == Operator::nearest && seed % 2 == 0;
    if (colours_alone) {
      const comm::Buffer with_depths = other->encode(some);
      for (Layer* const layer : {borrowed.get(), copied.get(), other.get()})
        image_layer<Colour>(*layer).forget_depth();
      for (int i = 0; i < 8; ++i) {
        const PixelRange range = random_range();
        EXPECT_TRUE(same_bytes(borrowed->encode(range), copied->encode(range))) << "seed " << seed;
      }
      const comm::Buffer message = other->encode(some);
      const float* const depths = image_layer<Colour>(*other).image().depth.data();
      const auto covered =
          some.size() - static_cast<std::uint64_t>(
                            std::count(depths + some.begin, depths + some.end, image::kEmptyDepth));
      EXPECT_EQ(with_depths.size() - message.size(), covered * sizeof(float));
      borrowed->replace(some, message);
      std::copy_n(image_layer<Colour>(*other).image().colour.data() + some.begin, some.size(),
                  image_layer<Colour>(*copied).image().colour.data() + some.begin);
    }
    settle(*borrowed, all);
    const auto& image = image_layer<Colour>(*borrowed).image();
    const auto& expected = image_layer<Colour>(*copied).image();
    EXPECT_TRUE(std::equal(image.colour.data(), image.colour.data() + image.pixels(),
                           expected.colour.data()))
        << "seed " << seed;
    if (how == Operator::over || colours_alone) continue;
    EXPECT_TRUE(
        std::equal(image.depth.data(), image.depth.data() + image.pixels(), expected.depth.data()))
        << "seed " << seed;
  }
}

}  // namespace

TEST(Borrowed, IsAsACopyIs) {
  expect_same_messages<Rgba8>(Operator::nearest);
  expect_same_messages<Rgba8>(Operator::over);
  expect_same_messages<RgbaF>(Operator::nearest);
  expect_same_messages<RgbaF>(Operator::over);
}

TEST(Borrowed, LeavesTheBackgroundWhereNothingIs) {
  expect_same_messages<Rgba8>(Operator::nearest, {1, 2, 3, 4});
  expect_same_messages<RgbaF>(Operator::nearest, {0.5F, 1, 2, 0});
}

// All of small images, of which no row ends where a vector does.
TEST(Borrowed, ReadsNothingBehindTheLastPixel) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    const int width = 1 + static_cast<int>(seed % 13), height = 1 + static_cast<int>(seed % 11);
    for (const Operator how : {Operator::nearest, Operator::over}) {
      const auto mine = render<Rgba8>(width, height, seed);
      const auto borrowed = make_borrowed(image::Image8(width, height), mine.pixels, how);
      const auto copied = find_codec("active")->make(copy_of(mine, how), how);
      const PixelRange all{0, borrowed->pixels()};
      EXPECT_TRUE(same_bytes(borrowed->encode(all), copied->encode(all))) << "seed " << seed;
    }
  }
}

TEST(Borrowed, EverySchemeGivesWhatItGivesOfCopies) {
  for (const int ranks : {1, 2, 3, 5, 8}) {
    for (const Scheme& scheme : schemes()) {
      for (const Operator how : {Operator::nearest, Operator::over}) {
        comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
          const auto mine = render<Rgba8>(67, 91, static_cast<unsigned>(communicator.rank()) + 5);
          const auto whole = [&](std::unique_ptr<Layer> layer) {
            OwnedPixels part = compose(communicator, std::move(layer), scheme.name,
                                       {.interlace = how == Operator::over});
            for (const PixelRange& range : part.ranges) settle(*part.layer, range);
            return take_image<Rgba8>(gather(communicator, std::move(part), 0));
          };
          const auto got = whole(make_borrowed(image::Image8(67, 91), mine.pixels, how));
          const auto expected = whole(find_codec("active")->make(copy_of(mine, how), how));
          if (communicator.rank() != 0) return;
          EXPECT_TRUE(std::equal(got.colour.data(), got.colour.data() + got.pixels(),
                                 expected.colour.data()))
              << scheme.name << ", " << ranks << " ranks";
          if (how == Operator::over) return;
          EXPECT_TRUE(
              std::equal(got.depth.data(), got.depth.data() + got.pixels(), expected.depth.data()))
              << scheme.name << ", " << ranks << " ranks";
        });
      }
    }
  }
}

}  // namespace delray::composite
