// Layers that were blended before, merged in the order of ranks.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "comm/simulated.h"
#include "comm/threads.h"
#include "composite/codec.h"
#include "composite/scheme.h"

namespace delray::composite {
namespace {

using image::BasicImage;
using image::Rgba8;
using image::RgbaF;

// Channels from 0 to 1, premultiplied; some pixels are empty, some opaque.
std::array<double, 4> channels(int rank, std::size_t pixel) {
  std::minstd_rand random(static_cast<unsigned>(rank * 7919 + static_cast<int>(pixel) + 1));
  random.discard(2);
  if (random() % 3 == 0) return {};
  const double alpha = random() % 8 == 0 ? 255 : 1 + random() % 120;
  const auto channel = [&] { return std::floor(random() % 256 / 255.0 * alpha) / 255; };
  return {channel(), channel(), channel(), alpha / 255};
}

void set(Rgba8& colour, const std::array<double, 4>& from) {
  const auto code = [&](int i) { return static_cast<std::uint8_t>(std::lround(from[i] * 255)); };
  colour = {code(0), code(1), code(2), code(3)};
}
void set(RgbaF& colour, const std::array<double, 4>& from) {
  const auto value = [&](int i) { return static_cast<float>(from[i]); };
  colour = {value(0), value(1), value(2), value(3)};
}
std::array<double, 4> get(const Rgba8& c) {
  return {c.r / 255.0, c.g / 255.0, c.b / 255.0, c.a / 255.0};
}
std::array<double, 4> get(const RgbaF& c) { return {c.r, c.g, c.b, c.a}; }

template <class Colour>
BasicImage<Colour> layer_of(int rank, int width, int height) {
  BasicImage<Colour> image(width, height);
  clear(image);
  for (std::size_t i = 0; i < image.pixels(); ++i) set(image.colour[i], channels(rank, i));
  return image;
}

// Blended in double precision.
template <class Colour>
std::array<double, 4> exact(int ranks, std::size_t pixel) {
  std::array<double, 4> sum{};
  for (int rank = 0; rank < ranks; ++rank) {
    Colour rounded;
    set(rounded, channels(rank, pixel));
    const auto layer = get(rounded);
    const double through = 1 - sum[3];
    for (std::size_t i = 0; i < 4; ++i) sum[i] += through * layer[i];
  }
  return sum;
}

template <class Colour>
BasicImage<Colour> composed(comm::Communicator& communicator, const char* scheme,
                            const Codec& codec, int width, int height) {
  OwnedPixels part = compose(
      communicator,
      codec.make(layer_of<Colour>(communicator.rank(), width, height), Operator::over), scheme);
  return take_image<Colour>(gather(communicator, std::move(part), 0));
}

template <class Colour>
class OrderedBlending : public ::testing::Test {};
using Colours = ::testing::Types<Rgba8, RgbaF>;
TYPED_TEST_SUITE(OrderedBlending, Colours);

// What docs/compositing.md promises of all layers, in codes of 8 bits and in units of 2^-24, and,
// since most roundings cancel out, what may be expected of these.
double bound(int ranks, Rgba8) {
  return ranks == 1 ? 0 : std::min(ranks - 1.5, 0.5 + std::log2(ranks)) / 255;
}
double bound(int ranks, RgbaF) { return std::min(6 * (ranks - 1), ranks + 1) * 0x1p-24; }

struct Size {
  int width, height;
};

// The pictures of all schemes and codecs, on rank 0 compared with that of the first codec.
template <class Colour>
double largest_error(comm::Communicator& communicator, Size size) {
  double error = 0;
  for (const Scheme& scheme : schemes()) {
    BasicImage<Colour> expected;
    for (const Codec& codec : codecs()) {
      auto image = composed<Colour>(communicator, scheme.name, codec, size.width, size.height);
      if (communicator.rank() != 0) continue;
      if (&codec == &codecs().front()) {
        expected = std::move(image);
        continue;
      }
      EXPECT_EQ(
          std::memcmp(expected.colour.data(), image.colour.data(), image.pixels() * sizeof(Colour)),
          0)
          << scheme.name << ", " << codec.name << ", " << communicator.size() << " ranks";
    }
    for (std::size_t i = 0; i < expected.pixels(); ++i) {
      const auto sum = exact<Colour>(communicator.size(), i), got = get(expected.colour[i]);
      for (std::size_t k = 0; k < 4; ++k) error = std::max(error, std::abs(sum[k] - got[k]));
    }
  }
  return error;
}

// Whatever the codec and the machine, the bytes are those of the scheme; schemes differ from the
// exact sum by little.
TYPED_TEST(OrderedBlending, GivesTheSameBytesForAScheme) {
  const bool full = std::getenv("DELRAY_FULL_TESTS") != nullptr;
  double worst = 0;
  for (int ranks = 1; ranks <= 17; ++ranks) {
    std::vector<Size> sizes{{1, 1}, {7, 3}};
    if (full || ranks == 6) sizes.push_back({67, 41});
    if (full && ranks % 5 == 3) sizes.push_back({1919, 1079});
    for (const Size size : sizes) {
      const auto run = [&](comm::Communicator& communicator) {
        const double error = largest_error<TypeParam>(communicator, size);
        if (communicator.rank() != 0) return;
        EXPECT_LE(error, bound(ranks, TypeParam{})) << ranks << " ranks";
        worst = std::max(worst, error);
      };
      comm::run_threads(ranks, 1, run);
      if (size.width < 67) comm::run_simulated(ranks, comm::any_order(), 5, run);
    }
  }
  this->RecordProperty("largest_error", std::to_string(worst));
}

}  // namespace
}  // namespace delray::composite
