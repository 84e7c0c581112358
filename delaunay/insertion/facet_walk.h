// The visibility walk over the facets of tetrahedra (Devillers, Pion and Teillaud 2002), for
// everyone who locates points in space: callers differ in how they look at a simplex, and in where
// they stop.
#pragma once

#include "delaunay/mesh/mesh.h"

namespace delray::delaunay::internal {

// No facet: where a walk begins, and where it ends.
inline constexpr unsigned kNoFacet = 4;

// Walks from `start`: exit_of(simplex, entered) returns the facet by which to leave a simplex, or
// kNoFacet where the walk ends; `entered`, which it must not return, is the facet through which the
// walk came. Returns the last simplex.
//
// In a Delaunay mesh no walk through facets that have the point strictly beyond them goes round in
// circles (Edelsbrunner 1990).
template <class ExitOf>
SimplexNumber walk_over_facets(const Mesh<3>& mesh, SimplexNumber start, ExitOf&& exit_of) {
  SimplexNumber here = start;
  unsigned entered = kNoFacet;
  while (true) {
    const unsigned exit = exit_of(here, entered);
    if (exit == kNoFacet) return here;
    const CornerNumber next = mesh.neighbour(corner_of(here, exit));
    here = simplex_of(next);
    entered = next & 3U;
  }
}

// The first facet from `first` on, but not `entered`, that the point is beyond; kNoFacet if there
// is none.
template <class IsBeyond>
unsigned exit_facet(unsigned first, unsigned entered, IsBeyond&& is_beyond) {
  for (unsigned i = 0; i < 4; ++i) {
    const unsigned k = (first + i) & 3U;
    if (k != entered && is_beyond(k)) return k;
  }
  return kNoFacet;
}

}  // namespace delray::delaunay::internal
