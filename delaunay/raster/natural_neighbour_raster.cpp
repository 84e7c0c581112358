// Natural neighbours at the centres of cells, of pieces and of what waits at their borders.
#include "delaunay/terrain_raster.h"

#include <algorithm>
#include <utility>

#include "delaunay/raster/cavity_patch.h"

namespace delray::delaunay {
namespace {

using internal::CavityPatch;
using internal::PatchTriangles;

PointView<double> view_of(std::span<const RowPoint> points) {
  return {reinterpret_cast<const std::byte*>(points.data()), points.size(), sizeof(RowPoint)};
}

std::vector<WaitingTriangle> waiting_of(const CavityPatch& patch, std::span<const RowPoint> points,
                                        std::span<const std::uint32_t> corners) {
  std::vector<WaitingTriangle> waiting;
  for (std::size_t t = 0; t < corners.size() / 3; ++t) {
    if (!patch.is_needed(t)) continue;
    WaitingTriangle& triangle = waiting.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) triangle.corners[k] = points[corners[3 * t + k]];
    triangle.met = patch.met(t);
    triangle.has_cells = patch.has_cells(t) ? 1 : 0;
  }
  return waiting;
}

}  // namespace

void NaturalNeighbourRaster::take(const TilePiece& piece) {
  CavityPatch patch({view_of(piece.points), piece.points, piece.simplices}, {}, false);
  patch.set_cells(raster_, {});
  patch.mark_borders();
  add_waiting(waiting_of(patch, piece.points, piece.simplices));
}

void NaturalNeighbourRaster::add_waiting(std::span<const WaitingTriangle> waiting) {
  std::vector<WaitingTriangle> many;
  {
    const std::lock_guard lock(mutex_);
    waiting_.insert(waiting_.end(), waiting.begin(), waiting.end());
    if (waiting_.size() < most_waiting_) return;
    many.swap(waiting_);
  }
  settle(std::move(many), false);
}

std::vector<WaitingTriangle> NaturalNeighbourRaster::give_waiting() {
  return std::exchange(waiting_, {});
}

void NaturalNeighbourRaster::finish() { settle(give_waiting(), true); }

void NaturalNeighbourRaster::settle(std::vector<WaitingTriangle> waiting, bool is_all) {
  std::vector<RowPoint> points;
  points.reserve(3 * waiting.size());
  for (const WaitingTriangle& triangle : waiting) {
    points.insert(points.end(), triangle.corners.begin(), triangle.corners.end());
  }
  std::ranges::sort(points, {}, &RowPoint::row);
  const auto same_row = [](const RowPoint& a, const RowPoint& b) { return a.row == b.row; };
  points.erase(std::unique(points.begin(), points.end(), same_row), points.end());
  std::vector<std::uint32_t> corners;
  std::vector<std::uint8_t> met, has_cells;
  corners.reserve(3 * waiting.size());
  for (const WaitingTriangle& triangle : waiting) {
    for (const RowPoint& corner : triangle.corners) {
      const auto at = std::ranges::lower_bound(points, corner.row, {}, &RowPoint::row);
      corners.push_back(static_cast<std::uint32_t>(at - points.begin()));
    }
    met.push_back(static_cast<std::uint8_t>(triangle.met));
    has_cells.push_back(static_cast<std::uint8_t>(triangle.has_cells));
  }
  waiting = {};
  CavityPatch patch({view_of(points), points, corners}, std::move(met), is_all);
  patch.set_cells(raster_, has_cells);
  if (is_all) return;
  patch.mark_borders();
  const std::vector<WaitingTriangle> left = waiting_of(patch, points, corners);
  const std::lock_guard lock(mutex_);
  most_waiting_ = std::max(most_waiting_, 2 * left.size());
  waiting_.insert(waiting_.end(), left.begin(), left.end());
}

void fill_natural_neighbours(PointView<double> points, const Triangulation& triangulation,
                             TerrainRaster& raster) {
  CavityPatch patch({points, {}, triangulation.vertices}, {}, true);
  patch.set_cells(raster, {});
}

}  // namespace delray::delaunay
