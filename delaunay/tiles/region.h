// What is left to do in a region of space: a tile, or several that were put together.
//
// Every simplex whose closed circumscribed ball touches no other tile's box is settled: no point
// outside of the region can be in conflict with it. It is given away, and what lies around it are
// walls. The rest is made anew with what other regions leave, of its own vertices alone: the whole
// triangulation restricted to it is a part of their triangulation, as its simplices have no point
// in conflict with them. What that makes of the part that was given away lies behind the walls.
//
// So regions may be put together by their rests, pairs or more of them, up to the whole of space,
// where everything is settled (Lee, Park and Park 2001 cut and Isenburg et al. 2006 streamed by
// the same test).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "delaunay/tiles.h"

namespace delray::delaunay {

struct Region {
  // Its own points, then those of others that it was told of. Distinct, unless nobody has
  // triangulated them yet; halo points always are.
  std::vector<RowPoint> points;
  std::size_t own = 0;
  // dim places in `points` for each facet between what was given away and the rest, ordered as
  // hull_facets() would if only the part that was given away were there.
  std::vector<std::uint32_t> walls;

  std::size_t halo() const { return points.size() - own; }
};

// Puts the rest of `other` into `all`. REQUIRES: neither has a halo.
inline void append(Region& all, const Region& other) {
  const auto first = static_cast<std::uint32_t>(all.points.size());
  all.points.insert(all.points.end(), other.points.begin(), other.points.end());
  all.own = all.points.size();
  for (const std::uint32_t corner : other.walls) all.walls.push_back(first + corner);
}

}  // namespace delray::delaunay
