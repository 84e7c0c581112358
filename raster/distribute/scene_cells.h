// Sort-last with a cell of space for each rank: their layers lie one behind the other, so that they
// can be blended before they travel (Ma, Painter, Hansen and Krogh 1994).
#pragma once

#include <vector>

#include "composite/layer.h"
#include "loadbalance/kd_cells.h"
#include "raster/distribute/regions.h"
#include "raster/pipeline/draws.h"

namespace delray::raster {

struct RankContext;

// A scene's cells for a number of ranks, and what reaches into this rank's.
struct SceneCells {
  loadbalance::KdCells cells;  // by rank
  std::vector<Piece> pieces;

  const geometry::Box3& cell(int rank) const { return cells.cells[static_cast<std::size_t>(rank)]; }
};

// Cuts space by the triangles of clusters: the same cells on every rank, without a message. `known`
// is taken where it is for as many ranks. O(clusters log clusters log ranks), and the first time
// what making all clusters of the scene takes.
void cut_scene(const RankContext& rank, SceneCells& known);

// Ends a drawing of `cells.pieces`: of what is seen at a sample those surfaces that are in the
// rank's cell, blended front to back, with the depth of the first, as a layer of codec
// options.codec.
//
// A surface is in the cell of the point where it is seen, moved into the box of its cluster, so
// that rounding makes it nobody's or everybody's never. Along a ray points are in the order of
// depths; only what is closer than rounding to a plane may be blended in another order than by
// depth.
std::unique_ptr<composite::Layer> draw_cell(RankContext& rank, const DrawList& list,
                                            RegionDrawing& drawing, const geometry::Box3& cell);

}  // namespace delray::raster
