// Loops over oneTBB. They run in the arena of the calling thread: wrap a call in Arena::execute to
// choose the number of threads. What a call throws, the loop throws.
//
// `grain` is the number of indices below which a block is not split further: large enough that a
// block takes a few microseconds, small enough that every thread gets several.
#pragma once

#include <cstddef>
#include <vector>

#include "parallel/function_ref.h"

namespace delray::parallel {

namespace internal {
// Calls f(task) for every task of [0, tasks) exactly once.
void run_tasks(std::size_t tasks, FunctionRef<void(std::size_t task)> f);
// Appends to `ends` where [begin, end) is cut: halved until no part exceeds the grain.
void cut(std::size_t begin, std::size_t end, std::size_t grain, std::vector<std::size_t>& ends);
}  // namespace internal

// Calls f(first, last) for disjoint blocks that cover [begin, end) exactly once.
void parallel_blocks(std::size_t begin, std::size_t end, std::size_t grain,
                     FunctionRef<void(std::size_t first, std::size_t last)> f);

// Calls f(i) for every i of [begin, end) exactly once, in any order.
template <class F>
void parallel_for(std::size_t begin, std::size_t end, std::size_t grain, F&& f) {
  parallel_blocks(begin, end, grain, [&f](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) f(i);
  });
}

// combine over all blocks of map(first, last). Blocks and the tree of combinations depend on the
// range and the grain only, so a floating-point sum is the same for every number of threads.
template <class T, class Map, class Combine>
T parallel_reduce(std::size_t begin, std::size_t end, std::size_t grain, const T& identity,
                  Map&& map, Combine&& combine) {
  if (begin >= end) return identity;
  struct Block {  // not a bare T: bits of a vector<bool> are not written independently
    T value;
  };
  std::vector<std::size_t> ends = {begin};
  internal::cut(begin, end, grain, ends);
  std::vector<Block> blocks(ends.size() - 1, Block{identity});
  internal::run_tasks(blocks.size(), [&](std::size_t block) {
    blocks[block].value = combine(identity, map(ends[block], ends[block + 1]));
  });
  // The same halving again: both halves of a part are done when it is reached from the leaves up.
  std::size_t next = 0;
  const auto combined = [&](const auto& self, std::size_t first, std::size_t last) -> T {
    if (last - first <= grain) return blocks[next++].value;
    const std::size_t middle = first + (last - first) / 2;
    const T lower = self(self, first, middle);
    return combine(lower, self(self, middle, last));
  };
  return combined(combined, begin, end);
}

}  // namespace delray::parallel
