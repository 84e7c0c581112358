// Loops as tasks of oneTBB, or of plain threads under ThreadSanitizer. Blocks of reductions come
// from halving the range, which depends on the range and the grain alone; a range within one grain
// runs on the caller without the scheduler.
#include "parallel/parallel_for.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "parallel/threads/plain_threads.h"

namespace delray::parallel {

namespace internal {

void cut(std::size_t begin, std::size_t end, std::size_t grain, std::vector<std::size_t>& ends) {
  if (end - begin <= grain) return ends.push_back(end);
  const std::size_t middle = begin + (end - begin) / 2;
  cut(begin, middle, grain, ends);
  cut(middle, end, grain, ends);
}

void run_tasks(std::size_t tasks, FunctionRef<void(std::size_t)> f) {
#ifdef DELRAY_TSAN
  run_on_plain_threads(tasks, f);
#else
  tbb::parallel_for(std::size_t{0}, tasks, f);
#endif
}

}  // namespace internal

void parallel_blocks(std::size_t begin, std::size_t end, std::size_t grain,
                     FunctionRef<void(std::size_t, std::size_t)> f) {
  if (begin >= end) return;
  if (end - begin <= grain) return f(begin, end);  // the scheduler takes longer than many a block
#ifdef DELRAY_TSAN
  std::vector<std::size_t> ends = {begin};
  internal::cut(begin, end, grain, ends);
  internal::run_on_plain_threads(ends.size() - 1,
                                 [&](std::size_t block) { f(ends[block], ends[block + 1]); });
#else
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(begin, end, grain),
      [f](const tbb::blocked_range<std::size_t>& block) { f(block.begin(), block.end()); });
#endif
}

}  // namespace delray::parallel
