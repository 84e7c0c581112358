#include "delaunay/files/laz/arithmetic_decoder.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <string>
#include <vector>

#include "tests/delaunay/files/laz/arithmetic_encoder.h"

namespace delray::tests {
namespace {

using namespace delaunay::laz;

TEST(ArithmeticDecoder, ReturnsSymbolsBitsAndNumbers) {
  for (const unsigned symbols : {2U, 3U, 16U, 17U, 33U, 128U, 256U, 516U, 2048U}) {
    std::mt19937 random(symbols);
    std::geometric_distribution<unsigned> skewed(0.3);
    std::vector<unsigned> values;
    ArithmeticEncoder encoder;
    SymbolModel model(symbols);
    BitModel bit;
    for (int i = 0; i < 20000; ++i) {
      const unsigned value = i % 3 == 0 ? random() % symbols : skewed(random) % symbols;
      values.push_back(value);
      encoder.encode(model, value);
      encoder.encode(bit, value % 5 == 0);
      encoder.encode_bits(value * 77777777U, 32);
      encoder.encode_bits(value & 1, 1);
      encoder.encode_bits(value & 0x7ffff, 19);
    }
    const std::string bytes = encoder.finish();
    ArithmeticDecoder decoder(bytes);
    SymbolModel same(symbols);
    BitModel same_bit;
    for (const unsigned value : values) {
      ASSERT_EQ(decoder.decode(same), value);
      ASSERT_EQ(decoder.decode(same_bit), value % 5 == 0);
      ASSERT_EQ(decoder.decode_bits(32), value * 77777777U);
      ASSERT_EQ(decoder.decode_bits(1), value & 1);
      ASSERT_EQ(decoder.decode_bits(19), value & 0x7ffff);
    }
    EXPECT_FALSE(decoder.overrun());
  }
}

TEST(ArithmeticDecoder, TellsWhenItHasRunOutOfBytes) {
  ArithmeticDecoder decoder("ab");
  EXPECT_FALSE(decoder.overrun());
  for (int i = 0; i < 10; ++i) decoder.decode_bits(19);
  EXPECT_TRUE(decoder.overrun());
}

TEST(IntegerDecoder, ReturnsIntegersOfEveryMagnitude) {
  constexpr auto kLeast = std::numeric_limits<std::int32_t>::min();
  constexpr auto kMost = std::numeric_limits<std::int32_t>::max();
  struct Pair {
    std::int32_t predicted, value;
  };
  std::vector<Pair> pairs = {{0, kLeast}, {kMost, kLeast}, {kLeast, kMost}, {-1, kMost}, {5, 5}};
  std::mt19937 random(1);
  for (int bits = 1; bits <= 32; ++bits) {
    for (int i = 0; i < 200; ++i) {
      pairs.push_back({static_cast<std::int32_t>(random() >> (32 - bits)),
                       static_cast<std::int32_t>(random() >> (32 - bits))});
    }
  }
  ArithmeticEncoder encoder;
  IntegerEncoder wide(32, 2), narrow(16, 1);
  for (const Pair& pair : pairs) {
    wide.encode(encoder, pair.predicted, pair.value, pair.value & 1);
    narrow.encode(encoder, pair.predicted & 0xffff, pair.value & 0xffff, 0);
  }
  const std::string bytes = encoder.finish();
  ArithmeticDecoder decoder(bytes);
  IntegerDecoder same_wide(32, 2), same_narrow(16, 1);
  for (const Pair& pair : pairs) {
    ASSERT_EQ(same_wide.decode(decoder, pair.predicted, pair.value & 1), pair.value);
    ASSERT_EQ(same_narrow.decode(decoder, pair.predicted & 0xffff, 0), pair.value & 0xffff);
  }
}

}  // namespace
}  // namespace delray::tests
