// Finding equal things among many.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "parallel/grow.h"
#include "parallel/parallel_for.h"

namespace delray::scenes::internal {

// The first of all equal things of n, by their numbers. hash(i) is a hash of the i-th, of which the
// upper half counts, and equal(i, j) says whether two are equal; both are referred to.
//
// In a table with open addressing that threads fill together, 6 bytes for each: a slot belongs to
// the first that comes, and holds the least of its equals in the end, in whatever order they came.
template <class Hash, class Equal>
class FirstOfEqual {
 public:
  FirstOfEqual(std::size_t n, const Hash& hash, const Equal& equal)
      : n_(n), hash_(hash), equal_(equal) {
    parallel::grow(slots_, n + n / 2 + 1);
  }

  // Parallel.
  void insert_all() {
    distinct_ = parallel::parallel_reduce(
        0, n_, kBlock, std::size_t{0},
        [&](std::size_t first, std::size_t last) {
          std::size_t distinct = 0;
          for (std::size_t i = first; i < last; ++i) {
            distinct += insert(static_cast<std::uint32_t>(i)) ? 1 : 0;
          }
          return distinct;
        },
        std::plus<>());
  }
  // How many things differ.
  std::size_t distinct() const { return distinct_; }
  // The first that is equal to the i-th.
  std::uint32_t find(std::uint32_t i) const {
    std::size_t slot = slot_of(i);
    while (!equal_(slots_[slot] - 1, i)) slot = next(slot);
    return slots_[slot] - 1;
  }

 private:
  static constexpr std::size_t kBlock = 1 << 12;  // things: tens of microseconds

  // Slots hold a number plus one; 0: none.
  bool insert(std::uint32_t i) {
    for (std::size_t slot = slot_of(i);; slot = next(slot)) {
      std::atomic_ref<std::uint32_t> at(slots_[slot]);
      std::uint32_t held = at.load(std::memory_order_relaxed);
      if (held == 0 && at.compare_exchange_strong(held, i + 1, std::memory_order_relaxed)) {
        return true;
      }
      if (!equal_(held - 1, i)) continue;
      while (i + 1 < held && !at.compare_exchange_weak(held, i + 1, std::memory_order_relaxed)) {
      }
      return false;
    }
  }
  std::size_t slot_of(std::uint32_t i) const {
    return static_cast<std::size_t>((hash_(i) >> 32) * slots_.size() >> 32);
  }
  std::size_t next(std::size_t slot) const { return slot + 1 < slots_.size() ? slot + 1 : 0; }

  std::size_t n_, distinct_ = 0;
  const Hash& hash_;
  const Equal& equal_;
  std::vector<std::uint32_t> slots_;
};

}  // namespace delray::scenes::internal
