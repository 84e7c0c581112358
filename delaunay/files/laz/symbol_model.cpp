// How the models of the arithmetic coder learn: counts are turned into probabilities after 5/4 as
// many symbols as the time before, and halved before they outgrow their range (A. Said 2004).
#include "delaunay/files/laz/symbol_model.h"

#include <algorithm>

namespace delray::delaunay::laz {
namespace {

constexpr std::uint32_t kOne = 1U << 31;

}  // namespace

void BitModel::renew() {
  constexpr std::uint32_t kMost = 1U << kShift, kLongestCycle = 64;
  bits_ += cycle_;
  if (bits_ > kMost) {
    bits_ = (bits_ + 1) / 2;
    zeros_ = (zeros_ + 1) / 2;
    if (zeros_ == bits_) ++bits_;
  }
  probability_ = (zeros_ * (kOne / bits_)) >> (31 - kShift);
  cycle_ = std::min(5 * cycle_ / 4, kLongestCycle);
  until_renewal_ = cycle_;
}

void SymbolModel::reset(unsigned symbols) {
  constexpr unsigned kSmallAlphabet = 16;
  symbols_ = symbols;
  counts_.assign(symbols, 1);
  below_.assign(symbols + 1, 0);
  table_shift_ = 0;
  if (symbols > kSmallAlphabet) {
    unsigned bits = 3;
    while (symbols > (1U << bits)) ++bits;
    table_shift_ = kShift - bits;
    start_.assign((1U << bits) + 1, 0);
  }
  total_ = 0;
  cycle_ = symbols;
  renew();
  cycle_ = until_renewal_ = (symbols + 6) / 2;
}

void SymbolModel::renew() {
  constexpr std::uint32_t kMost = 1U << kShift;
  total_ += cycle_;
  if (total_ > kMost) {
    total_ = 0;
    for (std::uint16_t& count : counts_) {
      count = static_cast<std::uint16_t>((count + 1) / 2);
      total_ += count;
    }
  }
  const std::uint32_t scale = kOne / total_;
  std::uint32_t sum = 0;
  std::size_t filled = 0;
  for (unsigned symbol = 0; symbol < symbols_; ++symbol) {
    const std::uint32_t below = (scale * sum) >> (31 - kShift);
    below_[symbol] = static_cast<std::uint16_t>(below);
    sum += counts_[symbol];
    if (table_shift_ == 0) continue;
    // Intervals that begin before this symbol belong to the one before.
    for (; filled << table_shift_ < below; ++filled) {
      start_[filled] = static_cast<std::uint16_t>(symbol - 1);
    }
  }
  below_[symbols_] = static_cast<std::uint16_t>(kMost);
  for (; table_shift_ > 0 && filled < start_.size(); ++filled) {
    start_[filled] = static_cast<std::uint16_t>(symbols_ - 1);
  }
  cycle_ = std::min(5 * cycle_ / 4, (symbols_ + 6) * 8);
  until_renewal_ = cycle_;
}

}  // namespace delray::delaunay::laz
