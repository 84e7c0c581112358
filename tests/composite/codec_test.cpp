// Every codec leaves what dense layers leave, whatever happens to the pixels.
#include "composite/codec.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <random>
#include <string>
#include <utility>

#include "image/image.h"
#include "tests/support/targets.h"

namespace delray::composite {
namespace {

using image::BasicImage;
using image::Rgba8;
using image::RgbaF;

// Premultiplied; every third is opaque.
void set_random(std::mt19937& random, Rgba8& colour) {
  const unsigned alpha = random() % 3 == 0 ? 255 : 1 + random() % 254;
  const auto channel = [&] { return static_cast<std::uint8_t>(random() % (alpha + 1)); };
  colour = {channel(), channel(), channel(), static_cast<std::uint8_t>(alpha)};
}
void set_random(std::mt19937& random, RgbaF& colour) {
  const float alpha = random() % 3 == 0 ? 1 : static_cast<float>(1 + random() % 255) / 256;
  const auto channel = [&] { return static_cast<float>(random() % 256) / 256 * alpha; };
  colour = {channel(), channel(), channel(), alpha};
}

constexpr Operator kOperators[] = {Operator::nearest, Operator::over, Operator::over_with_depth};

enum class Shape { nothing, dots, half, rectangle, lines, everything };
constexpr Shape kShapes[] = {Shape::nothing,   Shape::dots,  Shape::half,
                             Shape::rectangle, Shape::lines, Shape::everything};

bool covers(Shape shape, int x, int y, std::mt19937& random) {
  switch (shape) {
    case Shape::nothing:
      return false;
    case Shape::dots:
      return random() % 100 == 0;
    case Shape::half:
      return random() % 2 == 0;
    case Shape::rectangle:
      return x > 20 && x < 90 && y > 10 && y < 60;
    case Shape::lines:
      return y / 3 % 2 == 0;
    case Shape::everything:
      return true;
  }
  return false;
}

template <class Colour>
BasicImage<Colour> picture(int width, int height, Shape shape, unsigned seed) {
  BasicImage<Colour> image(width, height);
  clear(image);
  std::mt19937 random(seed);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (!covers(shape, x, y, random)) continue;
      const std::size_t i = static_cast<std::size_t>(y * width + x);
      set_random(random, image.colour[i]);
      image.depth[i] = static_cast<float>(random() % 8);
    }
  }
  return image;
}

// A copy of what picture() gives of 113 x 79 pixels.
constexpr int kWidth = 113, kHeight = 79;
template <class Colour>
BasicImage<Colour> kept_picture(Shape shape, unsigned seed) {
  static std::map<std::pair<Shape, unsigned>, BasicImage<Colour>> kept;
  BasicImage<Colour>& image = kept[{shape, seed}];
  if (image.pixels() == 0) image = picture<Colour>(kWidth, kHeight, shape, seed);
  BasicImage<Colour> copy(kWidth, kHeight);
  std::copy_n(image.colour.data(), image.pixels(), copy.colour.data());
  std::copy_n(image.depth.data(), image.pixels(), copy.depth.data());
  return copy;
}

template <class Colour>
bool same(const Layer& a, const Layer& b) {
  const auto& first = dynamic_cast<const ImageLayer<Colour>&>(a).image();
  const auto& second = dynamic_cast<const ImageLayer<Colour>&>(b).image();
  return std::memcmp(first.colour.data(), second.colour.data(), first.pixels() * sizeof(Colour)) ==
             0 &&
         std::memcmp(first.depth.data(), second.depth.data(), first.pixels() * sizeof(float)) == 0;
}

template <class Colour>
class Codecs : public ::testing::Test {};
using Colours = ::testing::Types<Rgba8, RgbaF>;
TYPED_TEST_SUITE(Codecs, Colours);

template <class Colour>
void expect_dense(const Codec& codec, Operator how, Shape own, Shape other, PixelRange range) {
  const auto make = [&](const Codec& by, Shape shape, unsigned seed) {
    return by.make(kept_picture<Colour>(shape, seed), how);
  };
  const Codec& dense = *find_codec("dense");
  const comm::Buffer message = make(codec, other, 2)->encode(range);
  const comm::Buffer dense_message = make(dense, other, 2)->encode(range);
  const auto expect = [&](const char* what, auto&& act) {
    const auto layer = make(codec, own, 1), expected = make(dense, own, 1);
    act(*layer, message);
    act(*expected, dense_message);
    EXPECT_TRUE(same<Colour>(*layer, *expected)) << what;
    EXPECT_EQ(layer->empty(), expected->empty()) << what;
    // What it has become travels as well.
    const auto third = make(codec, own, 3), fourth = make(dense, own, 3);
    third->replace(range, layer->encode(range));
    fourth->replace(range, expected->encode(range));
    EXPECT_TRUE(same<Colour>(*third, *fourth)) << what << ", then cut";
  };
  expect("merged from a lower rank", [&](Layer& layer, const comm::Buffer& pixels) {
    layer.merge(range, pixels, Side::lower);
  });
  expect("merged from a higher rank", [&](Layer& layer, const comm::Buffer& pixels) {
    layer.merge(range, pixels, Side::higher);
  });
  expect("replaced",
         [&](Layer& layer, const comm::Buffer& pixels) { layer.replace(range, pixels); });
  expect("pruned", [&](Layer& layer, const comm::Buffer& pixels) { layer.prune(range, pixels); });
}

TYPED_TEST(Codecs, LeaveTheBytesThatDenseOnesLeave) {
  constexpr PixelRange kRanges[] = {{0, 8927}, {57, 5000}, {300, 301}, {226, 339}, {9, 9}};
  tests::for_each_target([&] {
    for (const Codec& codec : codecs()) {
      for (const Operator how : kOperators) {
        for (const Shape other : kShapes) {
          for (const PixelRange range : kRanges) {
            SCOPED_TRACE(std::string(codec.name) + ", operator " +
                         std::to_string(static_cast<int>(how)) + ", shape " +
                         std::to_string(static_cast<int>(other)) + " from " +
                         std::to_string(range.begin) + " to " + std::to_string(range.end));
            expect_dense<TypeParam>(codec, how, Shape::half, other, range);
            if (range.begin == 0) {
              expect_dense<TypeParam>(codec, how, Shape::rectangle, other, range);
            }
          }
        }
      }
    }
  });
}

// Whoever is merged after pruning leaves what he would have left before.
TYPED_TEST(Codecs, PruneOnlyWhatIsHidden) {
  const PixelRange all{0, kWidth * kHeight};
  for (const Codec& codec : codecs()) {
    for (const Operator how : kOperators) {
      SCOPED_TRACE(codec.name);
      const auto front = codec.make(kept_picture<TypeParam>(Shape::half, 1), how);
      const auto whole = codec.make(kept_picture<TypeParam>(Shape::half, 1), how);
      const auto back = codec.make(kept_picture<TypeParam>(Shape::half, 2), how);
      const comm::Buffer unpruned = back->encode(all);
      back->prune(all, front->encode(all));
      const comm::Buffer pruned = back->encode(all);
      whole->merge(all, unpruned, Side::higher);
      front->merge(all, pruned, Side::higher);
      EXPECT_TRUE(same<TypeParam>(*front, *whole));
      if (std::strcmp(codec.name, "active") == 0) {
        EXPECT_LT(pruned.size(), unpruned.size());
      }
    }
  }
}

TEST(CodecTable, SendsWhatItPromises) {
  const auto bytes = [](const char* codec, Shape shape, Operator how) {
    return find_codec(codec)
        ->make(picture<Rgba8>(400, 300, shape, 1), how)
        ->encode({0, 120000})
        .size();
  };
  EXPECT_EQ(bytes("dense", Shape::dots, Operator::nearest), 960000U);
  EXPECT_EQ(bytes("dense", Shape::dots, Operator::over), 480000U);
  EXPECT_EQ(bytes("dense", Shape::dots, Operator::over_with_depth), 960000U);
  EXPECT_EQ(bytes("active", Shape::nothing, Operator::over), 8U);
  EXPECT_EQ(bytes("active", Shape::everything, Operator::over), 480008U);
  EXPECT_EQ(bytes("bounds", Shape::rectangle, Operator::nearest), 16U + 69 * 49 * 8);
  EXPECT_EQ(bytes("bounds", Shape::nothing, Operator::nearest), 16U);
  EXPECT_LT(bytes("lz4", Shape::half, Operator::nearest),
            bytes("active", Shape::half, Operator::nearest));
}

TEST(CodecTable, AreFoundByName) {
  for (const Codec& codec : codecs()) EXPECT_EQ(find_codec(codec.name), &codec);
  for (const char* name : {"dense", "active", "bounds", "lz4"}) {
    EXPECT_NE(find_codec(name), nullptr) << name;
  }
  EXPECT_EQ(find_codec("nonsense"), nullptr);
}

}  // namespace
}  // namespace delray::composite
