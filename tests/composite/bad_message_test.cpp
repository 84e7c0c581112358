// Messages that no layer can have cut are refused, whatever is wrong with them.
#include "comm/bad_message.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "composite/codec.h"
#include "composite/deep.h"

namespace delray::composite {
namespace {

constexpr int kWidth = 90, kHeight = 60;  // a group of pixels and part of another
constexpr PixelRange kAll{0, kWidth* kHeight};

image::Image8 picture(bool filled) {
  image::Image8 result(kWidth, kHeight);
  clear(result);
  for (std::size_t i = 700; filled && i < 3000; i += i % 90 < 40 ? 1 : 7) {
    result.colour[i] = {1, 2, 3, 255};
    result.depth[i] = static_cast<float>(i);
  }
  return result;
}

// Merges, or refuses what it is given.
bool is_merged(Layer& layer, const comm::Buffer& message) {
  try {
    layer.merge(kAll, message, Side::higher);
    return true;
  } catch (const comm::BadMessage&) {
    return false;
  }
}

comm::Buffer shortened(const comm::Buffer& message, std::size_t size) {
  return comm::Buffer::of(std::span<const std::byte>(message.data(), size));
}

TEST(BadMessage, OfAnyLayerIsRefusedOrHarmless) {
  std::mt19937 random(7);
  for (const auto& codec : codecs()) {
    SCOPED_TRACE(codec.name);
    const comm::Buffer good = codec.make(picture(true), Operator::nearest)->encode(kAll);
    const auto layer = codec.make(picture(false), Operator::nearest);
    EXPECT_TRUE(is_merged(*layer, good));
    for (const std::size_t size :
         {std::size_t{0}, std::size_t{7}, good.size() / 2, good.size() - 1}) {
      EXPECT_FALSE(is_merged(*layer, shortened(good, size))) << size;
    }
    for (int i = 0; i < 500; ++i) {
      comm::Buffer bad = good.copy();
      const std::size_t at = random() % std::min<std::size_t>(bad.size(), i % 2 == 0 ? 64 : 4096);
      bad.data()[at] ^= static_cast<std::byte>(1U << random() % 8);
      is_merged(*layer, bad);  // a colour may be another, memory may not be somebody else's
    }
  }
}

TEST(BadMessage, OfDeepLayersIsRefused) {
  DeepImage<image::RgbaF> image(kWidth, kHeight);
  Fragment fragment{{.1F, .2F, .3F, .5F}, 1.0F, 7, 0};
  image.set(5, {&fragment, 1});
  const auto full = make_deep(std::move(image));
  const auto layer = make_deep(DeepImage<image::RgbaF>(kWidth, kHeight));
  const comm::Buffer good = full->encode(kAll);
  EXPECT_TRUE(is_merged(*layer, good));
  EXPECT_FALSE(is_merged(*layer, shortened(good, good.size() - sizeof fragment)));
  comm::Buffer bad = good.copy();
  const std::uint32_t many = 0xFFFFFFFFU;
  std::memcpy(bad.data() + bad.size() - sizeof fragment - sizeof many, &many, sizeof many);
  EXPECT_FALSE(is_merged(*layer, bad));
}

}  // namespace
}  // namespace delray::composite
