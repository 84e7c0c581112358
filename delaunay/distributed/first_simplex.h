// The simplex that an insertion by several ranks begins with.
#pragma once

#include <optional>
#include <span>

#include "comm/communicator.h"
#include "delaunay/distributed/node.h"

namespace delray::delaunay {

// Collective: D + 1 points of all ranks that are not on one line (2D) or plane (3D), positively
// oriented, the same on all ranks; nothing if there are none. O(points of the rank), D + 1
// gatherings of one point a rank.
template <int D>
std::optional<FirstSimplex<D>> find_first_simplex(comm::Communicator& communicator,
                                                  std::span<const RowPoint> points);

}  // namespace delray::delaunay
