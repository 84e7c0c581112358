// Cavities that are found at the same time, and those of them that share nothing.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "delaunay/cavity/hole.h"
#include "delaunay/cavity/point_space.h"
#include "delaunay/mesh/mesh.h"

namespace delray::delaunay::internal {

// Makes `value` at most `to`, whoever else does so.
template <class T>
void lower_to(T& value, T to) {
  const std::atomic_ref shared(value);
  T known = shared.load(std::memory_order_relaxed);
  while (to < known && !shared.compare_exchange_weak(known, to, std::memory_order_relaxed)) {
  }
}

// Whether none of the simplices next to t, nor of those next to them, is better: cavities of
// candidates that are seldom share anything.
template <int D, class IsBetter>
bool is_best_around(const Mesh<D>& mesh, SimplexNumber t, IsBetter&& is_better) {
  for (unsigned k = 0; k <= D; ++k) {
    const SimplexNumber beside = simplex_of(mesh.neighbour(t, k));
    if (is_better(beside)) return false;
    for (unsigned j = 0; j <= D; ++j) {
      const SimplexNumber next = simplex_of(mesh.neighbour(beside, j));
      if (next != t && is_better(next)) return false;
    }
  }
  return true;
}

// Each candidate writes its number into all simplices of its cavity and around it, unless a lower
// one is there: the least of all wins, and so does whoever meets nobody (Luby 1986). Losers look at
// their whole cavities too, so that who wins does not depend on threads.
template <int D>
class Claims {
 public:
  explicit Claims(std::size_t simplices) : claims_(simplices, kUnclaimed) {}
  void resize(std::size_t simplices) { claims_.resize(simplices, kUnclaimed); }

  // Rounds are below 2^31 and ascend; `number` differs among the candidates of a round.
  static std::uint64_t claim_of(std::uint64_t round, std::uint32_t number) {
    return (std::uint64_t{0x7fffffff} - round) << 32 | number;
  }

  // Finds the cavity of a vertex from a simplex in conflict with it. By several threads at a time.
  void dig(const Mesh<D>& mesh, const PointSpace<D>& space, SimplexNumber start,
           VertexNumber vertex, std::uint64_t claim, HoleFinder<D>& finder, Hole<D>& hole) {
    lower_to(claims_[start], claim);
    finder.find(mesh, start, hole, [&](SimplexNumber t) -> std::optional<bool> {
      lower_to(claims_[t], claim);
      return space.conflicts(mesh, t, vertex);
    });
  }

  // Whether nobody with a lower claim has claimed any of the same. After all have dug.
  bool holds(const Mesh<D>& mesh, const Hole<D>& hole, std::uint64_t claim) const {
    const auto is_own = [&](SimplexNumber t) { return claims_[t] == claim; };
    return std::ranges::all_of(hole.removed, is_own) &&
           std::ranges::all_of(hole.border, [&](CornerNumber corner) {
             return is_own(simplex_of(mesh.neighbour(corner)));
           });
  }

 private:
  // Claims of earlier rounds are larger.
  static constexpr std::uint64_t kUnclaimed = std::numeric_limits<std::uint64_t>::max();

  std::vector<std::uint64_t> claims_;  // per simplex
};

}  // namespace delray::delaunay::internal
