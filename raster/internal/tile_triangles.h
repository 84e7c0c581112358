// The triangles that a tile shows, ready to be shaded by vectors.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "parallel/function_ref.h"
#include "raster/internal/point_planes.h"
#include "raster/internal/shade_tile.h"
#include "raster/internal/tile_groups.h"
#include "raster/internal/tile_runs.h"

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
  void for_each_group(const FrameShading& frame, Wanted wanted, SetUp set_up);
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

  // Writes colours and depths of what was found to the window. shade_row(starts, runs, x, y, count,
  // pixels) stores a row's colours, as in internal/shade_row.h.
  template <class Colour>
  using ShadeRow =
      parallel::FunctionRef<void(std::uint64_t, const std::uint16_t*, int, int, int, Colour*)>;
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
  void ask_for(const FrameShading& frame);
  static void number_vertices(std::span<const std::uint32_t> vertices, ClusterMembers& members);
  void collect(const FrameShading& frame, const Group& group, ClusterMembers& members);
  void set_up_clipped(const FrameShading& frame, const ClusterMembers& members, std::size_t member,
                      ClusterFacing& facing);

  TileRuns runs_;
  TileGroups groups_;
  RunTriangles run_triangles_;
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
void for_each_block(std::uint64_t starts, const std::uint16_t* run, int x, int y, int count,
                    PixelBlock& block, F&& shade) {
  starts &= ~std::uint64_t{1};  // the first run has begun
  for (int i = 0; i < count; i += shading::kBlockPoints) {
    shading::LaneMask shown = 0;
    std::uint16_t some = kNoTriangle;
    for (int k = 0; k < shading::kBlockPoints; ++k) {
      if (i + k < count) run += starts >> (i + k) & 1;
      const bool drawn = *run != kNoTriangle && i + k < count;
      shown |= shading::LaneMask{drawn} << k;
      block.triangle[k] = *run;
      block.x[k] = static_cast<float>(x + i + k);
      block.y[k] = static_cast<float>(y);
      if (drawn) some = *run;
    }
    for (std::uint16_t& triangle : block.triangle)
      if (triangle == kNoTriangle) triangle = some;
    shade(i, shown);
  }
}

}  // namespace delray::raster
