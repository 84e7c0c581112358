// Reads the attributes of a primitive, plain or compressed, turns strips and fans into triangles
// and drops unused vertices. Degenerate: repeated vertices in strips make no triangles; a primitive
// whose positions or indices have no data is left out.
#include "scenes/gltf/gltf_mesh.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "parallel/parallel_for.h"
#include "scenes/files/vertex_values.h"
#include "scenes/gltf/gltf_draco.h"

namespace delray::scenes::internal {
namespace {

constexpr std::uint64_t kPoints = 0, kLines = 1, kLoop = 2, kTriangles = 4, kStrip = 5, kFan = 6;
constexpr std::size_t kBlock = 1 << 15;  // vertices or triangles: tens of microseconds

// The first i below `count` that is_wrong(i), or `count`.
template <class IsWrong>
std::size_t first_that(std::size_t count, IsWrong&& is_wrong) {
  return parallel::parallel_reduce(
      0, count, kBlock, count,
      [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
          if (is_wrong(i)) return i;
        }
        return count;
      },
      [](std::size_t a, std::size_t b) { return std::min(a, b); });
}

std::vector<glm::uvec3> triangles_of(std::span<const std::uint32_t> v, std::uint64_t mode) {
  std::vector<glm::uvec3> triangles;
  triangles.reserve(mode == kTriangles ? v.size() / 3 : v.size());
  if (mode == kTriangles) {
    for (std::size_t i = 0; i + 2 < v.size(); i += 3)
      triangles.emplace_back(v[i], v[i + 1], v[i + 2]);
  } else {
    for (std::size_t i = 0; i + 2 < v.size(); ++i) {
      const std::size_t odd = i % 2;
      const glm::uvec3 t = mode == kStrip ? glm::uvec3(v[i], v[i + 1 + odd], v[i + 2 - odd])
                                          : glm::uvec3(v[i + 1], v[i + 2], v[0]);
      // Repeated vertices join strips to one; they are no triangles that went wrong.
      if (t.x != t.y && t.y != t.z && t.z != t.x) triangles.push_back(t);
    }
  }
  return triangles;
}

// Points and segments as meshes have them.
std::vector<glm::uvec3> splats_of(const std::vector<std::uint32_t>& v, std::uint64_t mode) {
  std::vector<glm::uvec3> splats;
  const std::size_t step = mode == kLines ? 2 : 1, last = mode == kPoints ? 0 : 1;
  for (std::size_t i = 0; i + last < v.size(); i += step)
    splats.emplace_back(v[i], v[i + last], v[i + last]);
  if (mode == kLoop && v.size() > 2) splats.emplace_back(v.back(), v.front(), v.front());
  return splats;
}

template <class T>
void keep(std::vector<T>& values, std::span<const std::uint32_t> kept, std::size_t width = 1) {
  if (values.empty()) return;
  for (std::size_t i = 0; i < kept.size(); ++i)
    for (std::size_t k = 0; k < width; ++k) values[i * width + k] = values[kept[i] * width + k];
  values.resize(kept.size() * width);
}

// Whether each vertex is a corner.
bool all_are_used(const Mesh& mesh) {
  std::vector<std::uint8_t> used(mesh.positions.size(), 0);
  parallel::parallel_for(0, mesh.triangles.size(), kBlock, [&](std::size_t t) {
    for (int k = 0; k < 3; ++k) {
      std::atomic_ref<std::uint8_t>(used[mesh.triangles[t][k]]).store(1, std::memory_order_relaxed);
    }
  });
  return std::ranges::find(used, 0) == used.end();
}

void drop_unused_vertices(Mesh& mesh, Deformation& deformation) {
  if (all_are_used(mesh)) return;
  std::vector<std::uint32_t> number(mesh.positions.size(), kNone), kept;
  for (const glm::uvec3& t : mesh.triangles) number[t.x] = number[t.y] = number[t.z] = 0;
  for (std::uint32_t i = 0; i < number.size(); ++i) {
    if (number[i] == kNone) continue;
    number[i] = static_cast<std::uint32_t>(kept.size());
    kept.push_back(i);
  }
  keep(mesh.positions, kept);
  keep(mesh.normals, kept);
  keep(mesh.uvs, kept);
  keep(mesh.uvs2, kept);
  keep(mesh.tangents, kept);
  keep(mesh.colours, kept);
  for (MorphTarget& target : deformation.targets) {
    keep(target.positions, kept);
    keep(target.normals, kept);
    keep(target.tangents, kept);
  }
  keep(deformation.joints, kept, deformation.influences);
  keep(deformation.weights, kept, deformation.influences);
  for (glm::uvec3& t : mesh.triangles) t = {number[t.x], number[t.y], number[t.z]};
}

// The data of a primitive, from accessors or compressed. Attributes are optional, and as many as
// there are positions.
class Attributes {
 public:
  Attributes(const GltfDocument& document, const JsonView& primitive)
      : document_(document),
        json_(primitive["attributes"]),
        draco_(DracoPrimitive::read(document, primitive)) {}
  // Only those of vertices [first, last). REQUIRES: they are not compressed, and dense.
  Attributes(const GltfDocument& document, const JsonView& primitive, std::uint64_t first,
             std::uint64_t last)
      : document_(document), json_(primitive["attributes"]), range_(std::pair(first, last)) {}

  bool has(const char* name) const { return find(name) != kNone; }
  int components(const char* name) const {
    if (is_compressed(name)) return draco_->components(name);
    return component_count(document_, find(name));
  }
  template <int N>
  std::vector<glm::vec<N, float>> read(const char* name) {
    const std::uint32_t accessor = find(name);
    if (accessor == kNone) return {};
    if (range_) return read_vectors<N>(document_, accessor, range_->first, range_->second);
    const JsonView normalized = document_.root()["accessors"][accessor]["normalized"];
    std::vector<glm::vec<N, float>> values = is_compressed(name)
                                                 ? draco_->vectors<N>(name, normalized.flag(false))
                                                 : read_vectors<N>(document_, accessor);
    if (!vertices_) vertices_ = values.size();  // positions come first
    if (values.size() != *vertices_) {
      json_[name].fail("has " + std::to_string(values.size()) + " elements for " +
                       std::to_string(*vertices_) + " vertices");
    }
    return values;
  }
  // The indices of compressed triangles; nothing if there are none.
  std::optional<std::vector<std::uint32_t>> compressed_indices() const {
    if (!draco_) return std::nullopt;
    return draco_->indices();
  }

 private:
  std::uint32_t find(const char* name) const {
    return json_[name].reference(document_.root()["accessors"].size());
  }
  bool is_compressed(const char* name) const { return draco_ && draco_->has(name); }

  const GltfDocument& document_;
  JsonView json_;
  std::optional<DracoPrimitive> draco_;
  std::optional<std::size_t> vertices_;
  std::optional<std::pair<std::uint64_t, std::uint64_t>> range_;
};

std::vector<glm::vec3> read_positions(const JsonView& primitive, Attributes& attributes) {
  std::vector<glm::vec3> positions = attributes.read<3>("POSITION");
  const auto limit = glm::vec3(static_cast<float>(kLargestCoordinate));
  const std::size_t wrong = first_that(positions.size(), [&](std::size_t i) {
    return glm::any(glm::greaterThan(glm::abs(positions[i]), limit));
  });
  if (wrong < positions.size()) {
    primitive.fail("a coordinate of vertex " + std::to_string(wrong) + " is larger than 1e18");
  }
  return positions;
}

void read_colours(Attributes& attributes, Mesh& mesh) {
  if (!attributes.has("COLOR_0")) return;
  if (attributes.components("COLOR_0") == 3) {
    for (const glm::vec3& c : attributes.read<3>("COLOR_0")) mesh.colours.emplace_back(c, 1.0F);
  } else {
    mesh.colours = attributes.read<4>("COLOR_0");
  }
  parallel::parallel_for(0, mesh.colours.size(), kBlock, [&](std::size_t i) {
    mesh.colours[i] = glm::max(mesh.colours[i], glm::vec4(0));
  });
}

std::string attribute_of(const UvUse& use) { return "TEXCOORD_" + std::to_string(use.set); }

// A set that the mesh does not have is replaced by set 0.
std::vector<glm::vec2> read_uvs(Attributes& attributes, const UvUse& use) {
  const std::string own = attribute_of(use);
  std::vector<glm::vec2> uvs =
      attributes.read<2>(attributes.has(own.c_str()) ? own.c_str() : "TEXCOORD_0");
  if (use.transform != glm::dmat3x2(1.0)) {
    for (glm::vec2& uv : uvs) uv = use.transform * glm::dvec3(uv, 1.0);
  }
  return uvs;
}

// The coordinates at which the material's textures are looked up.
void read_all_uvs(const JsonView& primitive, Attributes& attributes, const GltfDocument& document,
                  GltfMaterial& material, Mesh& mesh) {
  if (material.uvs.empty()) {
    mesh.uvs = read_uvs(attributes, {});
    return;
  }
  // Meshes that have no coordinates at all are common, and show one texel.
  const bool only_first = material.uvs.size() == 1 && material.uvs[0].set == 0;
  for (const UvUse& use : material.uvs) {
    if (only_first || material.lacks_uvs || attributes.has(attribute_of(use).c_str())) continue;
    material.lacks_uvs = true;
    document.source.warn(primitive.place() + " has no " + attribute_of(use) +
                         ", where its material's textures are looked up");
  }
  mesh.uvs = read_uvs(attributes, material.uvs[0]);
  if (material.uvs.size() == 1) return;
  mesh.uvs2 = read_uvs(attributes, material.uvs[1]);
  if (mesh.uvs.empty()) mesh.uvs.resize(mesh.uvs2.size(), glm::vec2(0));
}

// Displacements that are all zero take no memory.
std::vector<MorphTarget> read_targets(const GltfDocument& document, const JsonView& primitive,
                                      const Mesh& mesh) {
  const std::size_t accessors = document.root()["accessors"].size();
  const auto read = [&](const JsonView& json) {
    std::vector<glm::vec3> values;
    const std::uint32_t accessor = json.reference(accessors);
    if (accessor == kNone || is_all_zero(document, accessor)) return values;
    values = read_vectors<3>(document, accessor);
    if (values.size() != mesh.positions.size()) {
      json.fail("has " + std::to_string(values.size()) + " elements for " +
                std::to_string(mesh.positions.size()) + " vertices");
    }
    return values;
  };
  const JsonView targets = primitive["targets"];
  std::vector<MorphTarget> result(targets.size());
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i].positions = read(targets[i]["POSITION"]);
    if (!mesh.normals.empty()) result[i].normals = read(targets[i]["NORMAL"]);
    if (!mesh.tangents.empty()) result[i].tangents = read(targets[i]["TANGENT"]);
  }
  return result;
}

// Makes weights sum up to 1; a vertex without any follows its first joint, as elsewhere.
void make_sums_one(Deformation& deformation, std::size_t vertices) {
  const std::size_t n = deformation.influences;
  parallel::parallel_for(0, vertices, kBlock, [&](std::size_t i) {
    const std::span<float> weights(deformation.weights.data() + i * n, n);
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    if (!(sum > 0)) {
      weights[0] = 1;
      return;
    }
    if (sum == 1) return;
    for (float& w : weights) w = static_cast<float>(double{w} / sum);
  });
}

// JOINTS_0 and WEIGHTS_0, and sets that follow.
void read_influences(const JsonView& primitive, Attributes& attributes, Deformation& deformation) {
  constexpr std::size_t kOfSet = 4;
  std::vector<std::vector<glm::vec4>> joints, weights;
  for (int set = 0;; ++set) {
    const std::string suffix = std::to_string(set);
    const std::string joint = "JOINTS_" + suffix, weight = "WEIGHTS_" + suffix;
    if (!attributes.has(joint.c_str()) || !attributes.has(weight.c_str())) break;
    joints.push_back(attributes.read<4>(joint.c_str()));
    weights.push_back(attributes.read<4>(weight.c_str()));
  }
  if (joints.empty()) primitive["attributes"].fail("has no JOINTS_0 and WEIGHTS_0 for its skin");
  const std::size_t vertices = joints.front().size();
  deformation.influences = static_cast<std::uint32_t>(joints.size() * kOfSet);
  deformation.joints.reserve(vertices * deformation.influences);
  deformation.weights.reserve(vertices * deformation.influences);
  for (std::size_t i = 0; i < vertices; ++i) {
    for (std::size_t k = 0; k < deformation.influences; ++k) {
      const float joint = joints[k / kOfSet][i][static_cast<int>(k % kOfSet)];
      const float weight = weights[k / kOfSet][i][static_cast<int>(k % kOfSet)];
      if (!(joint >= 0 && joint <= 65535 && joint == std::floor(joint)))
        primitive.fail("a joint of vertex " + std::to_string(i) + " is no number of one");
      if (weight < 0) primitive.fail("a weight of vertex " + std::to_string(i) + " is negative");
      deformation.joints.push_back(static_cast<std::uint16_t>(joint));
      deformation.weights.push_back(weight);
    }
  }
  make_sums_one(deformation, vertices);
}

GltfPrimitive read_primitive(const GltfDocument& document, const JsonView& primitive,
                             std::uint64_t mode, std::span<GltfMaterial> materials, bool has_skin) {
  GltfPrimitive result;
  Mesh& mesh = result.mesh;
  Attributes attributes(document, primitive);
  if (!attributes.has("POSITION")) return result;
  auto compressed = attributes.compressed_indices();
  const std::size_t accessors = document.root()["accessors"].size();
  const std::uint32_t position = primitive["attributes"]["POSITION"].reference(accessors);
  const std::uint32_t index_accessor = primitive["indices"].reference(accessors);
  // Without data all corners are in one place, so nothing of it can be seen.
  const bool bends = primitive["targets"].size() > 0;
  if (!compressed && ((is_all_zero(document, position) && !bends) ||
                      (index_accessor != kNone && is_all_zero(document, index_accessor)))) {
    document.source.warn(primitive.place() + ": its corners are all in one place: left out");
    return result;
  }
  mesh.positions = read_positions(primitive, attributes);

  // Triples of indices are the triangles, without a copy.
  const bool direct = !compressed && index_accessor != kNone && mode == kTriangles;
  std::vector<std::uint32_t> indices;
  if (compressed) {
    indices = *std::move(compressed);
    mode = kTriangles;
  } else if (index_accessor == kNone) {
    document.source.require_memory(mesh.positions.size() * sizeof(std::uint32_t),
                                   primitive.place());
    indices.resize(mesh.positions.size());
    std::iota(indices.begin(), indices.end(), 0U);
  } else if (!direct) {
    indices = read_indices(document, index_accessor);
  }
  const auto check = [&](std::span<const std::uint32_t> all) {
    const std::size_t vertices = mesh.positions.size();
    const std::size_t wrong =
        first_that(all.size(), [&](std::size_t i) { return all[i] >= vertices; });
    if (wrong == all.size()) return;
    primitive["indices"].fail("index " + std::to_string(wrong) + " is " +
                              std::to_string(all[wrong]) + "; there are " +
                              std::to_string(vertices) + " vertices");
  };
  if (direct) {
    mesh.triangles = read_index_triples(document, index_accessor);
    const std::uint64_t count = element_count(document, index_accessor);
    if (count > 0) check({&mesh.triangles[0].x, count});
    mesh.triangles.resize(count / 3);
  } else {
    check(indices);
    const std::size_t triangles = mode == kTriangles ? indices.size() / 3 : indices.size();
    document.source.require_memory(triangles * sizeof(glm::uvec3), primitive.place());
    if (mode < kTriangles) {
      mesh.triangles = splats_of(indices, mode);
      mesh.shape = mode == kPoints ? kPointShape : kLineShape;
    } else {
      mesh.triangles = triangles_of(indices, mode);
    }
  }

  const std::uint32_t material = primitive["material"].reference(materials.size());
  mesh.material = material;
  mesh.normals = attributes.read<3>("NORMAL");
  normalize_or_clear(mesh.normals);
  if (!mesh.normals.empty()) mesh.tangents = attributes.read<4>("TANGENT");
  normalize_or_clear(mesh.tangents);
  GltfMaterial none;
  read_all_uvs(primitive, attributes, document, material == kNone ? none : materials[material],
               mesh);
  read_colours(attributes, mesh);
  document.source.require_memory(mesh.positions.size() * 2 * sizeof(std::uint32_t),
                                 primitive.place());
  if (has_skin) read_influences(primitive, attributes, result.deformation);
  result.deformation.targets = read_targets(document, primitive, mesh);
  drop_unused_vertices(mesh, result.deformation);
  return result;
}

}  // namespace

bool has_runs(const GltfDocument& document, const JsonView& primitive,
              const GltfMaterial& material) {
  const JsonView attributes = primitive["attributes"];
  const std::size_t accessors = document.root()["accessors"].size();
  const std::uint32_t position = attributes["POSITION"].reference(accessors);
  const std::uint32_t indices = primitive["indices"].reference(accessors);
  if (primitive["mode"].whole(kTriangles) != kTriangles || primitive["extensions"] ||
      position == kNone || indices == kNone || !is_dense(document, indices) ||
      element_count(document, indices) % 3 != 0) {
    return false;
  }
  for (const std::string& name : attributes.keys()) {
    const std::uint32_t accessor = attributes[name.c_str()].reference(accessors);
    if (accessor == kNone || !is_dense(document, accessor) ||
        element_count(document, accessor) != element_count(document, position)) {
      return false;
    }
  }
  const bool first_set = material.uvs.size() == 1 && material.uvs[0].set == 0;
  return first_set || std::ranges::all_of(material.uvs, [&](const UvUse& use) {
           return static_cast<bool>(attributes[attribute_of(use).c_str()]);
         });
}

Mesh read_vertices(const GltfDocument& document, const JsonView& primitive,
                   const GltfMaterial& material, std::uint64_t first, std::uint64_t last) {
  Attributes attributes(document, primitive, first, last);
  Mesh mesh;
  mesh.positions = read_positions(primitive, attributes);
  mesh.normals = attributes.read<3>("NORMAL");
  if (!mesh.normals.empty()) mesh.tangents = attributes.read<4>("TANGENT");
  GltfMaterial with_all = material;
  read_all_uvs(primitive, attributes, document, with_all, mesh);
  read_colours(attributes, mesh);
  return mesh;
}

std::vector<GltfPrimitive> read_mesh(const GltfDocument& document, std::size_t number,
                                     std::span<GltfMaterial> materials, bool has_skin) {
  const JsonView json = document.root()["meshes"][number];
  const JsonView primitives = json["primitives"];
  std::vector<GltfPrimitive> meshes;
  for (std::size_t i = 0; i < primitives.size(); ++i) {
    const std::uint64_t mode = primitives[i]["mode"].whole(kTriangles);
    if (mode > kFan) primitives[i]["mode"].fail("should be 0 to 6");
    meshes.push_back(read_primitive(document, primitives[i], mode, materials, has_skin));
    meshes.back().mesh.name = json["name"].text();
  }
  return meshes;
}

}  // namespace delray::scenes::internal
