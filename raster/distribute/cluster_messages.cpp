// Packs triangles of a cluster with the vertices that they use, with gouraud lit, and makes meshes
// and clusters of them again on the rank that gets them.
//
// Vertices travel in the mesh's coordinates with its transform: all that the sender computed of
// them follows from that to the last bit, and takes three times as many bytes. Vertices are
// renumbered within a section, whose header tells attributes and material. Sections that follow
// each other with the same header and transform become one mesh; copying is parallel over sections.
// O(triangles + vertices).
//
// Degenerate: triangles whose lit vertices are more than a cluster may have go into two sections.
#include "raster/distribute/cluster_messages.h"

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
  kRadiances = 16,
  kUvs2 = 32,
  kShape = 64,  // not a value of vertices: a ShapeHeader
};

// Followed by the transform where it is another one than before, the shape if there is one, first
// corners, second corners and third corners, a byte each and all filled up to four bytes,
// positions, and the attributes in ascending order.
struct ClusterHeader {
  std::uint32_t cluster, material;
  std::uint16_t vertices, triangles;
  std::uint8_t attributes, has_transform, normals_agree, unused;
  geometry::Box3 box;

  bool same_mesh(const ClusterHeader& other) const {
    return material == other.material && attributes == other.attributes;
  }
};
static_assert(sizeof(ClusterHeader) == 40);

// Of points and segments.
struct ShapeHeader {
  scenes::Shape::Kind kind;
  std::uint8_t in_pixels, unused[2];
  float radius;
};
static_assert(sizeof(ShapeHeader) == 8);

std::size_t corner_bytes(std::size_t triangles) { return (3 * triangles + 3) / 4 * 4; }

// Calls f(vector, attribute) for each vector that a mesh with the attributes has.
template <class F>
void for_each_attribute(ArrivedMesh& arrived, std::uint8_t attributes, F&& f) {
  f(arrived.mesh.positions);
  if ((attributes & kNormals) != 0) f(arrived.mesh.normals);
  if ((attributes & kUvs) != 0) f(arrived.mesh.uvs);
  if ((attributes & kTangents) != 0) f(arrived.mesh.tangents);
  if ((attributes & kColours) != 0) f(arrived.mesh.colours);
  if ((attributes & kRadiances) != 0) f(arrived.radiances);
  if ((attributes & kUvs2) != 0) f(arrived.mesh.uvs2);
}

std::size_t vertex_bytes(std::uint8_t attributes) {
  std::size_t bytes = sizeof(glm::vec3);
  for (const std::uint8_t bit : {kNormals, kRadiances})
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
  if (!mesh.has_triangles())
    return static_cast<std::uint8_t>(kShape | bits(!mesh.normals.empty(), kNormals) |
                                     bits(coloured, kColours));
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
      bits(!mesh.normals.empty(), kNormals) | bits(sets > 0 && !mesh.uvs.empty(), kUvs) |
      bits(sets > 1 && !mesh.uvs2.empty(), kUvs2) |
      bits(normal_texture && !mesh.tangents.empty(), kTangents) | bits(coloured, kColours));
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
  block.clusters[section.part] = cluster;
}

// Sections that follow each other and may be of one mesh become one mesh.
std::vector<Section> find_sections(std::span<const std::byte> bytes,
                                   std::deque<ArrivedMesh>& meshes, DrawList& list) {
  std::vector<Section> sections;
  glm::mat4x3 transform(1.0F);
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
    bytes = bytes.subspan(sizeof(ClusterHeader));
    const ClusterHeader& header = section.header;
    if (header.has_transform != 0) {
      std::memcpy(&transform, bytes.data(), sizeof transform);
      bytes = bytes.subspan(sizeof transform);
    }
    scenes::Shape shape;
    if ((header.attributes & kShape) != 0) {
      ShapeHeader of_shape;
      std::memcpy(&of_shape, bytes.data(), sizeof of_shape);
      shape = {of_shape.kind, of_shape.in_pixels != 0, of_shape.radius};
      bytes = bytes.subspan(sizeof of_shape);
    }
    section.content = bytes.data();
    if (sections.empty() || !header.same_mesh(sections.back().header) ||
        shape != meshes.back().mesh.shape || transform != meshes.back().transform ||
        triangles + header.triangles > kBlockTriangles) {
      close_mesh();
      ArrivedMesh& mesh = meshes.emplace_back();
      mesh.mesh.material = header.material;
      mesh.mesh.shape = shape;
      mesh.transform = transform;
      mesh.clusters.blocks.push_back(std::make_unique<ClusterBlock>());
      const bool lit = (header.attributes & kRadiances) != 0;
      list.draws.push_back(
          {&mesh.mesh, &mesh.transform, &mesh.clusters, lit ? &mesh.radiances : nullptr});
    }
    section.mesh = &meshes.back();
    section.draw = static_cast<std::uint32_t>(list.draws.size()) - 1;
    section.part = part++;
    section.cluster.first = triangles;
    section.cluster.count = header.triangles;
    section.cluster.first_vertex = vertices;
    section.cluster.vertices = header.vertices;
    section.cluster.first_corner = corners;
    section.cluster.box = header.box;
    section.cluster.normals_agree = header.normals_agree != 0;
    section.cluster.first_in_mesh = vertices;
    triangles += header.triangles;
    vertices += header.vertices;
    corners += 3 * section.cluster.corner_stride();
    sections.push_back(section);
    bytes = bytes.subspan(corner_bytes(header.triangles) +
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
  draw_ = draw.draw;
  attributes_ = attributes_of(frame, draw);
  places_ = places;
  if ((attributes_ & kRadiances) == 0) return;
  numbers_.clear();
  for (const std::uint8_t place : places) numbers_.push_back(cluster << kClusterBits | place);
  lit_ = gouraud_.light_corners(frame, numbers_);
}

void ClusterPacker::pack(std::span<const std::uint8_t> which, PackedClusters& to) {
  // By radiance, which belongs to one vertex, or by vertex of the cluster.
  constexpr std::uint16_t kNone = 0xFFFFU;
  std::array<std::uint16_t, std::size_t{3} * kClusterTriangles> number;
  const auto begin_section = [&] {
    number.fill(kNone);
    section_.vertices = section_.triangles = 0;
  };
  begin_section();
  std::uint32_t section_number = cluster_;
  const bool lit = (attributes_ & kRadiances) != 0;
  const MeshCluster& mesh_cluster = block_->clusters[places_in_->part];
  const std::span<const std::uint32_t> of_mesh = block_->vertices_of(mesh_cluster);
  // What append_section copies.
  const scenes::Mesh& mesh = *draw_->mesh;
  const auto prefetch = [&](std::uint32_t vertex) {
    __builtin_prefetch(mesh.positions.data() + vertex);
    if ((attributes_ & kNormals) != 0) __builtin_prefetch(mesh.normals.data() + vertex);
    if ((attributes_ & kUvs) != 0) __builtin_prefetch(mesh.uvs.data() + vertex);
  };
  for (const std::uint8_t i : which) {
    if (section_.vertices + 3 > kClusterVertices) {
      append_section(section_number++, to);
      begin_section();
    }
    const LocalCorners local = corners_at(*block_, mesh_cluster, places_[i]);
    const std::uint32_t in_cluster[3] = {local.a, local.b, local.c};
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t radiance = lit ? lit_.corners[i][k] : 0;
      std::uint16_t& vertex = number[lit ? radiance : in_cluster[k]];
      if (vertex == kNone) {
        vertex = static_cast<std::uint16_t>(section_.vertices);
        section_.vertex[section_.vertices] = of_mesh[in_cluster[k]];
        prefetch(of_mesh[in_cluster[k]]);
        section_.radiance[section_.vertices++] = radiance;
      }
      section_.corners[static_cast<std::size_t>(k)][section_.triangles] =
          static_cast<std::uint8_t>(vertex);
    }
    ++section_.triangles;
  }
  if (section_.vertices > 0) append_section(section_number, to);
}

void ClusterPacker::append_section(std::uint32_t number, PackedClusters& to) {
  const scenes::Mesh& mesh = *draw_->mesh;
  const MeshCluster& cluster = block_->clusters[places_in_->part];
  const std::size_t triangles = section_.triangles;
  const auto vertices = std::span<const std::uint32_t>(section_.vertex).first(section_.vertices);
  const bool with_transform = to.last_transform != draw_->transform;
  to.last_transform = draw_->transform;
  to.triangles += triangles;
  const std::size_t before = to.bytes.size();
  const bool with_shape = (attributes_ & kShape) != 0;
  to.bytes.resize(before + sizeof(ClusterHeader) +
                  (with_shape ? sizeof(ShapeHeader) : std::size_t{0}) +
                  (with_transform ? sizeof(glm::mat4x3) : std::size_t{0}) +
                  corner_bytes(triangles) + vertices.size() * vertex_bytes(attributes_));
  std::byte* end = to.bytes.data() + before;
  const auto append = [&](const auto* values, std::size_t count) {
    std::memcpy(end, values, count * sizeof(*values));
    end += count * sizeof(*values);
  };
  const auto append_value = [&](const auto& value) { append(&value, 1); };
  append_value(ClusterHeader{number, mesh.material, static_cast<std::uint16_t>(vertices.size()),
                             static_cast<std::uint16_t>(triangles), attributes_,
                             static_cast<std::uint8_t>(with_transform),
                             static_cast<std::uint8_t>(cluster.normals_agree), 0, cluster.box});
  if (with_transform) append_value(*draw_->transform);
  if (with_shape) {
    append_value(ShapeHeader{
        mesh.shape.kind, static_cast<std::uint8_t>(mesh.shape.in_pixels), {}, mesh.shape.radius});
  }
  for (const auto& corners : section_.corners) append(corners.data(), triangles);
  end += corner_bytes(triangles) - 3 * triangles;
  const auto append_used = [&](std::uint8_t attribute, const auto& values) {
    if ((attributes_ & attribute) != attribute) return;
    for (const std::uint32_t vertex : vertices) append_value(values[vertex]);
  };
  append_used(0, mesh.positions);
  append_used(kNormals, mesh.normals);
  append_used(kUvs, mesh.uvs);
  append_used(kTangents, mesh.tangents);
  append_used(kColours, mesh.colours);
  if ((attributes_ & kRadiances) != 0) {
    for (std::size_t i = 0; i < vertices.size(); ++i)
      append_value(lit_.radiances[section_.radiance[i]]);
  }
  append_used(kUvs2, mesh.uvs2);
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
    list.clusters[section.header.cluster] = {section.draw,
                                             section.cluster.first,
                                             section.part,
                                             0,
                                             count,
                                             0,
                                             section.cluster.vertex_of_place_0()};
    list.triangles += count;
    numbers.push_back(section.header.cluster);
  }
}

}  // namespace delray::raster
