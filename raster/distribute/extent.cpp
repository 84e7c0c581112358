// Adds up the boxes and rounded areas of a run of triangles, cluster by cluster: those that show
// nothing by their own box or cone are passed over, the others are transformed and bounded by
// vectors, once for all groups that follow each other in them.
//
// O(triangles). Degenerate: clusters that reach outside of the guard band or before the near plane
// are set up triangle by triangle, as are large triangles.
#include "raster/distribute/extent.h"

#include <algorithm>

#include "raster/pipeline/cull.h"
#include "raster/pipeline/set_up.h"

namespace delray::raster {
namespace {

void include(const geometry::Rect& pixels, geometry::Rect& box) {
  box = {std::min(box.x0, pixels.x0), std::min(box.y0, pixels.y0), std::max(box.x1, pixels.x1),
         std::max(box.y1, pixels.y1)};
}

}  // namespace

void Extents::look_at(const PreparedDraw& draw, const ClusterBlock& block,
                      const MeshCluster& cluster) {
  if (cluster_ == &cluster && draw_ == &draw) return;
  cluster_ = &cluster;
  draw_ = &draw;
  const ClusterBounds bounds = bound(screen_, draw, cluster.box);
  may_be_seen_ = !bounds.outside && !shows_hidden_side_only(screen_, draw, cluster, bounds);
  if (!may_be_seen_) return;
  transform(draw.to_view, screen_, draw.draw->mesh->positions, block.vertices_of(cluster),
            vertices_);
  if (!vertices_.any_outside) find_boxes({screen_, draw, block, cluster, vertices_}, boxes_);
}

Extent Extents::of(const PreparedDraw& draw, std::uint32_t first, std::uint32_t count,
                   std::vector<ScreenTriangle>& large) {
  Extent result;
  result.box = {screen_.width, screen_.height, 0, 0};
  const auto include_triangle = [&](const ScreenTriangle& triangle, const geometry::Rect& pixels) {
    include(pixels, result.box);
    ++result.triangles;
    if (pixels.area() > kLargeBox) {
      large.push_back(triangle);
      return;
    }
    const std::int64_t area =
        doubled_area(triangle.vertex[0], triangle.vertex[1], triangle.vertex[2]) >>
        (2 * kSubpixelBits + 1);
    result.pixels += std::min<std::int64_t>(area + 1, pixels.area());
  };
  const std::uint32_t end = first + count;
  for (std::uint32_t t = first, next; t < end; t = next) {
    const ClusterBlock& block = *draw.draw->clusters->blocks[t >> kBlockBits];
    const MeshCluster& cluster = block.clusters[part_with(block, t)];
    next = std::min(end, cluster.first + cluster.count);
    look_at(draw, block, cluster);
    if (!may_be_seen_) continue;
    const std::uint32_t place = t - cluster.first, last = next - cluster.first;
    if (!vertices_.any_outside) {
      const SumOfBoxes sum = sum_of(boxes_, place, last);
      result.triangles += sum.triangles;
      result.pixels += sum.pixels;
      if (sum.triangles > 0) include(sum.box, result.box);
      if (!boxes_.any_alone) continue;
    }
    for (std::uint32_t p = place; p < last; ++p)
      if (vertices_.any_outside || boxes_.pixels[p] == TriangleBoxes::kAlone)
        set_up(screen_, draw, vertices_, corners_at(block, cluster, p), cluster.first + p, 0,
               include_triangle);
  }
  if (result.triangles == 0) result.box = {};
  return result;
}

}  // namespace delray::raster
