// Pages of a pack as blocks of clusters: they were cut and bounded when the pack was made.
#include "raster/packed/packed_scene.h"

namespace delray::raster {

static_assert(packs::kClusterTriangles == kClusterTriangles);
static_assert(packs::kClusterVertices == kClusterVertices);
static_assert(packs::kCornerPadding == kCornerPadding);

RasterPage::RasterPage() { clusters_.blocks.push_back(std::make_unique<ClusterBlock>()); }

double RasterPage::read(const packs::PackReader& pack, std::uint32_t number) {
  ClusterBlock& block = *clusters_.blocks.front();
  const auto exchange = [&] {
    block.vertices.swap(page_.vertices);
    block.corners.swap(page_.corners);
  };
  exchange();
  const double waited = pack.read(number, page_);
  exchange();
  block.clusters.clear();
  block.box = {};
  for (const packs::PageCluster& cluster : page_.clusters) {
    const auto vertices = std::span(block.vertices).subspan(cluster.first_vertex, cluster.vertices);
    block.clusters.push_back({cluster.first, cluster.count, cluster.first_vertex, cluster.vertices,
                              cluster.first_corner, cluster.box, cluster.cone.axis,
                              cluster.cone.cosine, cluster.cone.least_height, cluster.normals_agree,
                              first_of_consecutive(vertices)});
    block.box.include(cluster.box);
  }
  const auto of = [](const auto& values) { return values.capacity() * sizeof(values[0]); };
  constexpr std::uint64_t kOverhead = 512;  // blocks of the heap, the cache's entry
  bytes_ = kOverhead + sizeof(*this) + sizeof(ClusterBlock) + of(block.clusters) +
           of(block.vertices) + of(block.corners) + page_.bytes();
  return waited;
}

PackedScene::PackedScene(const packs::PackReader& source, const PackMemory& memory)
    : pack(source),
      cache(
          static_cast<std::uint32_t>(source.pages().size()),
          [&source](std::uint32_t page, std::unique_ptr<packs::CachedPage> made) {
            if (made == nullptr) made = std::make_unique<RasterPage>();
            const double waited = static_cast<RasterPage&>(*made).read(source, page);
            return packs::PageCache::Made{std::move(made), waited};
          },
          [&source](std::uint32_t page) { return source.pages()[page].bytes; }, memory.cache_bytes),
      one_frame(memory.one_frame) {
  for (const packs::MeshRow& mesh : source.meshes()) {
    std::vector<packs::PageTree>& levels = trees.emplace_back();
    for (const packs::PageRange& range : mesh.levels)
      levels.emplace_back(source.pages(), range, source.groups());
  }
}

}  // namespace delray::raster
