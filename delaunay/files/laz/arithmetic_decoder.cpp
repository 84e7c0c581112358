// Integers by magnitude class and number within the class (Isenburg, LASzip: lossless compression
// of LiDAR data, 2013). Models are made when the first value needs them: of most nothing is ever
// seen.
#include "delaunay/files/laz/arithmetic_decoder.h"

#include <algorithm>
#include <limits>

namespace delray::delaunay::laz {
namespace {

constexpr unsigned kModelledBits = 8;

}  // namespace

ArithmeticDecoder::ArithmeticDecoder(std::string_view bytes)
    : bytes_(bytes.data()), end_(static_cast<std::ptrdiff_t>(bytes.size())), length_(~0U) {
  for (int i = 0; i < 4; ++i) value_ = value_ << 8 | next_byte();
}

IntegerDecoder::IntegerDecoder(unsigned bits, unsigned contexts)
    : bits_(bits), magnitudes_(contexts), numbers_(bits + 1) {}

void IntegerDecoder::reset() {
  magnitude_ = 0;
  for (SymbolModel& model : magnitudes_) model.clear();
  for (SymbolModel& model : numbers_) model.clear();
  smallest_ = {};
}

std::int32_t IntegerDecoder::decode(ArithmeticDecoder& decoder, std::int32_t predicted,
                                    unsigned context) {
  // In unsigned numbers, which wrap.
  const std::uint32_t sum = static_cast<std::uint32_t>(predicted) +
                            static_cast<std::uint32_t>(decode_difference(decoder, context));
  return static_cast<std::int32_t>(bits_ == 32 ? sum : sum & ((1U << bits_) - 1));
}

std::int32_t IntegerDecoder::decode_difference(ArithmeticDecoder& decoder, unsigned context) {
  SymbolModel& magnitudes = magnitudes_[context];
  if (!magnitudes.ready()) magnitudes.reset(bits_ + 1);
  const unsigned k = magnitude_ = decoder.decode(magnitudes);
  if (k == 0) return decoder.decode(smallest_) ? 1 : 0;
  // The one number that no class has.
  if (k == 32) return std::numeric_limits<std::int32_t>::min();
  SymbolModel& numbers = numbers_[k];
  const unsigned modelled = std::min(k, kModelledBits);
  if (!numbers.ready()) numbers.reset(1U << modelled);
  std::uint32_t number = decoder.decode(numbers);
  if (k > modelled) number = number << (k - modelled) | decoder.decode_bits(k - modelled);
  return number >= 1U << (k - 1) ? static_cast<std::int32_t>(number + 1)
                                 : static_cast<std::int32_t>(number - ((1U << k) - 1));
}

}  // namespace delray::delaunay::laz
