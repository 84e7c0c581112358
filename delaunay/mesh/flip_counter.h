// What access policies of flip kernels count.
#pragma once

#include <cstdint>

#include "delaunay/triangulate.h"

namespace delray::delaunay::internal {

// A base of policies. It counts what is undone later, too.
class FlipCounter {
 public:
  void count_flip(std::uint64_t FlipCounts::*kind) { ++(flips_.*kind); }
  const FlipCounts& flips() const { return flips_; }

 private:
  FlipCounts flips_;
};

// Tells the policy of a flip, if it counts them.
template <class Access>
void count_flip(Access& access, std::uint64_t FlipCounts::*kind) {
  if constexpr (requires { access.count_flip(kind); }) access.count_flip(kind);
}

}  // namespace delray::delaunay::internal
