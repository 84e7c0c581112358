// Descends the trees of pages with the bounds that clusters are culled by. With a bound of error,
// of each group either its pages are taken, or what was made of them, by the same comparison on
// both sides.
//
// Degenerate: orthographic views and skew transforms have no cones; boxes that reach before the
// near plane may touch all of the screen.
#include "raster/packed/visible_pages.h"

#include <algorithm>

#include "parallel/parallel_for.h"
#include "raster/packed/error_on_screen.h"
#include "raster/pipeline/cull.h"

namespace delray::raster {

namespace {

geometry::Box3 grown(const geometry::Box3& box, float by) { return {box.low - by, box.high + by}; }

// See PlacedPage.
float widening_of(const RankContext& rank, const PackedScene& packed, const scenes::Mesh& mesh,
                  const packs::PageRow& row) {
  if (mesh.has_triangles() || row.made_of == packs::kNoGroup || !(rank.options.error > 0)) return 0;
  const float error = packed.pack.groups()[row.made_of].error;
  return mesh.shape.in_pixels && error > 0 ? static_cast<float>(rank.options.error) : error;
}

}  // namespace

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
    const auto shows = [&](std::uint32_t number, PlacedPage& placed) {
      const packs::PageRow& row = packed.pack.pages()[number];
      if (most > 0) {
        if (row.simplified_in != packs::kNoGroup && error.allows(groups[row.simplified_in]))
          return false;
        if (row.made_of != packs::kNoGroup && !error.allows(groups[row.made_of])) return false;
      }
      const float widening = widening_of(rank, packed, mesh, row);
      const ClusterBounds bounds =
          bound(rank.screen, prepared, grows && widening > 0 ? grown(row.box, widening) : row.box);
      if (bounds.outside) return false;
      MeshCluster all;
      all.box = row.box;
      all.axis = row.cone.axis;
      all.cosine = row.cone.cosine;
      all.least_height = row.cone.least_height;
      if (shows_hidden_side_only(rank.screen, prepared, all, bounds)) return false;
      const std::uint64_t bytes =
          row.bytes_in_memory(packed.pack.meshes()[instance.mesh].attributes);
      placed = {i,
                number,
                bounds.pixels,
                bounds.nearest,
                widening,
                static_cast<std::uint32_t>(bytes),
                row.triangles,
                row.clusters,
                row.level};
      return true;
    };
    std::vector<std::uint32_t> looked_at;
    const std::vector<packs::PageTree>& levels = packed.trees[instance.mesh];
    for (std::size_t level = 0; level < (most > 0 ? levels.size() : 1); ++level)
      levels[level].descend(visit, [&](std::uint32_t number) { looked_at.push_back(number); });
    std::vector<PlacedPage> placed(looked_at.size());
    std::vector<std::uint8_t> is_seen(looked_at.size());
    constexpr std::size_t kGrain = 256;
    parallel::parallel_for(0, looked_at.size(), kGrain, [&](std::size_t k) {
      is_seen[k] = shows(looked_at[k], placed[k]) ? 1 : 0;
    });
    for (std::size_t k = 0; k < placed.size(); ++k)
      if (is_seen[k] != 0) pages.push_back(placed[k]);
  }
  return pages;
}

std::vector<PlacedPage> share_of_pages(std::vector<PlacedPage>&& pages, int rank, int ranks) {
  if (ranks == 1) return std::move(pages);
  std::uint64_t all = 0, before = 0;
  for (const PlacedPage& page : pages) all += page.triangles;
  const auto begin = [&](int k) {
    return all * static_cast<std::uint64_t>(k) / static_cast<std::uint64_t>(ranks);
  };
  std::vector<PlacedPage> mine;
  for (const PlacedPage& page : pages) {
    if (begin(rank) <= before && before < begin(rank + 1)) mine.push_back(page);
    before += page.triangles;
  }
  return mine;
}

}  // namespace delray::raster
