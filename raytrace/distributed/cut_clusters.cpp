// Cuts triangles into clusters: halves at the median along the longest side of the box of their
// centres, until a part is small enough. Meshes that are placed several times are cut by
// themselves, so that their clusters can be instanced.
//
// A cluster gets the vertices that its triangles use, renumbered. O(n log n). Degenerate: equal
// centres are ordered by number, so that every part shrinks.
#include <algorithm>
#include <unordered_map>

#include "raytrace/distributed/cluster.h"

namespace delray::raytrace {
namespace {

struct Item {
  glm::vec3 centre;
  std::uint32_t instance, triangle;  // triangle: in the instance's mesh as it is at hand
};

glm::vec3 centre_of(const GeometryInstance& instance, std::uint32_t triangle) {
  const glm::uvec3 corners = instance.mesh->triangles[triangle];
  const glm::vec3 sum =
      instance.positions[corners.x] + instance.positions[corners.y] + instance.positions[corners.z];
  return sum * (1.0F / 3.0F);
}

// The first instance of each mesh that is placed several times, and where the others are.
using Placed = std::unordered_map<std::uint32_t, std::vector<std::uint32_t>>;

Placed instances_of_meshes(std::span<const GeometryInstance> instances) {
  Placed placed;
  for (std::uint32_t i = 0; i < instances.size(); ++i)
    if (instances[i].instanced) placed[instances[i].mesh_number].push_back(i);
  return placed;
}

// Whether its triangles count: each mesh that is placed several times counts once.
bool is_stored(std::span<const GeometryInstance> instances, const Placed& placed, std::uint32_t i) {
  const GeometryInstance& instance = instances[i];
  if (instance.mesh == nullptr) return false;
  return !instance.instanced || placed.at(instance.mesh_number).front() == i;
}

template <class T>
void take(const std::vector<T>& from, std::span<const std::uint32_t> vertices, std::vector<T>& to) {
  if (from.empty()) return;
  to.reserve(vertices.size());
  for (const std::uint32_t v : vertices) to.push_back(from[v]);
}

Piece piece_of(const GeometryInstance& instance, std::span<const Item> items,
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
  for (const Item& item : items) {
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

class Cutter {
 public:
  Cutter(std::span<const GeometryInstance> instances, const Placed& placed, std::uint32_t most,
         std::uint32_t first_triangle)
      : instances_(instances), placed_(placed), most_(most), first_triangle_(first_triangle) {}

  void cut(std::span<Item> items) {
    if (items.empty()) return;
    if (items.size() <= most_) return finish(items);
    glm::vec3 low = items.front().centre, high = low;
    for (const Item& item : items) {
      low = glm::min(low, item.centre);
      high = glm::max(high, item.centre);
    }
    const glm::vec3 size = high - low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t half = items.size() / 2;
    std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(half), items.end(),
                     [axis](const Item& a, const Item& b) {
                       return std::tuple(a.centre[axis], a.instance, a.triangle) <
                              std::tuple(b.centre[axis], b.instance, b.triangle);
                     });
    cut(items.first(half));
    cut(items.subspan(half));
  }

  std::vector<ClusterData> clusters;

 private:
  void finish(std::span<Item> items) {
    std::sort(items.begin(), items.end(), [](const Item& a, const Item& b) {
      return std::pair(a.instance, a.triangle) < std::pair(b.instance, b.triangle);
    });
    ClusterData& cluster = clusters.emplace_back();
    for (std::size_t first = 0; first < items.size();) {
      std::size_t last = first;
      const std::uint32_t number = items[first].instance;
      while (last < items.size() && items[last].instance == number) ++last;
      const GeometryInstance& instance = instances_[number];
      const auto index = static_cast<std::uint32_t>(cluster.pieces.size());
      Piece& piece = cluster.pieces.emplace_back(
          piece_of(instance, items.subspan(first, last - first), first_triangle_));
      piece.instances = instance.instanced ? placed_.at(instance.mesh_number)
                                           : std::vector<std::uint32_t>{number};
      for (const std::uint32_t i : piece.instances)
        cluster.instances.push_back(without_pointers(instances_[i], index));
      first = last;
    }
  }

  std::span<const GeometryInstance> instances_;
  const Placed& placed_;
  std::uint32_t most_, first_triangle_;
};

}  // namespace

std::uint64_t stored_triangles(std::span<const GeometryInstance> instances) {
  const Placed placed = instances_of_meshes(instances);
  std::uint64_t sum = 0;
  for (std::uint32_t i = 0; i < instances.size(); ++i)
    if (is_stored(instances, placed, i)) sum += instances[i].mesh->triangles.size();
  return sum;
}

std::vector<ClusterData> cut_clusters(std::span<const GeometryInstance> instances,
                                      std::uint64_t begin, std::uint64_t end, std::uint32_t most,
                                      std::uint32_t first_triangle) {
  const Placed placed = instances_of_meshes(instances);
  Cutter cutter(instances, placed, most, first_triangle);
  std::vector<Item> once, own;
  std::uint64_t first = 0;
  for (std::uint32_t i = 0; i < instances.size(); ++i) {
    if (!is_stored(instances, placed, i)) continue;
    const std::uint64_t count = instances[i].mesh->triangles.size();
    std::vector<Item>& items = instances[i].instanced ? own : once;
    const std::uint64_t low = std::max(begin, first), high = std::min(end, first + count);
    for (std::uint64_t t = low; t < high; ++t) {
      const auto triangle = static_cast<std::uint32_t>(t - first);
      items.push_back({centre_of(instances[i], triangle), i, triangle});
    }
    first += count;
    cutter.cut(own);
    own.clear();
  }
  cutter.cut(once);
  return std::move(cutter.clusters);
}

}  // namespace delray::raytrace
