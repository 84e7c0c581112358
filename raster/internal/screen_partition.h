// Which part of the screen is whose, where primitives go to the ranks whose regions they touch.
#pragma once

#include <span>
#include <vector>

#include "loadbalance/partition.h"
#include "raster/internal/rank.h"

namespace delray::raster {

// The pieces cut into groups of neighbouring triangles. Groups of a piece follow each other.
std::vector<Piece> groups_of(std::span<const Piece> pieces);

// The box of every group on the screen, in pixels, and what it may cost. Empty boxes cost nothing.
std::vector<loadbalance::WeightedBox> boxes_of(Rank& rank, std::span<const Piece> groups);

// The frame cut by options.partition into `parts` regions of about equal cost over all ranks'
// boxes. Collective.
loadbalance::Partition cut_screen(Rank& rank, std::span<const loadbalance::WeightedBox> boxes,
                                  int parts);

}  // namespace delray::raster
