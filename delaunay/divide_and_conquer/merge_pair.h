// The tests of both sides of a merge line at once: lane 0 is the left side's, lane 1 the right
// side's.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace delray::delaunay::internal {

// Two doubles in a register that every processor of the architecture has: a vector of the language
// (GCC, Clang), for which there is nothing to dispatch at run time.
using Pair = double __attribute__((vector_size(16)));
using PairMask = std::int64_t __attribute__((vector_size(16)));  // -1 where something holds, or 0

// Bit i tells of lane i.
inline unsigned bits_of(PairMask mask) {
#ifdef __SSE2__
  return static_cast<unsigned>(_mm_movemask_pd(reinterpret_cast<__m128d>(mask)));
#else
  return static_cast<unsigned>((mask[0] & 1) | (mask[1] & 2));
#endif
}

inline Pair absolute(Pair a) {
  constexpr PairMask kAllButSign = {0x7fffffffffffffff, 0x7fffffffffffffff};
  return reinterpret_cast<Pair>(reinterpret_cast<PairMask>(a) & kAllButSign);
}

// Two points, one for each side.
struct PointPair {
  PointPair(const glm::dvec2& left, const glm::dvec2& right)
      : x{left.x, right.x}, y{left.y, right.y} {}
  Pair x, y;
};

// Two points as the edge from a to b sees them (see EdgeView).
struct EdgeViewPair {
  EdgeViewPair(const glm::dvec2& a, const glm::dvec2& b, const PointPair& p) {
    const Pair ax = a.x - p.x, ay = a.y - p.y, bx = b.x - p.x, by = b.y - p.y;
    dot = ax * bx + ay * by;
    cross = ax * by - ay * bx;
  }
  Pair dot, cross;
};

}  // namespace delray::delaunay::internal
