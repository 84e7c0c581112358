// Cuts triangles into clusters: halves at the median along the longest side of the box of their
// centres, until a part is small enough. Meshes that are placed several times are cut by
// themselves, so that their clusters can be instanced.
//
// O(n log n). Degenerate: equal centres are ordered by number, so that every part shrinks.
#include <algorithm>
#include <tuple>

#include "raytrace/clusters/cluster_items.h"

namespace delray::raytrace {
namespace {

class Cutter {
 public:
  Cutter(std::span<const GeometryInstance> instances, const PlacedMeshes& placed,
         std::uint32_t most, std::uint32_t first_triangle)
      : instances_(instances), placed_(placed), most_(most), first_triangle_(first_triangle) {}

  void cut(std::span<ClusterItem> items) {
    if (items.empty()) return;
    if (items.size() <= most_) {
      clusters.push_back(cluster_of_items(items, instances_, placed_, first_triangle_));
      return;
    }
    glm::vec3 low = items.front().centre, high = low;
    for (const ClusterItem& item : items) {
      low = glm::min(low, item.centre);
      high = glm::max(high, item.centre);
    }
    const glm::vec3 size = high - low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t half = items.size() / 2;
    std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(half), items.end(),
                     [axis](const ClusterItem& a, const ClusterItem& b) {
                       return std::tuple(a.centre[axis], a.instance, a.triangle) <
                              std::tuple(b.centre[axis], b.instance, b.triangle);
                     });
    cut(items.first(half));
    cut(items.subspan(half));
  }

  std::vector<ClusterData> clusters;

 private:
  std::span<const GeometryInstance> instances_;
  const PlacedMeshes& placed_;
  std::uint32_t most_, first_triangle_;
};

}  // namespace

std::uint64_t stored_triangles(std::span<const GeometryInstance> instances) {
  const PlacedMeshes placed = placed_meshes(instances);
  std::uint64_t sum = 0;
  for (std::uint32_t i = 0; i < instances.size(); ++i)
    if (is_stored(instances, placed, i)) sum += instances[i].mesh->triangles.size();
  return sum;
}

std::vector<ClusterData> cut_clusters(std::span<const GeometryInstance> instances,
                                      std::uint64_t begin, std::uint64_t end, std::uint32_t most,
                                      std::uint32_t first_triangle) {
  const PlacedMeshes placed = placed_meshes(instances);
  Cutter cutter(instances, placed, most, first_triangle);
  for_cluster_items(instances, placed, begin, end,
                    [&](std::span<ClusterItem> items, bool) { cutter.cut(items); });
  return std::move(cutter.clusters);
}

}  // namespace delray::raytrace
