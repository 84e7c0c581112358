// Loops over oneTBB. They run in the arena of the calling thread: wrap a call in Arena::execute to
// choose the number of threads.
//
// `grain` is the number of indices below which a block is not split further: large enough that a
// block takes a few microseconds, small enough that every thread gets several.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_for_each.h>
#include <tbb/parallel_reduce.h>

#include <cstddef>
#include <span>

#if defined(__SANITIZE_THREAD__)
#define DELRAY_PLAIN_THREADS 1
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define DELRAY_PLAIN_THREADS 1
#endif
#endif
#ifdef DELRAY_PLAIN_THREADS
#include "parallel/internal/plain_threads.h"
#endif

namespace delray::parallel {

// Calls f(first, last) for disjoint blocks that cover [begin, end) exactly once.
template <class F>
void parallel_blocks(std::size_t begin, std::size_t end, std::size_t grain, F&& f) {
  if (begin >= end) return;
#ifdef DELRAY_PLAIN_THREADS
  internal::parallel_blocks(begin, end, grain, f);
#else
  tbb::parallel_for(tbb::blocked_range<std::size_t>(begin, end, grain),
                    [&f](const auto& r) { f(r.begin(), r.end()); });
#endif
}

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
#ifdef DELRAY_PLAIN_THREADS
  return internal::parallel_reduce(begin, end, grain, identity, map, combine);
#else
  return tbb::parallel_deterministic_reduce(
      tbb::blocked_range<std::size_t>(begin, end, grain), identity,
      [&](const auto& r, const T& sum) { return combine(sum, map(r.begin(), r.end())); },
      [&](const T& a, const T& b) { return combine(a, b); });
#endif
}

// Calls f(item, feeder) for every item and for every item that a call adds with feeder.add(item):
// work whose amount is known only while it is done.
template <class T, class F>
void parallel_do(std::span<T> items, F&& f) {
  tbb::parallel_for_each(
      items.begin(), items.end(),
      [&f](T& item, tbb::feeder<std::remove_const_t<T>>& feeder) { f(item, feeder); });
}

}  // namespace delray::parallel
