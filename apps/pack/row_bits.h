// A bit for each row of an input.
#pragma once

#include <atomic>
#include <bit>
#include <cstdint>
#include <vector>

namespace delray::apps {

// Any thread may set bits while others do.
class RowBits {
 public:
  explicit RowBits(std::uint64_t rows) : words_((rows + 63) / 64) {}

  static std::uint64_t bytes(std::uint64_t rows) { return (rows + 63) / 64 * 8; }
  bool test(std::uint64_t row) const { return (words_[row / 64] >> (row % 64) & 1) != 0; }
  // Returns whether it was set before.
  bool set(std::uint64_t row) {
    const std::uint64_t bit = std::uint64_t{1} << (row % 64);
    return (std::atomic_ref(words_[row / 64]).fetch_or(bit, std::memory_order_relaxed) & bit) != 0;
  }
  std::uint64_t count() const {
    std::uint64_t count = 0;
    for (const std::uint64_t word : words_)
      count += static_cast<std::uint64_t>(std::popcount(word));
    return count;
  }
  // The rows that are set, every `step`-th of them from the first on. O(rows / 64 + result).
  std::vector<std::uint64_t> every(std::uint64_t step) const {
    std::vector<std::uint64_t> rows;
    std::uint64_t skip = 0;  // of those to come
    for (std::uint64_t i = 0; i < words_.size(); ++i) {
      std::uint64_t word = words_[i];
      for (; word != 0; word &= word - 1) {
        const auto left = static_cast<std::uint64_t>(std::popcount(word));
        if (skip >= left) {
          skip -= left;
          break;
        }
        if (skip-- > 0) continue;
        rows.push_back(64 * i + static_cast<std::uint64_t>(std::countr_zero(word)));
        skip = step - 1;
      }
    }
    return rows;
  }

 private:
  std::vector<std::uint64_t> words_;
};

}  // namespace delray::apps
