#include "scenes/internal/gltf_mesh.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "scenes/internal/vertex_values.h"

namespace delray::scenes::internal {
namespace {

constexpr std::uint64_t kTriangles = 4, kStrip = 5, kFan = 6;

std::vector<glm::uvec3> triangles_of(std::span<const std::uint32_t> v, std::uint64_t mode) {
  std::vector<glm::uvec3> triangles;
  if (mode == kTriangles) {
    triangles.reserve(v.size() / 3);
    for (std::size_t i = 0; i + 2 < v.size(); i += 3)
      triangles.emplace_back(v[i], v[i + 1], v[i + 2]);
  } else {
    for (std::size_t i = 0; i + 2 < v.size(); ++i) {
      const std::size_t odd = i % 2;
      triangles.push_back(mode == kStrip ? glm::uvec3(v[i], v[i + 1 + odd], v[i + 2 - odd])
                                         : glm::uvec3(v[i + 1], v[i + 2], v[0]));
    }
  }
  return triangles;
}

template <class T>
void keep(std::vector<T>& values, std::span<const std::uint32_t> kept) {
  if (values.empty()) return;
  for (std::size_t i = 0; i < kept.size(); ++i) values[i] = values[kept[i]];
  values.resize(kept.size());
}

void drop_unused_vertices(Mesh& mesh) {
  std::vector<std::uint32_t> number(mesh.positions.size(), kNone), kept;
  for (const glm::uvec3& t : mesh.triangles) number[t.x] = number[t.y] = number[t.z] = 0;
  for (std::uint32_t i = 0; i < number.size(); ++i) {
    if (number[i] == kNone) continue;
    number[i] = static_cast<std::uint32_t>(kept.size());
    kept.push_back(i);
  }
  if (kept.size() == number.size()) return;
  keep(mesh.positions, kept);
  keep(mesh.normals, kept);
  keep(mesh.uvs, kept);
  keep(mesh.tangents, kept);
  keep(mesh.colours, kept);
  for (glm::uvec3& t : mesh.triangles) t = {number[t.x], number[t.y], number[t.z]};
}

// Attributes of a primitive: optional, and as many as there are positions.
struct Attributes {
  const GltfDocument& document;
  JsonView json;
  std::size_t vertices;

  std::uint32_t find(const char* name) const {
    return json[name].reference(document.root()["accessors"].size());
  }
  template <int N>
  std::vector<glm::vec<N, float>> read(const char* name) const {
    const std::uint32_t accessor = find(name);
    if (accessor == kNone) return {};
    std::vector<glm::vec<N, float>> values = read_vectors<N>(document, accessor);
    if (values.size() != vertices) {
      json[name].fail("has " + std::to_string(values.size()) + " elements for " +
                      std::to_string(vertices) + " vertices");
    }
    return values;
  }
};

std::vector<glm::vec3> read_positions(const JsonView& primitive, const GltfDocument& document,
                                      std::uint32_t accessor) {
  std::vector<glm::vec3> positions = read_vectors<3>(document, accessor);
  const auto limit = glm::vec3(static_cast<float>(kLargestCoordinate));
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (glm::any(glm::greaterThan(glm::abs(positions[i]), limit))) {
      primitive.fail("a coordinate of vertex " + std::to_string(i) + " is larger than 1e18");
    }
  }
  return positions;
}

void read_colours(const Attributes& attributes, Mesh& mesh) {
  const std::uint32_t accessor = attributes.find("COLOR_0");
  if (accessor == kNone) return;
  if (component_count(attributes.document, accessor) == 3) {
    for (const glm::vec3& c : attributes.read<3>("COLOR_0")) mesh.colours.emplace_back(c, 1.0F);
  } else {
    mesh.colours = attributes.read<4>("COLOR_0");
  }
  for (glm::vec4& c : mesh.colours) c = glm::max(c, glm::vec4(0));
}

void read_uvs(const Attributes& attributes, const UvUse& use, Mesh& mesh) {
  mesh.uvs = attributes.read<2>(("TEXCOORD_" + std::to_string(use.set)).c_str());
  if (use.transform == glm::dmat3x2(1.0)) return;
  for (glm::vec2& uv : mesh.uvs) uv = use.transform * glm::dvec3(uv, 1.0);
}

Mesh read_primitive(const GltfDocument& document, const JsonView& primitive, std::uint64_t mode,
                    std::span<const GltfMaterial> materials) {
  Mesh mesh;
  const std::size_t accessors = document.root()["accessors"].size();
  const std::uint32_t position = primitive["attributes"]["POSITION"].reference(accessors);
  if (position == kNone) return mesh;
  mesh.positions = read_positions(primitive, document, position);

  std::vector<std::uint32_t> indices(mesh.positions.size());
  const std::uint32_t index_accessor = primitive["indices"].reference(accessors);
  if (index_accessor == kNone) {
    std::iota(indices.begin(), indices.end(), 0U);
  } else {
    indices = read_indices(document, index_accessor);
  }
  for (std::size_t i = 0; i < indices.size(); ++i) {
    if (indices[i] >= mesh.positions.size()) {
      primitive["indices"].fail("index " + std::to_string(i) + " is " + std::to_string(indices[i]) +
                                "; there are " + std::to_string(mesh.positions.size()) +
                                " vertices");
    }
  }
  mesh.triangles = triangles_of(indices, mode);

  const std::uint32_t material = primitive["material"].reference(materials.size());
  mesh.material = material;
  const Attributes attributes{document, primitive["attributes"], mesh.positions.size()};
  mesh.normals = attributes.read<3>("NORMAL");
  normalize_or_clear(mesh.normals);
  if (!mesh.normals.empty()) mesh.tangents = attributes.read<4>("TANGENT");
  normalize_or_clear(mesh.tangents);
  read_uvs(attributes, material == kNone ? UvUse{} : materials[material].uvs, mesh);
  read_colours(attributes, mesh);
  drop_unused_vertices(mesh);
  return mesh;
}

}  // namespace

std::vector<Mesh> read_mesh(const GltfDocument& document, std::size_t number,
                            std::span<const GltfMaterial> materials) {
  const JsonView json = document.root()["meshes"][number];
  const JsonView primitives = json["primitives"];
  std::vector<Mesh> meshes;
  for (std::size_t i = 0; i < primitives.size(); ++i) {
    const std::uint64_t mode = primitives[i]["mode"].whole(kTriangles);
    if (mode != kTriangles && mode != kStrip && mode != kFan) {
      document.source.warn(primitives[i].place() + ": points or lines left out");
      continue;
    }
    meshes.push_back(read_primitive(document, primitives[i], mode, materials));
    meshes.back().name = json["name"].text();
  }
  return meshes;
}

}  // namespace delray::scenes::internal
