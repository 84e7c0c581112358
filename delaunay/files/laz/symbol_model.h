// Adaptive models of an arithmetic coder: how probable each symbol of an alphabet is, counted while
// symbols are coded, and renewed more and more seldom (A. Said, Introduction to Arithmetic Coding,
// 2004). LAZ prescribes these very models, down to the rounding.
//
// Probabilities are integers below 2^15 (2^13 for bits), so that times a coder's interval >> 15
// they fit into 32 bits.
#pragma once

#include <cstdint>
#include <vector>

namespace delray::delaunay::laz {

class BitModel {
 public:
  static constexpr unsigned kShift = 13;

  // Of a bit that is 0, times 2^kShift.
  std::uint32_t probability_of_0() const { return probability_; }
  void count(bool bit) {
    zeros_ += bit ? 0 : 1;
    if (--until_renewal_ == 0) renew();
  }

 private:
  void renew();

  std::uint32_t probability_ = 1U << (kShift - 1);
  std::uint32_t zeros_ = 1, bits_ = 2;
  std::uint32_t cycle_ = 4, until_renewal_ = 4;
};

class SymbolModel {
 public:
  static constexpr unsigned kShift = 15;

  SymbolModel() = default;
  // REQUIRES: 2 <= symbols <= 2048.
  explicit SymbolModel(unsigned symbols) { reset(symbols); }

  // Makes all of `symbols` equally probable. O(symbols).
  void reset(unsigned symbols);
  bool ready() const { return symbols_ > 0; }
  void clear() { symbols_ = 0; }

  unsigned last() const { return symbols_ - 1; }
  // The probability of all symbols below `symbol`, times 2^kShift.
  std::uint32_t below(unsigned symbol) const { return below_[symbol]; }

  // The symbol s with below(s) <= share < below(s + 1). O(log symbols), most often O(1).
  unsigned find(std::uint32_t share) const {
    unsigned low = 0, high = symbols_;
    if (table_shift_ > 0) {
      low = start_[share >> table_shift_];
      high = start_[(share >> table_shift_) + 1] + 1U;
    }
    while (high > low + 1) {
      const unsigned middle = (low + high) / 2;
      const bool above = below_[middle] > share;
      high = above ? middle : high;
      low = above ? low : middle;
    }
    return low;
  }

  void count(unsigned symbol) {
    ++counts_[symbol];
    if (--until_renewal_ == 0) renew();
  }

 private:
  void renew();

  unsigned symbols_ = 0;
  unsigned table_shift_ = 0;  // 0: no table, the alphabet is small
  std::uint32_t total_ = 0, cycle_ = 0, until_renewal_ = 0;
  std::vector<std::uint16_t> below_;
  std::vector<std::uint16_t> counts_;
  // For each of equal intervals of probability the symbol that its beginning falls into.
  std::vector<std::uint16_t> start_;
};

}  // namespace delray::delaunay::laz
