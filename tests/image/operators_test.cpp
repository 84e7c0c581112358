#include "image/operators.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <vector>

#include "tests/support/targets.h"

namespace delray::image {
namespace {

// Sizes around every vector width.
std::vector<std::size_t> sizes() {
  std::vector<std::size_t> result;
  for (std::size_t n = 0; n <= 70; ++n) result.push_back(n);
  result.push_back(1000);
  return result;
}

Rgba8 random_colour(std::mt19937& random, Rgba8 /*type*/) {
  std::uniform_int_distribution<int> code(0, 255);
  const auto next = [&] {
    const int c = code(random);  // the ends of the range often
    return static_cast<std::uint8_t>(c < 20 ? 0 : c > 235 ? 255 : c);
  };
  return {next(), next(), next(), next()};
}

RgbaF random_colour(std::mt19937& random, RgbaF /*type*/) {
  std::uniform_real_distribution<float> light(0, 1);
  return {light(random), light(random), light(random), light(random)};
}

// Few values, so that ties, both zeros and empty pixels occur often.
float random_depth(std::mt19937& random) {
  constexpr float kDepths[] = {-1.0F, -0.0F, 0.0F, 0.5F, 1e30F, kEmptyDepth};
  return kDepths[std::uniform_int_distribution<std::size_t>(0, 5)(random)];
}

template <class Colour>
class Operators : public testing::Test {};
using Colours = testing::Types<Rgba8, RgbaF>;
TYPED_TEST_SUITE(Operators, Colours);

TYPED_TEST(Operators, MergeKeepsTheNearerPixelOnEveryTarget) {
  using Colour = TypeParam;
  tests::for_each_target([] {
    std::mt19937 random(17);
    for (const std::size_t n : sizes()) {
      for (const Tie tie : {Tie::target, Tie::other}) {
        std::vector<Colour> colour(n + 2), other(n + 1), expected_colour;
        std::vector<float> depth(n + 2), other_depth(n + 1), expected_depth;
        for (auto& c : colour) c = random_colour(random, Colour{});
        for (auto& c : other) c = random_colour(random, Colour{});
        for (auto& z : depth) z = random_depth(random);
        for (auto& z : other_depth) z = random_depth(random);
        expected_colour = colour;
        expected_depth = depth;
        // One element in, so that nothing is aligned to a vector; the last must stay untouched.
        for (std::size_t i = 1; i <= n; ++i) {
          const bool wins =
              tie == Tie::other ? other_depth[i] <= depth[i] : other_depth[i] < depth[i];
          if (!wins) continue;
          expected_colour[i] = other[i];
          expected_depth[i] = other_depth[i];
        }
        z_merge(std::span<Colour>(colour).subspan(1, n), std::span<float>(depth).subspan(1, n),
                std::span<const Colour>(other).subspan(1),
                std::span<const float>(other_depth).subspan(1), tie);
        ASSERT_EQ(colour, expected_colour) << n;
        ASSERT_EQ(std::memcmp(depth.data(), expected_depth.data(), (n + 2) * sizeof(float)), 0)
            << n;
      }
    }
  });
}

Rgba8 over(const Rgba8& f, const Rgba8& b) {
  const auto channel = [&](int front, int back) {
    const int shown = (2 * back * (255 - f.a) + 255) / 510;  // rounded to nearest
    return static_cast<std::uint8_t>(std::min(255, front + shown));
  };
  return {channel(f.r, b.r), channel(f.g, b.g), channel(f.b, b.b), channel(f.a, b.a)};
}

RgbaF over(const RgbaF& f, const RgbaF& b) {
  const auto channel = [&](float front, float back) {
    volatile float product = back * (1.0F - f.a);  // rounded before the sum
    return front + product;
  };
  return {channel(f.r, b.r), channel(f.g, b.g), channel(f.b, b.b), channel(f.a, b.a)};
}

TYPED_TEST(Operators, BlendsAsThePlainFormulaDoesOnEveryTarget) {
  using Colour = TypeParam;
  tests::for_each_target([] {
    std::mt19937 random(18);
    for (const std::size_t n : sizes()) {
      std::vector<Colour> target(n + 2), other(n + 1), in_front, behind;
      for (auto& c : target) c = random_colour(random, Colour{});
      for (auto& c : other) c = random_colour(random, Colour{});
      in_front = behind = target;
      blend_front(std::span<Colour>(in_front).subspan(1, n),
                  std::span<const Colour>(other).subspan(1));
      blend_back(std::span<Colour>(behind).subspan(1, n),
                 std::span<const Colour>(other).subspan(1));
      for (std::size_t i = 1; i <= n; ++i) {
        ASSERT_EQ(in_front[i], over(other[i], target[i])) << n << ' ' << i;
        ASSERT_EQ(behind[i], over(target[i], other[i])) << n << ' ' << i;
      }
      ASSERT_EQ(in_front.front(), target.front());
      ASSERT_EQ(in_front.back(), target.back());
    }
  });
}

TEST(Blend, RoundsEveryProductOfEightBitsToNearest) {
  tests::for_each_target([] {
    for (int alpha = 0; alpha < 256; ++alpha) {
      std::vector<Rgba8> front(256), back(256);
      for (std::size_t c = 0; c < 256; ++c) {
        front[c] = {0, 1, 100, static_cast<std::uint8_t>(alpha)};
        const auto code = static_cast<std::uint8_t>(c);
        back[c] = {code, code, code, code};
      }
      auto result = back;
      blend_front(result, front);
      for (std::size_t c = 0; c < 256; ++c) ASSERT_EQ(result[c], over(front[c], back[c]));
    }
  });
}

TEST(Blend, OpaqueHidesAndTransparentShows) {
  const std::vector<Rgba8> opaque(9, Rgba8{10, 20, 30, 255}), clear(9);
  auto target = opaque;
  blend_front(target, clear);
  EXPECT_EQ(target, opaque);
  target.assign(9, Rgba8{1, 2, 3, 40});
  blend_front(target, opaque);
  EXPECT_EQ(target, opaque);
  blend_back(target, clear);
  EXPECT_EQ(target, opaque);
}

}  // namespace
}  // namespace delray::image
