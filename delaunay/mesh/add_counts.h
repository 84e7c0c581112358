// Sums of what threads counted.
#pragma once

#include <algorithm>
#include <cstddef>

#include "delaunay/triangulate.h"

namespace delray::delaunay::internal {

inline void add(FlipCounts& sum, const FlipCounts& flips) {
  sum.two_two += flips.two_two;
  sum.two_three += flips.two_three;
  sum.three_two += flips.three_two;
  sum.four_four += flips.four_four;
}

inline void add(ListLengths& sum, const ListLengths& lengths) {
  sum.lists += lengths.lists;
  sum.entries += lengths.entries;
  sum.longest = std::max(sum.longest, lengths.longest);
}
// One more list.
inline void add_list(ListLengths& sum, std::size_t entries) { add(sum, {1, entries, entries}); }

inline void add(Synchronization& sum, const Synchronization& counts) {
  sum.lock_calls += counts.lock_calls;
  sum.already_locked += counts.already_locked;
  sum.free += counts.free;
  sum.waits += counts.waits;
  sum.deadlocks += counts.deadlocks;
  sum.rollbacks += counts.rollbacks;
  sum.burglaries += counts.burglaries;
  sum.unlocked_early += counts.unlocked_early;
  sum.mutex_locks += counts.mutex_locks;
  sum.mutex_waits += counts.mutex_waits;
  add(sum.journals, counts.journals);
  add(sum.lock_lists, counts.lock_lists);
}

}  // namespace delray::delaunay::internal
