// Triangles of a triangulation that lie side by side, and the cells of a raster whose natural
// neighbours they have.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "delaunay/mesh/facets.h"
#include "delaunay/natural_neighbours/plane_shares.h"
#include "delaunay/points.h"
#include "delaunay/terrain_raster.h"
#include "delaunay/tiles.h"

namespace delray::delaunay::internal {

// Triangles by their corners, which are numbers of points.
struct PatchTriangles {
  PointView<double> points;            // with heights
  std::span<const RowPoint> numbered;  // the rows of points; empty: their numbers
  std::span<const std::uint32_t> corners;
};

class CavityPatch {
 public:
  // `met`: of each triangle bit k where what lies beyond the edge opposite to corner k came
  // earlier, and is not needed any more; empty: nowhere. `is_all`: what has not met anything is the
  // hull.
  CavityPatch(const PatchTriangles& triangles, std::vector<std::uint8_t> met, bool is_all);

  // Sets the cells in triangles that `wanted` is not 0 for (empty: in all), as far as all of their
  // neighbours are here; marks the others. In parallel.
  void set_cells(TerrainRaster& raster, std::span<const std::uint8_t> wanted);
  // Marks the triangles whose circles reach edges that have met nothing.
  void mark_borders();

  // After both of these.
  bool is_needed(std::size_t triangle) const { return (marks_[triangle] & kNeeded) != 0; }
  bool has_cells(std::size_t triangle) const { return (marks_[triangle] & kHasCells) != 0; }
  // Bit k: the edge opposite to corner k has met its other side.
  unsigned met(std::size_t triangle) const;

 private:
  enum Mark : std::uint8_t { kNeeded = 1, kHasCells = 2 };
  struct Scratch {
    std::vector<std::uint32_t> cavity, edges, vertices;
    std::vector<CavityTriangle> triangles;
  };

  glm::dvec2 place(std::uint32_t vertex) const {
    return {triangles_.points(vertex, 0), triangles_.points(vertex, 1)};
  }
  double height(std::uint32_t vertex) const { return triangles_.points(vertex, 2); }
  std::uint64_t row(std::uint32_t vertex) const {
    return triangles_.numbered.empty() ? vertex : triangles_.numbered[vertex].row;
  }
  std::array<glm::dvec2, 3> places(std::size_t triangle) const;
  bool is_open(std::size_t edge) const {
    return !is_all_ && mates_[edge] == FacetMates::kNone &&
           (met_.empty() || (met_[edge / 3] >> (edge % 3) & 1) == 0);
  }
  void mark(std::size_t triangle, Mark mark);
  void set_cells_of(std::size_t triangle, const RasterGrid& grid, Scratch& scratch,
                    std::vector<CellHeight>& cells);
  bool find_cavity(std::size_t triangle, const glm::dvec2& q, Scratch& scratch) const;
  double value(const glm::dvec2& q, Scratch& scratch) const;

  PatchTriangles triangles_;
  std::vector<std::uint8_t> met_;
  bool is_all_;
  std::vector<std::uint32_t> mates_;
  std::vector<std::uint8_t> marks_;
};

}  // namespace delray::delaunay::internal
