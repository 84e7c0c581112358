// Vertices are renumbered in the order in which triangles use them. O(n log n) of the items of a
// cluster.
#include "raytrace/clusters/cluster_items.h"

#include <algorithm>
#include <utility>

namespace delray::raytrace {
namespace {

template <class T>
void take(const std::vector<T>& from, std::span<const std::uint32_t> vertices, std::vector<T>& to) {
  if (from.empty()) return;
  to.reserve(vertices.size());
  for (const std::uint32_t v : vertices) to.push_back(from[v]);
}

Piece piece_of(const GeometryInstance& instance, std::span<const ClusterItem> items,
               std::uint32_t first_triangle) {
  const scenes::Mesh& mesh = *instance.mesh;
  Piece piece;
  piece.mesh.material = mesh.material;
  piece.mesh.shape = mesh.shape;
  std::unordered_map<std::uint32_t, std::uint32_t> known;
  known.reserve(items.size());
  std::vector<std::uint32_t> vertices;
  const auto number = [&](std::uint32_t vertex) {
    const auto [at, added] = known.try_emplace(vertex, static_cast<std::uint32_t>(known.size()));
    if (added) vertices.push_back(vertex);
    return at->second;
  };
  piece.mesh.triangles.reserve(items.size());
  piece.triangles.reserve(items.size());
  for (const ClusterItem& item : items) {
    const glm::uvec3 corners = mesh.triangles[item.triangle];
    const std::uint32_t x = number(corners.x), y = number(corners.y), z = number(corners.z);
    piece.mesh.triangles.emplace_back(x, y, z);
    piece.triangles.push_back(first_triangle + item.triangle);
  }
  piece.mesh.positions.reserve(vertices.size() + 1);  // Embree loads past the last one
  for (const std::uint32_t v : vertices) piece.mesh.positions.push_back(instance.positions[v]);
  take(mesh.normals, vertices, piece.mesh.normals);
  take(mesh.uvs, vertices, piece.mesh.uvs);
  take(mesh.uvs2, vertices, piece.mesh.uvs2);
  take(mesh.tangents, vertices, piece.mesh.tangents);
  take(mesh.colours, vertices, piece.mesh.colours);
  return piece;
}

GeometryInstance without_pointers(const GeometryInstance& from, std::uint32_t piece) {
  GeometryInstance p;
  p.mesh_number = piece;
  p.material = from.material;
  p.instanced = from.instanced;
  p.identity = from.identity;
  p.see_through = from.see_through;
  p.layered = from.layered;
  p.texture_sets = from.texture_sets;
  p.orientation = from.orientation;
  p.to_world = from.to_world;
  p.normal_to_world = from.normal_to_world;
  p.transform_scale = from.transform_scale;
  return p;
}

}  // namespace

glm::vec3 centre_of(const GeometryInstance& instance, std::uint32_t triangle) {
  const glm::uvec3 corners = instance.mesh->triangles[triangle];
  const glm::vec3 sum =
      instance.positions[corners.x] + instance.positions[corners.y] + instance.positions[corners.z];
  return sum * (1.0F / 3.0F);
}

PlacedMeshes placed_meshes(std::span<const GeometryInstance> instances) {
  PlacedMeshes placed;
  for (std::uint32_t i = 0; i < instances.size(); ++i)
    if (instances[i].instanced) placed[instances[i].mesh_number].push_back(i);
  return placed;
}

bool is_stored(std::span<const GeometryInstance> instances, const PlacedMeshes& placed,
               std::uint32_t i) {
  const GeometryInstance& instance = instances[i];
  if (instance.mesh == nullptr) return false;
  return !instance.instanced || placed.at(instance.mesh_number).front() == i;
}

ClusterData cluster_of_items(std::span<ClusterItem> items,
                             std::span<const GeometryInstance> instances,
                             const PlacedMeshes& placed, std::uint32_t first_triangle) {
  std::sort(items.begin(), items.end(), [](const ClusterItem& a, const ClusterItem& b) {
    return std::pair(a.instance, a.triangle) < std::pair(b.instance, b.triangle);
  });
  ClusterData cluster;
  for (std::size_t first = 0; first < items.size();) {
    std::size_t last = first;
    const std::uint32_t number = items[first].instance;
    while (last < items.size() && items[last].instance == number) ++last;
    const GeometryInstance& instance = instances[number];
    const auto index = static_cast<std::uint32_t>(cluster.pieces.size());
    Piece& piece = cluster.pieces.emplace_back(
        piece_of(instance, items.subspan(first, last - first), first_triangle));
    piece.instances =
        instance.instanced ? placed.at(instance.mesh_number) : std::vector<std::uint32_t>{number};
    for (const std::uint32_t i : piece.instances)
      cluster.instances.push_back(without_pointers(instances[i], index));
    first = last;
  }
  return cluster;
}

}  // namespace delray::raytrace
