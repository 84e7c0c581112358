// Descends the trees of pages with the bounds that clusters are culled by. With a bound of error,
// of each group either its pages are taken, or what was made of them, by the same comparison on
// both sides.
//
// Degenerate: orthographic views and skew transforms have no cones; boxes that reach before the
// near plane may touch all of the screen.
#include "raster/packed/visible_pages.h"

#include <algorithm>

#include "raster/packed/error_on_screen.h"
#include "raster/pipeline/cull.h"

namespace delray::raster {

namespace {

geometry::Box3 grown(const geometry::Box3& box, float by) { return {box.low - by, box.high + by}; }

}  // namespace

float widening_of(const RankContext& rank, const PackedScene& packed, const scenes::Mesh& mesh,
                  std::uint32_t page) {
  const std::uint32_t group = packed.pack.pages()[page].made_of;
  if (mesh.has_triangles() || group == packs::kNoGroup || !(rank.options.error > 0)) return 0;
  const float error = packed.pack.groups()[group].error;
  return mesh.shape.in_pixels && error > 0 ? static_cast<float>(rank.options.error) : error;
}

std::vector<PlacedPage> visible_pages(const RankContext& rank, const PackedScene& packed) {
  std::vector<PlacedPage> pages;
  const scenes::Scene& scene = rank.prepared.scene;
  const double most = rank.options.error * rank.options.supersampling;
  const std::span<const packs::Group> groups = packed.pack.groups();
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    const scenes::Instance& instance = scene.instances[i];
    const scenes::Mesh& mesh = scene.meshes[instance.mesh];
    const bool in_pixels = !mesh.has_triangles() && mesh.shape.in_pixels;
    const bool grows = most > 0 && !mesh.has_triangles() && !mesh.shape.in_pixels;
    const Draw draw{&mesh, &instance.transform, nullptr, nullptr,
                    in_pixels ? static_cast<float>(rank.options.error) : 0};
    const PreparedDraw prepared =
        prepare_draw(rank.screen, draw, rank.prepared.shader(), rank.options.cull_single_sided);
    const ErrorOnScreen error(rank.screen, prepared, most > 0 ? most : 1);
    const auto visit = [&](const packs::PageTree::Node& node) {
      if (most > 0 && error.allows(node.error, node.bounds)) return false;  // coarser ones will do
      return !bound(rank.screen, prepared, grows ? grown(node.box, node.made_error) : node.box)
                  .outside;
    };
    const auto look_at = [&](std::uint32_t number) {
      const packs::PageRow& row = packed.pack.pages()[number];
      if (most > 0) {
        if (row.simplified_in != packs::kNoGroup && error.allows(groups[row.simplified_in])) return;
        if (row.made_of != packs::kNoGroup && !error.allows(groups[row.made_of])) return;
      }
      const float widening = grows ? widening_of(rank, packed, mesh, number) : 0;
      const ClusterBounds bounds =
          bound(rank.screen, prepared, widening > 0 ? grown(row.box, widening) : row.box);
      if (bounds.outside) return;
      MeshCluster all;
      all.box = row.box;
      all.axis = row.cone.axis;
      all.cosine = row.cone.cosine;
      all.least_height = row.cone.least_height;
      if (shows_hidden_side_only(rank.screen, prepared, all, bounds)) return;
      pages.push_back({i, number, bounds.pixels, bounds.nearest});
    };
    const std::vector<packs::PageTree>& levels = packed.trees[instance.mesh];
    for (std::size_t level = 0; level < (most > 0 ? levels.size() : 1); ++level)
      levels[level].descend(visit, look_at);
  }
  return pages;
}

std::vector<PlacedPage> share_of_pages(const PackedScene& packed, std::vector<PlacedPage>&& pages,
                                       int rank, int ranks) {
  if (ranks == 1) return std::move(pages);
  const auto triangles = [&](const PlacedPage& page) {
    return std::uint64_t{packed.pack.pages()[page.page].triangles};
  };
  std::uint64_t all = 0, before = 0;
  for (const PlacedPage& page : pages) all += triangles(page);
  const auto begin = [&](int k) {
    return all * static_cast<std::uint64_t>(k) / static_cast<std::uint64_t>(ranks);
  };
  std::vector<PlacedPage> mine;
  for (const PlacedPage& page : pages) {
    if (begin(rank) <= before && before < begin(rank + 1)) mine.push_back(page);
    before += triangles(page);
  }
  return mine;
}

}  // namespace delray::raster
