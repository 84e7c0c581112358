// Pages of a pack as blocks of clusters: they were cut and bounded when the pack was made.
#include "raster/packed/packed_scene.h"

namespace delray::raster {

static_assert(packs::kClusterTriangles == kClusterTriangles);
static_assert(packs::kClusterVertices == kClusterVertices);
static_assert(packs::kCornerPadding == kCornerPadding);

RasterPage::RasterPage(packs::Page&& page) : mesh(std::move(page.mesh)) {
  auto block = std::make_unique<ClusterBlock>();
  for (const packs::PageCluster& cluster : page.clusters) {
    block->clusters.push_back({cluster.first, cluster.count, cluster.first_vertex, cluster.vertices,
                               cluster.first_corner, cluster.box, cluster.cone.axis,
                               cluster.cone.cosine, cluster.cone.least_height,
                               cluster.normals_agree});
    block->box.include(cluster.box);
  }
  block->vertices = std::move(page.vertices);
  block->corners = std::move(page.corners);
  clusters.blocks.push_back(std::move(block));
  const ClusterBlock& made = *clusters.blocks.front();
  const auto of = [](const auto& values) { return values.capacity() * sizeof(values[0]); };
  constexpr std::uint64_t kOverhead = 512;  // blocks of the heap, the cache's entry
  bytes_ = kOverhead + sizeof(*this) + sizeof(ClusterBlock) + of(made.clusters) +
           of(made.vertices) + of(made.corners) + of(mesh.positions) + of(mesh.normals) +
           of(mesh.uvs) + of(mesh.uvs2) + of(mesh.tangents) + of(mesh.colours) + of(mesh.triangles);
}

PackedScene::PackedScene(const packs::PackReader& source, const PackMemory& memory)
    : pack(source),
      cache(
          [&source](std::uint32_t page) {
            return std::make_shared<const RasterPage>(source.read(page));
          },
          [&source](std::uint32_t page) { return source.pages()[page].bytes; }, memory.cache_bytes,
          memory.fetch_threads) {
  for (const packs::MeshRow& mesh : source.meshes()) {
    std::vector<packs::PageTree>& levels = trees.emplace_back();
    for (const packs::PageRange& range : mesh.levels)
      levels.emplace_back(source.pages(), range, source.groups());
  }
}

}  // namespace delray::raster
