// Cuts space into a cell for each rank by a kd-tree over clusters of triangles, and blends what a
// rank sees in its own cell (Ma, Painter, Hansen and Krogh 1994).
//
// All ranks compute the same cells without a message. A rank draws the clusters that touch its
// cell; of the surfaces at a sample those count whose point, moved into the box of its cluster,
// lies in the cell. O(clusters log clusters log ranks) to cut, once a scene.
//
// Degenerate: points on a border belong to one cell only; boxes that are infinite touch every cell.
#include "raster/distribute/scene_cells.h"

#include "composite/codec.h"
#include "composite/fragment.h"
#include "parallel/parallel_for.h"
#include "raster/distribute/rank_context.h"
#include "raster/pipeline/samples.h"

namespace delray::raster {
namespace {

// Infinite or not a number where the box or the transform is.
geometry::Box3 transformed(const glm::mat4x3& transform, const geometry::Box3& box) {
  geometry::Box3 result{transform[3], transform[3]};
  for (int k = 0; k < 3; ++k) {
    const glm::vec3 a = transform[k] * box.low[k], b = transform[k] * box.high[k];
    result.low += glm::min(a, b);
    result.high += glm::max(a, b);
  }
  return result;
}

struct PlacedCluster {
  std::uint32_t instance = 0;
  std::uint32_t first = 0;  // triangle of its mesh
};

// Where a fragment is seen, in the world, as near as its depth tells.
glm::vec3 position_of(const Screen& screen, int x, int y, float depth) {
  const scenes::View& view = screen.view;
  const float centre_x = static_cast<float>(x) + 0.5F, centre_y = static_cast<float>(y) + 0.5F;
  return view.origin(centre_x, centre_y) + view.ray(centre_x, centre_y) * distance_of(depth, view);
}

glm::vec3 moved_into(const geometry::Box3& box, glm::vec3 p) {
  for (int k = 0; k < 3; ++k) {
    if (p[k] < box.low[k]) p[k] = box.low[k];
    if (p[k] > box.high[k]) p[k] = box.high[k];
  }
  return p;
}

}  // namespace

void cut_scene(const RankContext& rank, SceneCells& known) {
  if (known.cells.cells.size() == static_cast<std::size_t>(rank.ranks())) return;
  const scenes::Scene& scene = rank.prepared.scene;
  std::vector<PlacedCluster> clusters;
  std::vector<geometry::Box3> boxes;
  std::vector<std::uint32_t> triangles;
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    const scenes::Instance& instance = scene.instances[i];
    const scenes::Mesh& mesh = scene.meshes[instance.mesh];
    MeshClusters& of_mesh = *rank.prepared.clusters.of(mesh);
    of_mesh.make(mesh, 0, static_cast<std::uint32_t>(mesh.triangles.size()));
    for (const auto& block : of_mesh.blocks) {
      for (const MeshCluster& cluster : block->clusters) {
        clusters.push_back({i, cluster.first});
        boxes.push_back(transformed(instance.transform, cluster.box));
        triangles.push_back(cluster.count);
      }
    }
  }
  known.cells = loadbalance::cut_space(boxes, triangles, rank.ranks());
  known.pieces.clear();
  const geometry::Box3& mine = known.cell(rank.number());
  for (std::size_t i = 0; i < clusters.size(); ++i) {
    if (!loadbalance::touches(mine, boxes[i])) continue;
    const auto [number, first] = clusters[i];
    const scenes::Instance& instance = scene.instances[number];
    if (!known.pieces.empty()) {
      Piece& last = known.pieces.back();
      if (last.transform == &instance.transform && last.first + last.count == first) {
        last.count += triangles[i];
        continue;
      }
    }
    known.pieces.push_back({&scene.meshes[instance.mesh], &instance.transform, first, triangles[i],
                            rank.prepared.first_primitives[number] + first});
  }
}

std::unique_ptr<composite::Layer> draw_cell(RankContext& rank, const DrawList& list,
                                            RegionDrawing& drawing, const geometry::Box3& cell) {
  constexpr std::size_t kGrain = 256;  // clusters
  std::vector<geometry::Box3> boxes(list.clusters.size());
  parallel::parallel_for(0, boxes.size(), kGrain, [&](std::size_t i) {
    const Cluster& cluster = list.clusters[i];
    boxes[i] = transformed(*list.draws[cluster.draw].transform,
                           list.block_of(cluster).clusters[cluster.part].box);
  });
  const int n = rank.options.supersampling;
  image::ImageF image(rank.options.width * n * n, rank.options.height);
  const auto blend_into = [&](const Window<image::RgbaF>& window, int x, int y,
                              std::span<const SurfaceSeen> surfaces) {
    static thread_local std::vector<composite::Fragment> inside;
    inside.clear();
    for (const SurfaceSeen& surface : surfaces) {
      const float depth = depth_of(surface.key);
      const geometry::Box3& box = boxes[number_of(surface.key) >> kClusterBits];
      if (surface.colour.a > 0 &&
          loadbalance::contains(cell, moved_into(box, position_of(rank.screen, x, y, depth))))
        inside.push_back({surface.colour, depth, 0, 0});
    }
    if (inside.empty()) return;
    const std::size_t to = window.at(x, y);
    window.colour[to] = composite::blend(inside);
    window.depth[to] = inside.front().depth;
  };
  rank.end(drawing, [&](std::span<const geometry::Rect> rects, TileView& tile) {
    for (const geometry::Rect& rect : rects) {
      const Window<image::RgbaF> window =
          n == 1 ? window_of(image) : tile_window<image::RgbaF>(rect);
      clear_pixels(rect, window);
      tile.for_each_surface(rect, [&](int x, int y, std::span<const SurfaceSeen> surfaces) {
        blend_into(window, x, y, surfaces);
      });
      if (n > 1) gather_samples(window, n, pixels_of(rect, n), image);
    }
  });
  return composite::find_codec(rank.options.codec)
      ->make(std::move(image), composite::Operator::over_with_depth);
}

}  // namespace delray::raster
