// Adds up the boxes and rounded areas of a run of triangles, cluster by cluster: those that show
// nothing by their own box or cone are passed over, the others are transformed and bounded by
// vectors, once for all groups that follow each other in them.
//
// Where triangles are so small that a run has whole clusters, most of these are not looked at:
// their neighbour's triangles and pixels, and the box of their box, are near enough for costs.
//
// O(triangles looked at + clusters). Degenerate: clusters that reach outside of the guard band or
// before the near plane are set up triangle by triangle, as are large triangles.
#include "raster/distribute/extent.h"

#include <algorithm>

#include "raster/pipeline/cull.h"
#include "raster/pipeline/set_up.h"

namespace delray::raster {
namespace {

// Triangles of a cluster that may stand for others, or they for it.
constexpr std::uint32_t kFullEnough = kClusterTriangles / 2;

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
  bounds_ = bounds.pixels;
  may_be_seen_ = !bounds.outside && !shows_hidden_side_only(screen_, draw, cluster, bounds);
  if (!may_be_seen_) return;
  transform(draw.to_view, screen_, draw.draw->mesh->positions, block.vertices_of(cluster),
            vertices_);
  if (vertices_.any_outside) return;
  find_boxes({screen_, draw, block, cluster, vertices_}, boxes_);
  sum_ = sum_of(boxes_, 0, cluster.count);
}

bool Extents::lies_within(const geometry::Rect& pixels) const {
  return pixels.x0 > 0 && pixels.y0 > 0 && pixels.x1 < screen_.width &&
         pixels.y1 < screen_.height && pixels.area() <= kLargeBox;
}

// Looks at the first of the cluster's neighbours that shows anything, unless that has been done.
void Extents::look_at_neighbours(const PreparedDraw& draw, const ClusterBlock& block,
                                 std::uint32_t part) {
  const std::uint32_t first = part / kMeasured * kMeasured;
  if (neighbours_.first == &block.clusters[first] && neighbours_.draw == &draw) return;
  neighbours_ = {&draw, &block.clusters[first], nullptr, {}, {}};
  const auto end = std::min(first + kMeasured, static_cast<std::uint32_t>(block.clusters.size()));
  for (std::uint32_t i = first; i < end; ++i) {
    const MeshCluster& cluster = block.clusters[i];
    if (cluster.count < kFullEnough) continue;
    look_at(draw, block, cluster);
    if (!may_be_seen_ || (!vertices_.any_outside && sum_.triangles == 0)) continue;
    if (!vertices_.any_outside && lies_within(bounds_)) {
      neighbours_.measured = &cluster;
      neighbours_.bounds = bounds_;
      neighbours_.sum = sum_;
    }
    return;
  }
}

// Adds a whole cluster by what a neighbour shows, unless there is reason to look at it: it is the
// one that is looked at, has few triangles, or reaches the border; or no neighbour will do.
bool Extents::estimate(const PreparedDraw& draw, const ClusterBlock& block, std::uint32_t part,
                       Extent& result) {
  const MeshCluster& cluster = block.clusters[part];
  if (cluster.count < kFullEnough) return false;
  const ClusterBounds bounds = bound(screen_, draw, cluster.box);
  if (bounds.outside || shows_hidden_side_only(screen_, draw, cluster, bounds)) return true;
  if (!lies_within(bounds.pixels)) return false;
  look_at_neighbours(draw, block, part);
  if (neighbours_.measured == nullptr || neighbours_.measured == &cluster) return false;
  // As many for each pixel of the box: the nearer of two is larger.
  const auto box = static_cast<std::uint64_t>(bounds.pixels.area());
  const auto of_neighbour = static_cast<std::uint64_t>(neighbours_.bounds.area());
  const auto like_neighbour = [&](std::uint64_t amount) {
    return std::max<std::uint64_t>(1, amount * box / of_neighbour);
  };
  include(bounds.pixels, result.box);
  result.triangles += like_neighbour(neighbours_.sum.triangles);
  result.pixels += like_neighbour(neighbours_.sum.pixels);
  return true;
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
    const std::uint32_t part = part_with(block, t);
    const MeshCluster& cluster = block.clusters[part];
    next = std::min(end, cluster.first + cluster.count);
    const std::uint32_t place = t - cluster.first, last = next - cluster.first;
    const bool is_whole = last - place == cluster.count;
    if (is_whole && estimate(draw, block, part, result)) continue;
    look_at(draw, block, cluster);
    if (!may_be_seen_) continue;
    if (!vertices_.any_outside) {
      const SumOfBoxes sum = is_whole ? sum_ : sum_of(boxes_, place, last);
      result.triangles += sum.triangles;
      result.pixels += sum.pixels;
      if (sum.triangles > 0) include(sum.box, result.box);
      if (!boxes_.any_alone) continue;
    }
    for (std::uint32_t p = place; p < last; ++p) {
      if (vertices_.any_outside || boxes_.pixels[p] == TriangleBoxes::kAlone)
        set_up({screen_, draw, block, cluster, vertices_}, p, 0, include_triangle);
    }
  }
  if (result.triangles == 0) result.box = {};
  return result;
}

}  // namespace delray::raster
