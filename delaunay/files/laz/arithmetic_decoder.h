// The arithmetic decoder of LAZ (A. Said's range coder of 32 bits: interval of at least 2^24, a
// byte shifted in at a time), and the decoder of integers that is built on it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "delaunay/files/laz/symbol_model.h"

namespace delray::delaunay::laz {

class ArithmeticDecoder {
 public:
  ArithmeticDecoder() = default;
  // Reads the first four of `bytes`, which must outlive the decoder.
  explicit ArithmeticDecoder(std::string_view bytes);

  unsigned decode(SymbolModel& model) {
    const std::uint32_t whole = length_;
    length_ >>= SymbolModel::kShift;
    // More than all of the interval only where the bytes are damaged.
    const std::uint32_t share = std::min(value_ / length_, (1U << SymbolModel::kShift) - 1);
    const unsigned symbol = model.find(share);
    const std::uint32_t low = model.below(symbol) * length_;
    // The last symbol has what was left over by the division, too.
    const std::uint32_t high = symbol == model.last() ? whole : model.below(symbol + 1) * length_;
    narrow(low, high - low);
    model.count(symbol);
    return symbol;
  }

  bool decode(BitModel& model) {
    const std::uint32_t zero = model.probability_of_0() * (length_ >> BitModel::kShift);
    const bool bit = value_ >= zero;
    if (bit) {
      narrow(zero, length_ - zero);
    } else {
      narrow(0, zero);
    }
    model.count(bit);
    return bit;
  }

  // Bits that are all equally probable. REQUIRES: 1 <= bits <= 32.
  std::uint32_t decode_bits(unsigned bits) {
    constexpr unsigned kMostAtOnce = 19, kHalf = 16;
    if (bits > kMostAtOnce) {
      const std::uint32_t low = decode_bits(kHalf);
      return decode_bits(bits - kHalf) << kHalf | low;
    }
    length_ >>= bits;
    const std::uint32_t number = std::min(value_ / length_, (1U << bits) - 1);
    narrow(number * length_, length_);
    return number;
  }

  // Whether more was decoded than the bytes hold: they are cut short or damaged.
  bool overrun() const {
    constexpr std::ptrdiff_t kSlack = 4;  // encoders leave out zeros at the end
    return at_ - end_ > kSlack;
  }

 private:
  // Goes on in [low, low + length) of the interval.
  void narrow(std::uint32_t low, std::uint32_t length) {
    constexpr std::uint32_t kShortest = 1U << 24;
    value_ -= low;
    length_ = length;
    while (length_ < kShortest) {
      value_ = value_ << 8 | next_byte();
      length_ <<= 8;
    }
  }
  // 0 behind the end.
  std::uint32_t next_byte() {
    const std::ptrdiff_t at = at_++;
    return at < end_ ? static_cast<unsigned char>(bytes_[at]) : 0;
  }

  const char* bytes_ = nullptr;
  std::ptrdiff_t at_ = 0, end_ = 0;
  std::uint32_t value_ = 0, length_ = 0;
};

// Decodes integers of up to 32 bits as the difference to a prediction: first its magnitude class k,
// then which number of that class it is, of large classes the upper eight bits by a model and the
// others as they are (Isenburg, LASzip, 2013). Class 0 has 0 and 1, class k the numbers
// -(2^k - 1) ... -2^(k-1) and 2^(k-1) + 1 ... 2^k, numbered from 0, class 32 only -2^31.
class IntegerDecoder {
 public:
  // REQUIRES: 2 <= bits <= 32; contexts >= 1.
  IntegerDecoder(unsigned bits, unsigned contexts);

  // Forgets what was learned.
  void reset();
  // A number of `bits` bits: wraps around. REQUIRES: context < contexts.
  std::int32_t decode(ArithmeticDecoder& decoder, std::int32_t predicted, unsigned context);
  // The magnitude class of the last difference, 0 to `bits`.
  unsigned magnitude() const { return magnitude_; }

 private:
  std::int32_t decode_difference(ArithmeticDecoder& decoder, unsigned context);

  unsigned bits_;
  unsigned magnitude_ = 0;
  std::vector<SymbolModel> magnitudes_;  // of each context
  BitModel smallest_;                    // of class 0: 0 or 1
  std::vector<SymbolModel> numbers_;     // of each class above
};

}  // namespace delray::delaunay::laz
