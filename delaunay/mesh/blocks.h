// Arrays cut into blocks for the threads of an arena.
#pragma once

#include <algorithm>
#include <cstddef>

#include "parallel/parallel_for.h"

namespace delray::delaunay::internal {

// The indices [0, n) in blocks of nearly equal size. One thread, or little work, gets a single
// block and never calls the scheduler, which takes longer to wake up than a thousand points to
// triangulate.
class Blocks {
 public:
  Blocks(std::size_t n, int threads)
      : n_(n),
        count_(threads <= 1 ? 1
                            : std::clamp(n / kSmallest, std::size_t{1},
                                         kPerThread * static_cast<std::size_t>(threads))) {}

  std::size_t size() const { return n_; }
  std::size_t count() const { return count_; }
  std::size_t begin(std::size_t block) const {
    return n_ / count_ * block + std::min(block, n_ % count_);
  }

  // Calls f(block, first, last) for every block, in any order and in parallel.
  template <class F>
  void for_each(F&& f) const {
    if (count_ == 1) return f(std::size_t{0}, std::size_t{0}, n_);
    parallel::parallel_for(0, count_, 1,
                           [&](std::size_t block) { f(block, begin(block), begin(block + 1)); });
  }

 private:
  static constexpr std::size_t kSmallest = 8192;  // some tens of microseconds
  // Evens out threads that start late or get less of their core.
  static constexpr std::size_t kPerThread = 4;

  std::size_t n_, count_;
};

}  // namespace delray::delaunay::internal
