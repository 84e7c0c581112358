// Blocks of a file, each read by itself.
#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <limits>
#include <vector>

#include "parallel/parallel_for.h"

namespace delray::scenes::internal {

// Calls f(i) for each block in parallel. Of several errors that of the first block is thrown, as
// if they were read one after the other; blocks behind one that failed may be left out.
template <class F>
void for_each_block(std::size_t blocks, F&& f) {
  std::atomic<std::size_t> failed{std::numeric_limits<std::size_t>::max()};
  std::vector<std::exception_ptr> errors(blocks);
  parallel::parallel_for(0, blocks, 1, [&](std::size_t i) {
    if (i > failed.load(std::memory_order_relaxed)) return;
    try {
      f(i);
    } catch (...) {
      errors[i] = std::current_exception();
      std::size_t before = failed.load(std::memory_order_relaxed);
      while (i < before && !failed.compare_exchange_weak(before, i)) {
      }
    }
  });
  if (const std::size_t first = failed.load(); first < blocks)
    std::rethrow_exception(errors[first]);
}

}  // namespace delray::scenes::internal
