// The arithmetic encoder of LAZ, for tests (A. Said, Introduction to Arithmetic Coding, 2004).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "delaunay/files/laz/symbol_model.h"

namespace delray::tests {

class ArithmeticEncoder {
 public:
  void encode(delaunay::laz::SymbolModel& model, unsigned symbol) {
    const std::uint32_t whole = length_;
    length_ >>= delaunay::laz::SymbolModel::kShift;
    const std::uint32_t low = model.below(symbol) * length_;
    const std::uint32_t high = symbol == model.last() ? whole : model.below(symbol + 1) * length_;
    narrow(low, high - low);
    model.count(symbol);
  }
  void encode(delaunay::laz::BitModel& model, bool bit) {
    const std::uint32_t zero =
        model.probability_of_0() * (length_ >> delaunay::laz::BitModel::kShift);
    narrow(bit ? zero : 0, bit ? length_ - zero : zero);
    model.count(bit);
  }
  void encode_bits(std::uint32_t number, unsigned bits) {
    if (bits > 19) {
      encode_bits(number & 0xffff, 16);
      encode_bits(number >> 16, bits - 16);
      return;
    }
    length_ >>= bits;
    narrow(number * length_, length_);
  }
  // All bytes; nothing can follow.
  std::string finish() {
    const bool wide = length_ > 2U << 24;
    narrow(wide ? 1U << 24 : 1U << 23, wide ? 1U << 23 : 1U << 15);
    bytes_.append(wide ? 3 : 2, '\0');
    return bytes_;
  }

 private:
  void narrow(std::uint32_t low, std::uint32_t length) {
    base_ += low;
    if (base_ < low) {  // the carry
      std::size_t at = bytes_.size();
      while (bytes_[--at] == '\xff') bytes_[at] = '\0';
      ++bytes_[at];
    }
    for (length_ = length; length_ < 1U << 24; length_ <<= 8) {
      bytes_ += static_cast<char>(base_ >> 24);
      base_ <<= 8;
    }
  }

  std::uint32_t base_ = 0, length_ = ~0U;
  std::string bytes_;
};

class IntegerEncoder {
 public:
  IntegerEncoder(unsigned bits, unsigned contexts)
      : bits_(bits), magnitudes_(contexts), numbers_(bits + 1) {}

  void encode(ArithmeticEncoder& encoder, std::int32_t predicted, std::int32_t value,
              unsigned context) {
    std::int64_t difference = std::int64_t{value} - predicted;
    const std::int64_t range = std::int64_t{1} << bits_;
    if (difference < -range / 2) difference += range;
    if (difference >= range / 2) difference -= range;
    magnitude_ = 0;
    const auto distance =
        static_cast<std::uint64_t>(difference <= 0 ? -difference : difference - 1);
    while (distance >> magnitude_ != 0) ++magnitude_;
    if (!magnitudes_[context].ready()) magnitudes_[context].reset(bits_ + 1);
    encoder.encode(magnitudes_[context], magnitude_);
    if (magnitude_ == 0) {
      encoder.encode(smallest_, difference != 0);
    } else if (magnitude_ < 32) {
      const auto number = static_cast<std::uint32_t>(
          difference < 0 ? difference + (std::int64_t{1} << magnitude_) - 1 : difference - 1);
      const unsigned raw = magnitude_ > 8 ? magnitude_ - 8 : 0;
      auto& model = numbers_[magnitude_];
      if (!model.ready()) model.reset(1U << (magnitude_ - raw));
      encoder.encode(model, number >> raw);
      if (raw > 0) encoder.encode_bits(number & ((1U << raw) - 1), raw);
    }
  }
  unsigned magnitude() const { return magnitude_; }

 private:
  unsigned bits_, magnitude_ = 0;
  std::vector<delaunay::laz::SymbolModel> magnitudes_;
  delaunay::laz::BitModel smallest_;
  std::vector<delaunay::laz::SymbolModel> numbers_;
};

}  // namespace delray::tests
