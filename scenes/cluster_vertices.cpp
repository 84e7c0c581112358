// Vertex clustering (Rossignac and Borrel, "Multi-resolution 3D approximations for rendering
// complex scenes", 1993).
//
// Space is cut into cubes. All vertices in a cube become one, and of triangles those are left whose
// corners are in three cubes. Here one of the vertices stands for the others, with its attributes,
// so that what is left touches the surface; and cubes are those of a mesh's own coordinates, as
// wide as the largest of its instances needs. Cubes of corners are computed from their places, so
// that nothing is kept for each vertex. Where more is left than may be, cubes get twice as wide.
//
// O(triangles) for each width, parallel but for what is left. Degenerate: what is smaller than a
// cube vanishes, and so do triangles of no area.
#include "scenes/cluster_vertices.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include "image/srgb.h"
#include "parallel/parallel_for.h"
#include "scenes/parts/read_run.h"

namespace delray::scenes {
namespace {

constexpr float kCubes = 160;                      // along the longest side of the scene, at most
constexpr float kFewestCubes = 16;                 // with fewer nothing is to be recognized
constexpr std::size_t kTrianglesOfTask = 1 << 14;  // some hundred microseconds

// Cubes of a mesh.
class Cubes {
 public:
  explicit Cubes(float side) : per_unit_(1 / double{side}) {}

  std::uint64_t number_of(const glm::vec3& p) const {
    return index(p.x) | index(p.y) << kBits | index(p.z) << 2 * kBits;
  }

 private:
  static constexpr int kBits = 21;

  // Places that are farther off than any of a scene share the last cubes.
  std::uint64_t index(float x) const {
    constexpr double kHalf = 1 << (kBits - 1);  // so that nothing is below 0, and conversion floors
    return static_cast<std::uint64_t>(
        static_cast<std::int64_t>(std::clamp(x * per_unit_ + kHalf, 0.0, 2 * kHalf - 1)));
  }

  double per_unit_;
};

// The largest factor by which instances scale a mesh; 0: there are none.
std::vector<float> scales_of(const Scene& scene) {
  std::vector<float> scales(scene.meshes.size(), 0.0F);
  for (const Instance& instance : scene.instances)
    for (int axis = 0; axis < 3; ++axis)
      scales[instance.mesh] =
          std::max(scales[instance.mesh], glm::length(instance.transform[axis]));
  return scales;
}

// Triangles of a mesh with corners in three cubes, in their order; `left` counts them down, and
// where it gets below 0 some are missing.
std::vector<glm::uvec3> spread_triangles(const Mesh& mesh, const Cubes& cubes,
                                         std::atomic<std::int64_t>& left) {
  const std::size_t tasks = (mesh.triangles.size() + kTrianglesOfTask - 1) / kTrianglesOfTask;
  std::vector<std::vector<glm::uvec3>> found(tasks);
  parallel::parallel_for(0, tasks, 1, [&](std::size_t task) {
    const std::size_t end = std::min(mesh.triangles.size(), (task + 1) * kTrianglesOfTask);
    for (std::size_t t = task * kTrianglesOfTask; t < end; ++t) {
      const glm::uvec3& corners = mesh.triangles[t];
      const std::uint64_t a = cubes.number_of(mesh.positions[corners.x]);
      const std::uint64_t b = cubes.number_of(mesh.positions[corners.y]);
      if (a == b) continue;
      const std::uint64_t c = cubes.number_of(mesh.positions[corners.z]);
      if (b == c || c == a) continue;
      if (left.fetch_sub(1, std::memory_order_relaxed) <= 0) return;
      found[task].push_back(corners);
    }
  });
  std::vector<glm::uvec3> all;
  for (const auto& some : found) all.insert(all.end(), some.begin(), some.end());
  return all;
}

// Of triangles with the same corners, in the same order around, one is left.
void keep_distinct(std::vector<glm::uvec3>& triangles) {
  for (glm::uvec3& t : triangles) {
    while (t.x > t.y || t.x > t.z) t = {t.y, t.z, t.x};
  }
  const auto less = [](const glm::uvec3& a, const glm::uvec3& b) {
    return std::array{a.x, a.y, a.z} < std::array{b.x, b.y, b.z};
  };
  std::ranges::sort(triangles, less);
  triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
}

// Gives `mesh` the triangles with the vertices of `from` that they have; equal(v): those with equal
// numbers become one.
template <class Equal>
void take(const Mesh& from, std::vector<glm::uvec3>&& triangles, Mesh& mesh, Equal&& equal) {
  std::unordered_map<std::uint64_t, std::uint32_t> number;
  number.reserve(triangles.size());
  std::vector<std::uint32_t> vertices;
  for (glm::uvec3& t : triangles) {
    for (int k = 0; k < 3; ++k) {
      const auto [found, is_new] =
          number.try_emplace(equal(t[k]), static_cast<std::uint32_t>(vertices.size()));
      if (is_new) vertices.push_back(t[k]);
      t[k] = found->second;
    }
  }
  mesh.triangles = std::move(triangles);
  internal::for_each_attribute(from, mesh, [&](const auto& all, auto& some) {
    if (all.empty()) return;
    for (const std::uint32_t v : vertices) some.push_back(all[v]);
  });
}

Mesh bare(const Mesh& mesh) {
  Mesh result;
  result.name = mesh.name;
  result.shape = mesh.shape;
  result.material = mesh.material;
  return result;
}

Mesh every_so_many(const Mesh& from, std::size_t most) {
  const std::size_t step = from.triangles.size() / most + 1;
  std::vector<glm::uvec3> some;
  for (std::size_t i = 0; i < from.triangles.size(); i += step) some.push_back(from.triangles[i]);
  Mesh mesh = bare(from);
  take(from, std::move(some), mesh, [](std::uint32_t v) { return std::uint64_t{v}; });
  return mesh;
}

// A row or column of texels for a coordinate.
std::size_t texel_of(float coordinate, int size, Texture::Wrap wrap) {
  double at = coordinate;
  if (wrap != Texture::Wrap::clamp) {
    const double whole = std::floor(at);
    at -= whole;
    if (wrap == Texture::Wrap::mirror && std::fmod(whole, 2.0) != 0) at = 1 - at;
  }
  return static_cast<std::size_t>(std::clamp(at * size, 0.0, size - 1.0));
}

glm::vec4 colour_at(const Texture& texture, const glm::vec2& uv) {
  const std::size_t x = texel_of(uv.x, texture.width, texture.wrap_u);
  const std::size_t y = texel_of(uv.y, texture.height, texture.wrap_v);
  const image::RgbaF c =
      image::to_float(texture.texels[y * static_cast<std::size_t>(texture.width) + x]);
  return {c.r, c.g, c.b, c.a};
}

// Puts the texture of its base colour, if there is one, into the colours of its vertices.
void colour_by_texture(const Scene& scene, Mesh& mesh) {
  if (mesh.material >= scene.materials.size()) return;
  const std::uint32_t number = scene.materials[mesh.material].base_colour_texture;
  if (number < scene.textures.size() && !scene.textures[number].texels.empty()) {
    const Texture& texture = scene.textures[number];
    const std::vector<glm::vec2>& uvs = mesh.uvs_of(texture.set);
    if (!uvs.empty()) mesh.colours.resize(mesh.positions.size(), glm::vec4(1));
    for (std::size_t v = 0; v < uvs.size(); ++v) mesh.colours[v] *= colour_at(texture, uvs[v]);
  }
  mesh.uvs.clear();
  mesh.uvs2.clear();
  mesh.tangents.clear();
}

// Without what its textures would tell.
Material plain(Material material) {
  constexpr float kRough = 0.6F;
  if (material.metallic_roughness_texture != kNone) {
    material.metallic = 0;
    material.roughness = kRough;
  }
  if (material.emission_texture != kNone) material.emission = glm::vec3(0);
  if (material.transmission_texture != kNone) material.transmission = 0;
  for (std::uint32_t* const texture : material.textures()) *texture = kNone;
  return material;
}

// The meshes by cubes of a side; nothing where they have more triangles than they may.
std::optional<std::vector<Mesh>> clustered(const Scene& scene, const std::vector<float>& scales,
                                           float side, std::size_t most) {
  constexpr std::int64_t kAlike = 2;  // of triangles before those that become alike are dropped
  std::vector<Mesh> meshes;
  std::atomic<std::int64_t> left{kAlike * static_cast<std::int64_t>(most)};
  std::size_t triangles = 0;
  for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
    const Mesh& from = scene.meshes[i];
    Mesh mesh = bare(from);
    if (!from.has_triangles()) {
      mesh = every_so_many(from, most);
    } else if (scales[i] > 0) {
      const Cubes cubes(side / scales[i]);
      std::vector<glm::uvec3> spread = spread_triangles(from, cubes, left);
      if (left < 0) return std::nullopt;
      take(from, std::move(spread), mesh,
           [&](std::uint32_t v) { return cubes.number_of(from.positions[v]); });
      keep_distinct(mesh.triangles);
      triangles += mesh.triangles.size();
      if (triangles > most) return std::nullopt;
    }
    colour_by_texture(scene, mesh);
    meshes.push_back(std::move(mesh));
  }
  return meshes;
}

// Instances of meshes that have triangles, and these.
void place(const Scene& scene, std::vector<Mesh>&& meshes, Scene& coarse) {
  std::vector<std::uint32_t> number(meshes.size(), kNone);
  for (const Instance& instance : scene.instances) {
    std::uint32_t& own = number[instance.mesh];
    if (meshes[instance.mesh].triangles.empty() && own == kNone) continue;
    if (own == kNone) {
      own = static_cast<std::uint32_t>(coarse.meshes.size());
      coarse.meshes.push_back(std::exchange(meshes[instance.mesh], {}));
    }
    coarse.instances.push_back({own, instance.transform});
  }
}

}  // namespace

std::optional<Scene> cluster_vertices(const Scene& scene, std::size_t most) {
  const std::vector<float> scales = scales_of(scene);
  const glm::vec3 size = bounds(scene).size();
  const float longest = std::max({size.x, size.y, size.z});
  std::optional<std::vector<Mesh>> meshes;
  for (float cubes = kCubes; cubes >= kFewestCubes && !meshes && longest > 0; cubes /= 2)
    meshes = clustered(scene, scales, longest / cubes, most);
  if (!meshes) return std::nullopt;
  Scene coarse;
  place(scene, *std::move(meshes), coarse);
  if (coarse.instances.empty()) return std::nullopt;
  for (const Material& material : scene.materials) coarse.materials.push_back(plain(material));
  coarse.lights = scene.lights;
  coarse.environment = scene.environment;
  coarse.environment.texture = kNone;
  coarse.cameras = scene.cameras;
  coarse.origin = scene.origin;
  coarse.z_up = scene.z_up;
  coarse.framed = scene.framed;
  return coarse;
}

}  // namespace delray::scenes
