// The triangles that a tile shows, ready to be shaded by vectors.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "parallel/function_ref.h"
#include "raster/shading/point_planes.h"
#include "raster/shading/shade_tile.h"
#include "raster/shading/tile_groups.h"
#include "raster/shading/tile_runs.h"

namespace delray::raster {

// Triangles of a cluster that a tile shows, and what they use.
struct ClusterMembers {
  const TileGroups::Group* group = nullptr;
  CornerNumbers corners;                    // of its triangles, numbers of `vertices`
  std::span<const std::uint32_t> vertices;  // of the mesh
  // For groups that use but a part of the cluster's vertices.
  std::uint32_t chosen_vertices[kClusterVertices] = {};
  std::uint8_t used[kClusterVertices] = {};    // by vertex of the cluster: 1, 0 between groups
  std::uint8_t number[kClusterVertices] = {};  // of those used
};

// A triangle at a pixel.
struct SurfaceAt {
  std::uint32_t number;
  int x, y;
};

// Memory for a tile. One per thread.
//
// Triangles are looked up cluster by cluster: their vertices have small numbers there, and are
// transformed together.
class TileTriangles {
 public:
  using Group = TileGroups::Group;

  // What the pixels of `rect` (of the frame, within the tile) show. Returns how many of them show
  // anything.
  std::uint64_t find(const VisibilityTile& tile, const geometry::Rect& rect);
  // Triangles without pixels, each once, instead: their indices.
  std::vector<std::uint16_t> set(std::span<const std::uint32_t> numbers);

  std::size_t size() const { return groups_.places().size(); }
  TrianglePlanes& planes() { return planes_; }
  const TrianglePlanes& planes() const { return planes_; }

  // Calls wanted(draw) of each group, and for those that are, some groups later, set_up(members).
  // The triangles of the others are left to shade_pixel.
  using Wanted = parallel::FunctionRef<bool(std::uint32_t)>;
  using SetUp = parallel::FunctionRef<void(const ClusterMembers&)>;
  void for_each_group(const FrameShading& frame, Wanted clip, SetUp set_up);
  // The triangles' planes; their vertices get numbers from first_vertex on. Those that are not
  // proper are left to shade_pixel.
  void set_up_planes(const FrameShading& frame, const ClusterMembers& members,
                     std::uint32_t first_vertex, ClusterFacing& facing);
  // Of the mesh.
  std::uint32_t triangle(const FrameShading& frame, const ClusterMembers& members,
                         std::size_t member) const {
    return frame.list.clusters[members.group->cluster].first +
           groups_.places()[members.group->first + member];
  }

  void leave_to_shade_pixel(std::size_t triangle) {
    left_[triangle] = 1;
    any_left_ = true;
  }
  bool any_left() const { return any_left_; }
  bool is_left(std::size_t triangle) const { return left_[triangle] != 0; }

  TriangleIndices indices() const { return groups_.indices(); }

  // Writes colours and depths of what was found to the window. shade_row(row, x, y, count, pixels)
  // stores a row's colours, as in shade_row.h.
  template <class Colour>
  using ShadeRow = parallel::FunctionRef<void(const RowRuns&, int, int, int, Colour*)>;
  template <class Colour>
  void write(const FrameShading& frame, SeenTriangles& seen, const VisibilityTile& tile,
             const geometry::Rect& rect, const Window<Colour>& window, ShadeRow<Colour> shade_row);

  // The colours of surfaces, premultiplied. Some at a time: set_up() sets up what they show, then
  // shade_block(lanes) makes what colour_of(lane) tells of the block, which is filled.
  template <class SetUpAll, class ShadeBlock, class ColourOf>
  void colours(const FrameShading& frame, SeenTriangles& seen, std::span<const SurfaceAt> surfaces,
               PixelBlock& block, SetUpAll&& set_up, ShadeBlock&& shade_block, ColourOf&& colour_of,
               image::RgbaF* results);

 private:
  // The pixels of a row whose triangles are left to shade_pixel, a bit each.
  std::uint64_t left_of(const RowRuns& row, int count) const;
  void ask_for(const FrameShading& frame);
  static void number_vertices(std::span<const std::uint32_t> vertices, ClusterMembers& members);
  void collect(const FrameShading& frame, const Group& group, ClusterMembers& members);
  void set_up_clipped(const FrameShading& frame, const ClusterMembers& members, std::size_t member,
                      ClusterFacing& facing);

  TileRuns runs_;
  TileGroups groups_;
  TrianglePlanes planes_;
  std::vector<std::uint8_t> left_;  // by triangle
  bool any_left_ = false;
  ClusterMembers members_[2];  // of a group and the next
  ScreenVertices screen_vertices_;
  std::vector<std::uint32_t> numbers_;  // of surfaces
};

template <class SetUpAll, class ShadeBlock, class ColourOf>
void TileTriangles::colours(const FrameShading& frame, SeenTriangles& seen,
                            std::span<const SurfaceAt> surfaces, PixelBlock& block,
                            SetUpAll&& set_up, ShadeBlock&& shade_block, ColourOf&& colour_of,
                            image::RgbaF* results) {
  for (; !surfaces.empty(); surfaces = surfaces.subspan(numbers_.size())) {
    numbers_.clear();
    for (const SurfaceAt& s : surfaces.first(std::min<std::size_t>(kTilePixels, surfaces.size())))
      numbers_.push_back(s.number);
    const std::vector<std::uint16_t> triangles = set(numbers_);
    set_up();
    for (std::size_t first = 0; first < triangles.size(); first += shading::kBlockPoints) {
      const std::size_t count =
          std::min<std::size_t>(shading::kBlockPoints, triangles.size() - first);
      shading::LaneMask lanes = 0;
      for (std::size_t i = 0; i < shading::kBlockPoints; ++i) {
        // The last block repeats its last surface.
        const std::size_t which = first + std::min(i, count - 1);
        block.triangle[i] = triangles[which];
        block.x[i] = static_cast<float>(surfaces[which].x);
        block.y[i] = static_cast<float>(surfaces[which].y);
        lanes |= shading::LaneMask{i < count && !is_left(triangles[which])} << i;
      }
      if (lanes != 0) shade_block(lanes);
      for (std::size_t i = 0; i < count; ++i) {
        const SurfaceAt& s = surfaces[first + i];
        *results++ = lanes >> i & 1 ? colour_of(static_cast<int>(i))
                                    : colour_at(frame, seen, s.number, s.x, s.y);
      }
    }
  }
}

// Calls shade(i, shown) for pixels x + i .. of a row as ShadeRow gives it, a block at a time, with
// the block filled; the lanes of `shown` show triangles, the others have one of these if there
// are any.
template <class F>
void for_each_block(const RowRuns& row, const TriangleIndices& indices, int x, int y, int count,
                    PixelBlock& block, F&& shade) {
  for (int i = 0; i < count; i += shading::kBlockPoints) {
    const std::uint64_t rest = row.shown >> i & (~std::uint64_t{0} >> (kTileSize - (count - i)));
    const auto shown = static_cast<shading::LaneMask>(rest & ((1U << shading::kBlockPoints) - 1));
    std::uint16_t triangle = shown == 0 ? 0 : indices.of(row.numbers[i + std::countr_zero(shown)]);
    for (int k = 0; k < shading::kBlockPoints; ++k) {
      if (shown >> k & 1) triangle = indices.of(row.numbers[i + k]);
      block.triangle[k] = triangle;
      block.x[k] = static_cast<float>(x + i + k);
      block.y[k] = static_cast<float>(y);
    }
    shade(i, shown);
  }
}

}  // namespace delray::raster
