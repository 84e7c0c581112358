// Packs triangles of a cluster with the vertices that they use, transformed and with gouraud lit,
// and makes meshes and clusters of them again on the rank that gets them.
//
// Vertices are renumbered within a section, whose header tells attributes and material. Sections
// that follow each other with the same header become one mesh; copying is parallel over sections.
// O(triangles + vertices).
//
// Degenerate: triangles whose lit vertices are more than a cluster may have go into two sections;
// positions that are not finite give an infinite box.
#include "raster/distribute/transformed_clusters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>

#include "parallel/parallel_for.h"
#include "raster/pipeline/set_up.h"

namespace delray::raster {
namespace {

enum Attribute : std::uint8_t {
  kNormals = 1,
  kUvs = 2,
  kTangents = 4,
  kColours = 8,
  kWorld = 16,
  kRadiances = 32,
  kUvs2 = 64,
};

// Followed by first corners, second corners and third corners, a byte each and all filled up to
// four bytes, positions, and the attributes in ascending order.
struct ClusterHeader {
  std::uint32_t cluster, material;
  std::uint16_t vertices, triangles;
  std::uint8_t attributes, mirrored;
  std::int16_t hidden_side;

  bool same_mesh(const ClusterHeader& other) const {
    return material == other.material && attributes == other.attributes &&
           mirrored == other.mirrored && hidden_side == other.hidden_side;
  }
};
static_assert(sizeof(ClusterHeader) == 16);

std::size_t corner_bytes(std::size_t triangles) { return (3 * triangles + 3) / 4 * 4; }

// Calls f(vector, attribute) for each vector that a mesh with the attributes has.
template <class F>
void for_each_attribute(ArrivedMesh& arrived, std::uint8_t attributes, F&& f) {
  f(arrived.mesh.positions);
  if ((attributes & kNormals) != 0) f(arrived.mesh.normals);
  if ((attributes & kUvs) != 0) f(arrived.mesh.uvs);
  if ((attributes & kTangents) != 0) f(arrived.mesh.tangents);
  if ((attributes & kColours) != 0) f(arrived.mesh.colours);
  if ((attributes & kWorld) != 0) f(arrived.vertices.world);
  if ((attributes & kRadiances) != 0) f(arrived.vertices.radiances);
  if ((attributes & kUvs2) != 0) f(arrived.mesh.uvs2);
}

std::size_t vertex_bytes(std::uint8_t attributes) {
  std::size_t bytes = sizeof(glm::vec3);
  for (const std::uint8_t bit : {kNormals, kWorld, kRadiances})
    if ((attributes & bit) != 0) bytes += sizeof(glm::vec3);
  for (const std::uint8_t bit : {kTangents, kColours})
    if ((attributes & bit) != 0) bytes += sizeof(glm::vec4);
  for (const std::uint8_t bit : {kUvs, kUvs2})
    if ((attributes & bit) != 0) bytes += sizeof(glm::vec2);
  return bytes;
}

std::uint8_t attributes_of(const FrameShading& frame, const PreparedDraw& prepared) {
  const scenes::Mesh& mesh = *prepared.draw->mesh;
  const scenes::Material& material = shading::material(frame.shader, mesh.material);
  const bool coloured = !mesh.colours.empty();
  const auto bits = [](bool have, Attribute bit) { return have ? int{bit} : 0; };
  if (frame.lighting == Lighting::gouraud) {
    const std::uint32_t texture = material.base_colour_texture;
    const int set = texture == scenes::kNone ? 0 : frame.shader.textures[texture].set;
    const bool mapped = texture != scenes::kNone && !mesh.uvs_of(set).empty();
    return static_cast<std::uint8_t>(
        kRadiances | bits(mapped, set == 0 ? kUvs : kUvs2) |
        bits((prepared.masked || prepared.blended) && coloured, kColours));
  }
  const bool normal_texture = material.normal_texture != scenes::kNone;
  const int sets = shading::texture_sets(frame.shader, material);
  return static_cast<std::uint8_t>(
      kWorld | bits(!mesh.normals.empty(), kNormals) | bits(sets > 0 && !mesh.uvs.empty(), kUvs) |
      bits(sets > 1 && !mesh.uvs2.empty(), kUvs2) |
      bits(normal_texture && !mesh.tangents.empty(), kTangents) | bits(coloured, kColours));
}

geometry::Box3 box_around(std::span<const glm::vec3> positions) {
  geometry::Box3 box;
  for (const glm::vec3& p : positions) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
      constexpr float kInfinity = std::numeric_limits<float>::infinity();
      return {glm::vec3(-kInfinity), glm::vec3(kInfinity)};
    }
    box.include(p);
  }
  return box;
}

// A packed cluster, and where it goes.
struct Section {
  ClusterHeader header;
  const std::byte* content = nullptr;
  ArrivedMesh* mesh = nullptr;
  std::uint32_t draw = 0;
  MeshCluster cluster;
  std::uint32_t part = 0;
};

// Copies everything but the header.
void unpack(const Section& section) {
  const MeshCluster& cluster = section.cluster;
  scenes::Mesh& mesh = section.mesh->mesh;
  ClusterBlock& block = *section.mesh->clusters.blocks[0];
  const auto* const corners = reinterpret_cast<const std::uint8_t*>(section.content);
  for (std::uint32_t k = 0; k < 3; ++k) {
    std::copy_n(
        corners + std::size_t{k} * cluster.count, cluster.count,
        block.corners.data() + cluster.first_corner + std::size_t{k} * cluster.corner_stride());
  }
  for (std::uint32_t t = 0; t < cluster.count; ++t) {
    mesh.triangles[cluster.first + t] =
        glm::uvec3(corners[t], corners[t + cluster.count], corners[t + 2 * cluster.count]) +
        cluster.first_vertex;
  }
  std::iota(block.vertices.begin() + cluster.first_vertex,
            block.vertices.begin() + cluster.first_vertex + cluster.vertices, cluster.first_vertex);

  const std::byte* from = section.content + corner_bytes(cluster.count);
  for_each_attribute(*section.mesh, section.header.attributes, [&](auto& attribute) {
    const std::size_t bytes = cluster.vertices * sizeof(attribute[0]);
    std::memcpy(attribute.data() + cluster.first_vertex, from, bytes);
    from += bytes;
  });
  MeshCluster& result = block.clusters[section.part];
  result = cluster;
  result.box =
      box_around(std::span(mesh.positions).subspan(cluster.first_vertex, cluster.vertices));
}

// Sections that follow each other and may be of one mesh become one mesh.
std::vector<Section> find_sections(std::span<const std::byte> bytes,
                                   std::deque<ArrivedMesh>& meshes, DrawList& list) {
  static const glm::mat4x3 kIdentity(1.0F);
  std::vector<Section> sections;
  std::uint32_t triangles = 0, vertices = 0, corners = 0, part = 0;
  const auto close_mesh = [&] {
    if (sections.empty()) return;
    ArrivedMesh& mesh = meshes.back();
    const std::uint8_t attributes = sections.back().header.attributes;
    for_each_attribute(mesh, attributes, [&](auto& attribute) { attribute.resize(vertices); });
    mesh.mesh.triangles.resize(triangles);
    ClusterBlock& block = *mesh.clusters.blocks[0];
    block.vertices.resize(vertices);
    block.corners.resize(corners);
    block.clusters.resize(part);
    triangles = vertices = corners = part = 0;
  };
  while (!bytes.empty()) {
    Section section;
    std::memcpy(&section.header, bytes.data(), sizeof(ClusterHeader));
    const ClusterHeader& header = section.header;
    section.content = bytes.data() + sizeof(ClusterHeader);
    if (sections.empty() || !header.same_mesh(sections.back().header) ||
        triangles + header.triangles > kBlockTriangles) {
      close_mesh();
      ArrivedMesh& mesh = meshes.emplace_back();
      mesh.mesh.material = header.material;
      mesh.vertices.handedness = header.mirrored != 0 ? -1.0F : 1.0F;
      mesh.vertices.hidden_side = header.hidden_side;
      mesh.clusters.blocks.push_back(std::make_unique<ClusterBlock>());
      list.draws.push_back({&mesh.mesh, &kIdentity, &mesh.clusters, &mesh.vertices});
    }
    section.mesh = &meshes.back();
    section.draw = static_cast<std::uint32_t>(list.draws.size()) - 1;
    section.part = part++;
    section.cluster.first = triangles;
    section.cluster.count = header.triangles;
    section.cluster.first_vertex = vertices;
    section.cluster.vertices = header.vertices;
    section.cluster.first_corner = corners;
    triangles += header.triangles;
    vertices += header.vertices;
    corners += 3 * section.cluster.corner_stride();
    sections.push_back(section);
    bytes = bytes.subspan(sizeof(ClusterHeader) + corner_bytes(header.triangles) +
                          header.vertices * vertex_bytes(header.attributes));
  }
  close_mesh();
  return sections;
}

}  // namespace

void ClusterPacker::set(const FrameShading& frame, const PreparedDraw& draw, std::uint32_t cluster,
                        std::span<const std::uint8_t> places) {
  const DrawList& list = frame.list;
  cluster_ = cluster;
  places_in_ = &list.clusters[cluster];
  block_ = &list.block_of(*places_in_);
  prepared_ = &draw;
  draw_ = draw.draw;
  shaded_ = &frame.draws[places_in_->draw];
  attributes_ = attributes_of(frame, draw);
  places_ = places;
  if (frame.lighting != Lighting::gouraud) return;
  numbers_.clear();
  for (const std::uint8_t place : places) numbers_.push_back(cluster << kClusterBits | place);
  lit_ = gouraud_.light_corners(frame, numbers_);
}

void ClusterPacker::pack(std::span<const std::uint8_t> which, std::vector<std::byte>& bytes) {
  // By radiance, which belongs to one vertex, or by vertex of the cluster.
  constexpr std::uint16_t kNone = 0xFFFFU;
  std::array<std::uint16_t, std::size_t{3} * kClusterTriangles> number;
  const auto begin_section = [&] {
    number.fill(kNone);
    vertices_.clear();
    for (auto& corners : corners_) corners.clear();
  };
  begin_section();
  std::uint32_t section = cluster_;
  const MeshCluster& mesh_cluster = block_->clusters[places_in_->part];
  for (const std::uint8_t i : which) {
    if (vertices_.size() + 3 > kClusterVertices) {
      append_section(section++, bytes);
      begin_section();
    }
    const std::uint8_t place = places_[i];
    const LocalCorners local = corners_at(*block_, mesh_cluster, place);
    const std::uint32_t in_cluster[3] = {local.a, local.b, local.c};
    const glm::uvec3& in_mesh = draw_->mesh->triangles[places_in_->first + place];
    for (int k = 0; k < 3; ++k) {
      const bool lit = (attributes_ & kRadiances) != 0;
      const std::uint32_t radiance = lit ? lit_.corners[i][k] : 0;
      std::uint16_t& vertex = number[lit ? radiance : in_cluster[k]];
      if (vertex == kNone) {
        vertex = static_cast<std::uint16_t>(vertices_.size());
        vertices_.push_back({in_mesh[k], radiance});
      }
      corners_[k].push_back(static_cast<std::uint8_t>(vertex));
    }
  }
  if (!vertices_.empty()) append_section(section, bytes);
}

void ClusterPacker::append_section(std::uint32_t number, std::vector<std::byte>& bytes) {
  const scenes::Mesh& mesh = *draw_->mesh;
  const std::size_t triangles = corners_[0].size();
  const ClusterHeader header{number,
                             mesh.material,
                             static_cast<std::uint16_t>(vertices_.size()),
                             static_cast<std::uint16_t>(triangles),
                             attributes_,
                             static_cast<std::uint8_t>(shaded_->handedness < 0),
                             static_cast<std::int16_t>(prepared_->hidden_side)};
  const std::size_t before = bytes.size();
  bytes.resize(before + sizeof(header) + corner_bytes(triangles) +
               vertices_.size() * vertex_bytes(attributes_));
  std::byte* end = bytes.data() + before;
  const auto append = [&](const auto* values, std::size_t count) {
    std::memcpy(end, values, count * sizeof(*values));
    end += count * sizeof(*values);
  };
  append(&header, 1);
  for (const auto& corners : corners_) append(corners.data(), triangles);
  end += corner_bytes(triangles) - 3 * triangles;
  const auto append_each = [&](std::uint8_t attribute, auto&& value_of) {
    if ((attributes_ & attribute) != attribute) return;
    for (const Vertex& vertex : vertices_) {
      const auto value = value_of(vertex);
      append(&value, 1);
    }
  };
  append_each(0, [&](const Vertex& v) { return prepared_->to_view(mesh.positions[v.of_mesh]); });
  append_each(kNormals,
              [&](const Vertex& v) { return normal_in_world(*draw_, *shaded_, v.of_mesh); });
  append_each(kUvs, [&](const Vertex& v) { return mesh.uvs[v.of_mesh]; });
  append_each(kTangents,
              [&](const Vertex& v) { return tangent_in_world(*draw_, *shaded_, v.of_mesh); });
  append_each(kColours, [&](const Vertex& v) { return mesh.colours[v.of_mesh]; });
  append_each(kWorld, [&](const Vertex& v) { return position_in_world(*draw_, v.of_mesh); });
  append_each(kRadiances, [&](const Vertex& v) { return lit_.radiances[v.radiance]; });
  append_each(kUvs2, [&](const Vertex& v) { return mesh.uvs2[v.of_mesh]; });
}

void unpack_clusters(std::span<const std::byte> bytes, std::deque<ArrivedMesh>& meshes,
                     DrawList& list, std::vector<std::uint32_t>& numbers) {
  constexpr std::size_t kGrain = 8;  // clusters
  const std::vector<Section> sections = find_sections(bytes, meshes, list);
  parallel::parallel_for(0, sections.size(), kGrain, [&](std::size_t i) { unpack(sections[i]); });
  for (const Section& section : sections) {
    ClusterBlock& block = *section.mesh->clusters.blocks[0];
    block.box.include(block.clusters[section.part].box);
    const auto count = static_cast<std::uint16_t>(section.cluster.count);
    list.clusters[section.header.cluster] = {section.draw, section.cluster.first, section.part, 0,
                                             count};
    list.triangles += count;
    numbers.push_back(section.header.cluster);
  }
}

}  // namespace delray::raster
