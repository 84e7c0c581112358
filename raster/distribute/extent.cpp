// Sets up a run of triangles without drawing them, and adds up their boxes and rounded areas. A
// cluster's vertices are transformed once for all groups that follow each other in it.
#include "raster/distribute/extent.h"

#include <algorithm>

#include "raster/pipeline/set_up.h"

namespace delray::raster {

Extent Extents::of(const PreparedDraw& draw, std::uint32_t first, std::uint32_t count,
                   std::vector<ScreenTriangle>& large) {
  Extent result;
  result.box = {screen_.width, screen_.height, 0, 0};
  const auto include = [&](const ScreenTriangle& triangle, const geometry::Rect& pixels) {
    result.box = {std::min(result.box.x0, pixels.x0), std::min(result.box.y0, pixels.y0),
                  std::max(result.box.x1, pixels.x1), std::max(result.box.y1, pixels.y1)};
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
  for (std::uint32_t t = first; t < end;) {
    const ClusterBlock& block = *draw.draw->clusters->blocks[t >> kBlockBits];
    const MeshCluster& cluster = block.clusters[part_with(block, t)];
    if (cluster_ != &cluster || draw_ != &draw) {
      transform(draw.to_view, screen_, draw.draw->mesh->positions, block.vertices_of(cluster),
                vertices_);
      cluster_ = &cluster;
      draw_ = &draw;
    }
    for (; t < std::min(end, cluster.first + cluster.count); ++t) {
      set_up(screen_, draw, vertices_, corners_at(block, cluster, t - cluster.first), t, 0,
             include);
    }
  }
  if (result.triangles == 0) result.box = {};
  return result;
}

}  // namespace delray::raster
