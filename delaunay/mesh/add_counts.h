// Sums of what threads counted.
#pragma once

#include "delaunay/triangulate.h"

namespace delray::delaunay::internal {

inline void add(Synchronization& sum, const Synchronization& counts) {
  sum.lock_calls += counts.lock_calls;
  sum.already_locked += counts.already_locked;
  sum.free += counts.free;
  sum.waits += counts.waits;
  sum.deadlocks += counts.deadlocks;
  sum.rollbacks += counts.rollbacks;
  sum.burglaries += counts.burglaries;
}

}  // namespace delray::delaunay::internal
