// Running something with as many threads as its options say.
#pragma once

#include "parallel/arena.h"

namespace delray::delaunay::internal {

// f() inside an arena of `threads` threads, or of the caller for one: an arena takes longer to set
// up than a thousand points to triangulate.
template <class F>
auto with_threads(int threads, const F& f) {
  return threads <= 1 ? f() : parallel::Arena(threads).execute(f);
}

}  // namespace delray::delaunay::internal
