#include "composite/layers/active.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <functional>
#include <random>

#include "composite/dense.h"
#include "tests/support/targets.h"

namespace delray::composite {
namespace {

using image::BasicImage;
using image::Rgba8;
using image::RgbaF;

Rgba8 random_colour(std::mt19937& random, Rgba8 /*type*/) {
  return std::bit_cast<Rgba8>(static_cast<std::uint32_t>(random()));
}
RgbaF random_colour(std::mt19937& random, RgbaF /*type*/) {
  const auto value = static_cast<float>(random());
  return {value, value / 2, value / 3, 1};
}

// Pixels i of a picture that are covered, of some shape.
using Covered = std::function<bool(std::size_t i, std::mt19937& random)>;
struct Shape {
  const char* name;
  Covered covered;
};
std::vector<Shape> shapes() {
  const auto random_part = [](unsigned percent) {
    return [percent](std::size_t /*i*/, std::mt19937& random) { return random() % 100 < percent; };
  };
  return {{"nothing", random_part(0)},
          {"a few pixels", random_part(2)},
          {"half of the pixels", random_part(50)},
          {"all but a few pixels", random_part(98)},
          {"everything", random_part(100)},
          {"lines", [](std::size_t i, std::mt19937&) { return i / 77 % 3 == 1; }},
          {"blocks", [](std::size_t i, std::mt19937&) { return i / 5000 % 2 == 0; }}};
}

// Few depths, so that ties occur often.
template <class Colour>
BasicImage<Colour> picture(int pixels, const Covered& covered, unsigned seed) {
  std::mt19937 random(seed);
  BasicImage<Colour> image(pixels, 1);
  clear(image);
  for (std::size_t i = 0; i < image.pixels(); ++i) {
    if (!covered(i, random)) continue;
    image.colour[i] = random_colour(random, Colour{});
    image.depth[i] = static_cast<float>(random() % 3) - 1;
  }
  return image;
}

template <class Colour>
bool same(const BasicImage<Colour>& a, const BasicImage<Colour>& b) {
  return std::memcmp(a.colour.data(), b.colour.data(), a.pixels() * sizeof(Colour)) == 0 &&
         std::memcmp(a.depth.data(), b.depth.data(), a.pixels() * sizeof(float)) == 0;
}

template <class Colour>
std::uint64_t count_covered(const BasicImage<Colour>& image, PixelRange range) {
  return static_cast<std::uint64_t>(
      std::count_if(image.depth.data() + range.begin, image.depth.data() + range.end,
                    [](float depth) { return depth != image::kEmptyDepth; }));
}

template <class Colour>
class ActiveLayers : public testing::Test {};
using Colours = testing::Types<Rgba8, RgbaF>;
TYPED_TEST_SUITE(ActiveLayers, Colours);

template <class Colour>
BasicImage<Colour> copy(const BasicImage<Colour>& image) {
  BasicImage<Colour> result(image.width, image.height);
  std::copy_n(image.colour.data(), image.pixels(), result.colour.data());
  std::copy_n(image.depth.data(), image.pixels(), result.depth.data());
  return result;
}

// Merges and replaces `range` of `own` by what comes from `other`, in both codecs.
template <class Colour>
void expect_dense(const BasicImage<Colour>& own, const BasicImage<Colour>& other, PixelRange range,
                  Side side) {
  ActiveLayer<Colour> active(copy(own)), sender(copy(other));
  DenseLayer<Colour> dense(copy(own)), dense_sender(copy(other));
  const comm::Buffer sent = sender.encode(range), dense_sent = dense_sender.encode(range);
  const std::uint64_t covered = count_covered(other, range);
  const std::uint64_t groups = (range.size() + 4095) / 4096;
  EXPECT_LE(sent.size(),
            8 + 8 + groups * 24 + range.size() / 8 + covered * (sizeof(Colour) + sizeof(float)));
  if (covered == 0) {
    EXPECT_EQ(sent.size(), 8U);
  }
  if (covered == range.size()) {
    EXPECT_EQ(sent.size(), 8 + dense_sent.size());
  }
  EXPECT_EQ(active.merge(range, sent, side), covered);
  dense.merge(range, dense_sent, side);
  ASSERT_TRUE(same(active.image(), dense.image())) << "merged";
  ActiveLayer<Colour> third(copy(own));  // takes coverage that has grown
  third.replace(range, active.encode(range));
  ASSERT_TRUE(same(third.image(), active.image())) << "replaced by a merged one";
  active.replace(range, sent);
  dense.replace(range, dense_sent);
  ASSERT_TRUE(same(active.image(), dense.image())) << "replaced";
}

TYPED_TEST(ActiveLayers, LeaveTheBytesThatDenseOnesLeave) {
  constexpr int kPixels = 9001;
  constexpr PixelRange kRanges[] = {{0, kPixels}, {13, 8205}, {100, 163}, {77, 78}, {500, 500}};
  const std::vector<Shape> all = shapes(), few = {all[0], all[2], all[4]};
  std::vector<BasicImage<TypeParam>> own, other;
  for (const Shape& shape : few) own.push_back(picture<TypeParam>(kPixels, shape.covered, 1));
  for (const Shape& shape : all) other.push_back(picture<TypeParam>(kPixels, shape.covered, 2));
  tests::for_each_target([&] {
    for (std::size_t i = 0; i < own.size(); ++i) {
      for (std::size_t k = 0; k < other.size(); ++k) {
        for (const PixelRange& range : kRanges) {
          SCOPED_TRACE(std::string(all[k].name) + " onto " + few[i].name + " from " +
                       std::to_string(range.begin) + " to " + std::to_string(range.end));
          expect_dense(own[i], other[k], range, Side::lower);
          expect_dense(own[i], other[k], range, Side::higher);
        }
      }
    }
  });
}

template <class Colour>
ShownBlocks shown_in(const BasicImage<Colour>& image) {
  ShownBlocks shown(image.pixels());
  for (std::size_t i = 0; i < image.pixels(); ++i)
    if (image.depth[i] != image::kEmptyDepth) shown.add(i, 1);
  return shown;
}

// Layers that know what may be shown do the same, and know it afterwards.
TYPED_TEST(ActiveLayers, NeedNotLookAtWhatIsKnownToBeClear) {
  constexpr int kPixels = 9001;
  constexpr PixelRange kRanges[] = {{0, kPixels}, {13, 8205}, {4096, 8192}, {8999, 9001}};
  const std::vector<Shape> all = shapes();
  for (const Shape& mine : all) {
    const BasicImage<TypeParam> own = picture<TypeParam>(kPixels, mine.covered, 1);
    for (const Shape& others : all) {
      const BasicImage<TypeParam> other = picture<TypeParam>(kPixels, others.covered, 2);
      for (const PixelRange& range : kRanges) {
        SCOPED_TRACE(std::string(others.name) + " onto " + mine.name);
        ActiveLayer<TypeParam> plain(copy(own)), knowing(copy(own)), sender(copy(other));
        knowing.set_shown(shown_in(own));
        const comm::Buffer sent = sender.encode(range);
        for (int step = 0; step < 3; ++step) {
          const comm::Buffer a = plain.encode(range), b = knowing.encode(range);
          ASSERT_TRUE(std::ranges::equal(a.as<std::byte>(), b.as<std::byte>())) << step;
          ASSERT_EQ(knowing.empty(), plain.empty());
          if (step == 0) {
            plain.merge(range, sent, Side::higher), knowing.merge(range, sent, Side::higher);
          } else if (step == 1) {
            plain.replace(range, sent), knowing.replace(range, sent);
          }
          ASSERT_TRUE(same(plain.image(), knowing.image())) << step;
        }
        const ShownBlocks shown = knowing.take_shown();
        for (std::size_t i = 0; i < kPixels; ++i) {
          if (plain.image().depth[i] != image::kEmptyDepth) {
            ASSERT_TRUE(shown.any(i, 1)) << i;
          }
        }
      }
    }
  }
}

TEST(ShownBlocks, AreOfSixtyFourPixels) {
  EXPECT_FALSE(ShownBlocks().is_known());
  ShownBlocks shown(1000);
  EXPECT_TRUE(shown.is_known());
  EXPECT_FALSE(shown.any(0, 1000));
  shown.add(130, 1);
  EXPECT_TRUE(shown.any(128, 1));
  EXPECT_TRUE(shown.any(0, 129));
  EXPECT_FALSE(shown.any(0, 128));
  EXPECT_FALSE(shown.any(192, 808));
  shown.add(255, 2);
  EXPECT_TRUE(shown.any(192, 1));
  EXPECT_TRUE(shown.any(300, 64));
  EXPECT_FALSE(shown.any(320, 1000 - 320));
  GroupMask mask{};
  mask[1] = 1;
  shown.add(500, mask);
  EXPECT_TRUE(shown.any(564, 1));
  EXPECT_FALSE(shown.any(500, 12));
}

TYPED_TEST(ActiveLayers, AreEmptyWhenNothingIsCovered) {
  BasicImage<TypeParam> image(100, 100);
  clear(image);
  ActiveLayer<TypeParam> layer(std::move(image));
  EXPECT_TRUE(layer.empty());
  layer.image().depth[9999] = 1e30F;
  EXPECT_FALSE(layer.empty());
  EXPECT_TRUE(ActiveLayer<TypeParam>(BasicImage<TypeParam>(0, 7)).empty());
}

}  // namespace
}  // namespace delray::composite
