// Runs of pages as small scenes, which become geometry instances and one cluster in the way that
// whole scenes do; what depends on all of a mesh, how large its coordinates are, comes from the
// pack's table.
//
// Degenerate: a mesh that no instance places has no clusters.
#include "raytrace/distributed/packed_clusters.h"

#include <limits>

#include "packs/unpack.h"
#include "raytrace/scene/splat_hits.h"

namespace delray::raytrace {
namespace {

// Some thousand triangles: what a ray wants is then mostly what others near to it want, too.
constexpr std::uint32_t kPages = 8;

// Beyond the rounding of a transform and of Embree's intersection, relative to the largest number
// that takes part.
constexpr float kSlack = 0x1p-16F;

// The box of what is placed, and around it what rounding and the radius of points add.
geometry::Box3 placed_box(const geometry::Box3& box, const GeometryInstance& instance,
                          float radius) {
  geometry::Box3 placed;
  for (int k = 0; k < 8; ++k) {
    const glm::vec3 corner((k & 1) != 0 ? box.high.x : box.low.x,
                           (k & 2) != 0 ? box.high.y : box.low.y,
                           (k & 4) != 0 ? box.high.z : box.low.z);
    placed.include(instance.identity ? corner : instance.to_world * glm::vec4(corner, 1.0F));
  }
  float reach = instance.identity ? 0.0F : instance.transform_scale;
  for (int k = 0; k < 3; ++k)
    reach = std::max({reach, std::abs(placed.low[k]), std::abs(placed.high[k])});
  const glm::vec3 slack(reach * kSlack + radius);
  return {placed.low - slack, placed.high + slack};
}

// Instances of a scene whose meshes have nothing but the extent of what was packed.
std::vector<GeometryInstance> instances_of(const packs::PackReader& pack,
                                           const scenes::Scene& scene,
                                           const shading::Shader& shader, bool share_meshes) {
  scenes::Scene extents;
  extents.instances = scene.instances;
  extents.animations.motions = scene.animations.motions;
  for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
    scenes::Mesh& mesh = extents.meshes.emplace_back();
    mesh.shape = scene.meshes[m].shape;
    mesh.material = scene.meshes[m].material;
    mesh.positions = {pack.meshes()[m].box.low, pack.meshes()[m].box.high};
  }
  std::vector<GeometryInstance> instances = make_instances(extents, shader, share_meshes);
  for (GeometryInstance& instance : instances) {
    instance.mesh = nullptr;  // as `extents` will be gone
    instance.positions = nullptr;
  }
  return instances;
}

}  // namespace

PackedClusters::PackedClusters(const packs::PackReader& pack, const scenes::Scene& scene,
                               const shading::Shader& shader, bool share_meshes)
    : pack_(pack),
      scene_(scene),
      share_meshes_(share_meshes),
      instances_(instances_of(pack, scene, shader, share_meshes)),
      placed_(scene.meshes.size()) {
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i)
    placed_[scene.instances[i].mesh].push_back(i);
  for (std::uint32_t m = 0; m < placed_.size(); ++m) {
    if (placed_[m].empty()) continue;
    const packs::PageRange& pages = pack.meshes()[m].levels.front();
    for (std::uint32_t first = 0; first < pages.count; first += kPages) {
      const Run run{m, pages.first + first, std::min(kPages, pages.count - first)};
      const auto number = static_cast<std::uint32_t>(runs_.size());
      for (const std::uint32_t i : placed_[m]) {
        const GeometryInstance& instance = instances_[i];
        const scenes::Shape& shape = scene.meshes[m].shape;
        const float radius =
            shape.kind == scenes::Shape::Kind::triangle ? 0.0F : splat_radius(instance, shape);
        geometry::Box3 all;
        for (std::uint32_t page = run.first; page < run.first + run.count; ++page) {
          const geometry::Box3 box = placed_box(pack.pages()[page].box, instance, radius);
          if (!instance.instanced) boxes_.push_back({box, number});
          all.include(box);
        }
        if (instance.instanced) boxes_.push_back({all, number});
      }
      runs_.push_back(run);
    }
  }
}

bool PackedClusters::is_instanced(std::uint32_t cluster) const {
  return instances_[placed_[runs_[cluster].mesh].front()].instanced;
}

std::uint64_t PackedClusters::bytes(std::uint32_t cluster) const {
  const Run& run = runs_[cluster];
  const packs::MeshRow& mesh = pack_.meshes()[run.mesh];
  std::uint64_t bytes = 0;
  for (const packs::PageRow& row : pack_.pages().subspan(run.first, run.count)) {
    bytes += row.triangles * (sizeof(glm::uvec3) + sizeof(std::uint32_t)) +
             row.vertices * (sizeof(glm::vec3) + mesh.attributes.bytes());
  }
  return bytes * (is_instanced(cluster) ? 1 : placed_[run.mesh].size());
}

std::uint64_t PackedClusters::bytes_in_file(std::uint32_t cluster) const {
  const Run& run = runs_[cluster];
  std::uint64_t bytes = 0;
  for (const packs::PageRow& row : pack_.pages().subspan(run.first, run.count)) bytes += row.bytes;
  return bytes;
}

scenes::Mesh PackedClusters::mesh_of(const Run& run) const {
  scenes::Mesh mesh;
  for (std::uint32_t page = run.first; page < run.first + run.count; ++page)
    packs::append_page(pack_.read(page).mesh, mesh);
  mesh.shape = scene_.meshes[run.mesh].shape;
  mesh.material = scene_.meshes[run.mesh].material;
  return mesh;
}

ClusterData PackedClusters::read(std::uint32_t cluster, const shading::Shader& shader) const {
  const Run& run = runs_[cluster];
  const std::vector<std::uint32_t>& placed = placed_[run.mesh];
  scenes::Scene scene;
  scene.meshes.push_back(mesh_of(run));
  for (const std::uint32_t i : placed)
    scene.instances.push_back({0, scene_.instances[i].transform});
  if (const auto& motions = scene_.animations.motions; !motions.empty())
    scene.animations.motions = {motions[run.mesh]};
  std::vector<GeometryInstance> instances = make_instances(scene, shader, share_meshes_);
  for (std::size_t i = 0; i < placed.size(); ++i)
    instances[i].transform_scale = instances_[placed[i]].transform_scale;
  std::vector<ClusterData> clusters =
      cut_clusters(instances, 0, stored_triangles(instances),
                   std::numeric_limits<std::uint32_t>::max(), pack_.pages()[run.first].first);
  for (Piece& piece : clusters.front().pieces)
    for (std::uint32_t& instance : piece.instances) instance = placed[instance];
  return std::move(clusters.front());
}

}  // namespace delray::raytrace
