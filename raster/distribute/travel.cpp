// Packs pieces of meshes as whole clusters, which the receiver draws without cutting them anew, or
// as ranges of primitive numbers where the receiver has the scene.
//
// A cluster keeps its box and cone: those of all its triangles hold for some of them, too. Vertices
// that several clusters use travel with each. Degenerate: no pieces make an empty message.
#include "raster/distribute/travel.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <numeric>
#include <type_traits>

#include "parallel/parallel_for.h"

namespace delray::raster {
namespace {

// Followed by a GroupHeader for each piece, the clusters, their corners, positions, and the
// attributes that `attributes` names, in ascending order of their bits.
struct RunHeader {
  std::uint32_t groups, clusters, triangles, vertices, corners, material;
  std::uint16_t attributes;
  scenes::Shape::Kind kind;
  std::uint8_t in_pixels;
  float radius;
  glm::mat4x3 transform;
};
static_assert(sizeof(RunHeader) == 80);

struct GroupHeader {
  std::uint64_t primitive;
  std::uint32_t first, count;  // triangles of the mesh
};
static_assert(std::is_trivially_copyable_v<MeshCluster>);
static_assert(kCornerPadding % 4 == 0, "all that follows corners is aligned to 4 bytes");

// Calls f(attribute, bit) for each attribute that a mesh may have.
template <class Mesh, class F>
void for_each_attribute(Mesh& mesh, F&& f) {
  f(mesh.normals, 1U);
  f(mesh.uvs, 2U);
  f(mesh.tangents, 4U);
  f(mesh.colours, 8U);
  f(mesh.uvs2, 16U);
}

std::uint32_t attributes_of(const scenes::Mesh& mesh) {
  std::uint32_t bits = 0;
  for_each_attribute(mesh, [&](const auto& attribute, std::uint32_t bit) {
    if (!attribute.empty()) bits |= bit;
  });
  return bits;
}

std::size_t bytes_of_vertex(const scenes::Mesh& mesh) {
  std::size_t bytes = sizeof(mesh.positions[0]);
  for_each_attribute(mesh, [&](const auto& attribute, std::uint32_t) {
    if (!attribute.empty()) bytes += sizeof(attribute[0]);
  });
  return bytes;
}

std::uint32_t padded(std::uint32_t triangles) {
  return (triangles + kCornerPadding - 1) / kCornerPadding * kCornerPadding;
}

template <class T>
std::byte* put(std::span<const T> values, std::byte* to) {
  if (!values.empty()) std::memcpy(to, values.data(), values.size_bytes());
  return to + values.size_bytes();
}
template <class T>
std::byte* put(const T& value, std::byte* to) {
  return put(std::span<const T>(&value, 1), to);
}

class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : rest_(bytes) {}
  bool at_end() const { return rest_.empty(); }
  template <class T>
  T value() {
    T value;
    std::memcpy(&value, skip(sizeof value).data(), sizeof value);
    return value;
  }
  // Instead of what was in the vector.
  template <class T>
  void read(std::size_t count, std::vector<T>& values) {
    const auto* const from = reinterpret_cast<const T*>(skip(count * sizeof(T)).data());
    values.assign(from, from + count);
  }
  std::span<const std::byte> skip(std::size_t bytes) {
    const std::span<const std::byte> skipped = rest_.first(bytes);
    rest_ = rest_.subspan(bytes);
    return skipped;
  }

 private:
  std::span<const std::byte> rest_;
};

// The bytes of a run after its header.
std::size_t content_bytes(const RunHeader& header) {
  std::size_t of_vertex = sizeof(glm::vec3);
  scenes::Mesh mesh;
  for_each_attribute(mesh, [&](const auto& attribute, std::uint32_t bit) {
    if ((header.attributes & bit) != 0) of_vertex += sizeof(attribute[0]);
  });
  return header.groups * sizeof(GroupHeader) + header.clusters * sizeof(MeshCluster) +
         header.corners + header.vertices * of_vertex;
}

void fill_triangles(const ClusterBlock& block, std::vector<glm::uvec3>& triangles) {
  for (const MeshCluster& cluster : block.clusters) {
    const std::uint8_t* const corners = block.corners.data() + cluster.first_corner;
    const std::uint32_t stride = cluster.corner_stride();
    for (std::uint32_t t = 0; t < cluster.count; ++t) {
      triangles[cluster.first + t] =
          glm::uvec3(corners[t], corners[t + stride], corners[t + 2 * stride]) +
          cluster.first_vertex;
    }
  }
}

// `arrivals` has room for the run's groups.
void unpack_run(Reader reader, std::span<Arrival> arrivals) {
  const auto header = reader.value<RunHeader>();
  auto travelled = std::make_shared<TravelledMesh>();
  travelled->transform = header.transform;
  std::vector<GroupHeader> groups;
  reader.read(header.groups, groups);
  auto block = std::make_unique<ClusterBlock>();
  reader.read(header.clusters, block->clusters);
  reader.read(header.corners, block->corners);
  block->vertices.resize(header.vertices);
  std::iota(block->vertices.begin(), block->vertices.end(), 0U);
  for (const MeshCluster& cluster : block->clusters) block->box.include(cluster.box);

  scenes::Mesh& mesh = travelled->mesh;
  mesh.material = header.material;
  mesh.shape = {header.kind, header.in_pixels != 0, header.radius};
  mesh.triangles.resize(header.triangles);
  fill_triangles(*block, mesh.triangles);
  reader.read(header.vertices, mesh.positions);
  for_each_attribute(mesh, [&](auto& attribute, std::uint32_t bit) {
    if ((header.attributes & bit) != 0) reader.read(header.vertices, attribute);
  });
  travelled->clusters.blocks.push_back(std::move(block));
  for (std::size_t i = 0; i < groups.size(); ++i) {
    arrivals[i] = {{&mesh, &travelled->transform, groups[i].first, groups[i].count,
                    groups[i].primitive, &travelled->clusters},
                   travelled};
  }
}

}  // namespace

// Numbers the vertices that the part's triangles use in the order in which these name them first.
void GeometryPacker::renumber(Part& part) {
  const MeshCluster& cluster = *part.cluster;
  const std::span<const std::uint32_t> all = part.block->vertices_of(cluster);
  part.first_used = static_cast<std::uint32_t>(used_.size());
  part.first_corner = static_cast<std::uint32_t>(corners_.size());
  const std::uint32_t stride = padded(part.triangles());
  corners_.resize(corners_.size() + 3 * std::size_t{stride});
  constexpr std::uint16_t kNew = 0xFFFF;
  std::array<std::uint16_t, kClusterVertices> number;
  number.fill(kNew);
  const std::uint8_t* const from = part.block->corners.data() + cluster.first_corner + part.begin;
  for (std::uint32_t t = 0; t < part.triangles(); ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint8_t vertex = from[t + std::size_t{k} * cluster.corner_stride()];
      if (number[vertex] == kNew) {
        number[vertex] = static_cast<std::uint16_t>(used_.size() - part.first_used);
        used_.push_back(all[vertex]);
      }
      corners_[part.first_corner + k * stride + t] = static_cast<std::uint8_t>(number[vertex]);
    }
  }
  part.vertices = static_cast<std::uint32_t>(used_.size()) - part.first_used;
}

void GeometryPacker::add_parts(const Piece& piece, const MeshClusters& clusters, Run& run) {
  const std::uint32_t end = piece.first + piece.count;
  for (std::uint32_t t = piece.first; t < end;) {
    const ClusterBlock& block = *clusters.blocks[t >> kBlockBits];
    for (std::uint32_t i = part_with(block, t); i < block.clusters.size() && t < end; ++i) {
      const MeshCluster& cluster = block.clusters[i];
      const std::uint32_t last = std::min(end, cluster.first + cluster.count);
      Part part{&block, &cluster, t - cluster.first, last - cluster.first, 0, 0, cluster.vertices};
      if (!part.is_whole()) renumber(part);
      run.triangles += part.triangles();
      run.vertices += part.vertices;
      run.corners += 3 * padded(part.triangles());
      parts_.push_back(part);
      t = last;
    }
  }
  run.last_part = parts_.size();
}

GeometryPacker::GeometryPacker(std::span<const Piece> pieces, SceneClusters& clusters) {
  for (std::size_t i = 0; i < pieces.size();) {
    const Piece& first = pieces[i];
    MeshClusters& of_mesh = *clusters.of(*first.mesh);
    Run run;
    run.first_part = parts_.size();
    const std::size_t begin = i;
    while (i < pieces.size() && pieces[i].transform == first.transform &&
           (i == begin || run.triangles + pieces[i].count <= kTravelledTriangles)) {
      of_mesh.make(*first.mesh, pieces[i].first, pieces[i].count);
      add_parts(pieces[i++], of_mesh, run);
    }
    run.pieces = pieces.subspan(begin, i - begin);
    run.begin = bytes_;
    bytes_ += sizeof(RunHeader) + run.pieces.size() * sizeof(GroupHeader) +
              (run.last_part - run.first_part) * sizeof(MeshCluster) + run.corners +
              run.vertices * bytes_of_vertex(*first.mesh);
    bytes_ = (bytes_ + 7) / 8 * 8;
    runs_.push_back(run);
  }
}

std::span<const std::uint32_t> GeometryPacker::vertices_of(const Part& part) const {
  if (part.is_whole()) return part.block->vertices_of(*part.cluster);
  return std::span(used_).subspan(part.first_used, part.vertices);
}

void GeometryPacker::write_run(const Run& run, std::byte* to) const {
  const scenes::Mesh& mesh = *run.pieces.front().mesh;
  const auto parts = std::span(parts_).subspan(run.first_part, run.last_part - run.first_part);
  to = put(RunHeader{static_cast<std::uint32_t>(run.pieces.size()),
                     static_cast<std::uint32_t>(parts.size()), run.triangles, run.vertices,
                     run.corners, mesh.material, static_cast<std::uint16_t>(attributes_of(mesh)),
                     mesh.shape.kind, static_cast<std::uint8_t>(mesh.shape.in_pixels),
                     mesh.shape.radius, *run.pieces.front().transform},
           to);
  std::uint32_t triangles = 0;
  for (const Piece& piece : run.pieces) {
    to = put(GroupHeader{piece.primitive, triangles, piece.count}, to);
    triangles += piece.count;
  }
  MeshCluster next;
  for (const Part& part : parts) {
    MeshCluster cluster = *part.cluster;
    cluster.first = next.first;
    cluster.count = part.triangles();
    cluster.first_vertex = next.first_vertex;
    cluster.vertices = part.vertices;
    cluster.first_in_mesh = next.first_vertex;  // as they arrive
    cluster.first_corner = next.first_corner;
    to = put(cluster, to);
    next.first += cluster.count;
    next.first_vertex += cluster.vertices;
    next.first_corner += 3 * cluster.corner_stride();
  }
  for (const Part& part : parts) {
    const bool whole = part.is_whole();
    const std::span<const std::uint8_t> from = whole ? part.block->corners : corners_;
    to = put(from.subspan(whole ? part.cluster->first_corner : part.first_corner,
                          3 * std::size_t{padded(part.triangles())}),
             to);
  }
  const auto write_used = [&](const auto& attribute) {
    for (const Part& part : parts)
      for (const std::uint32_t vertex : vertices_of(part)) to = put(attribute[vertex], to);
  };
  write_used(mesh.positions);
  for_each_attribute(mesh, [&](const auto& attribute, std::uint32_t) {
    if (!attribute.empty()) write_used(attribute);
  });
}

void GeometryPacker::write(std::byte* to) const {
  parallel::parallel_for(0, runs_.size(), 1,
                         [&](std::size_t i) { write_run(runs_[i], to + runs_[i].begin); });
}

void unpack_geometry(std::span<const std::byte> message, std::vector<Arrival>& arrivals) {
  struct Run {
    std::size_t begin, first_arrival;
    std::uint32_t groups;
  };
  std::vector<Run> runs;
  std::size_t count = arrivals.size();
  for (std::size_t begin = 0; begin < message.size();) {
    const auto header = Reader(message.subspan(begin)).value<RunHeader>();
    runs.push_back({begin, count, header.groups});
    count += header.groups;
    begin = (begin + sizeof(RunHeader) + content_bytes(header) + 7) / 8 * 8;
  }
  arrivals.resize(count);
  parallel::parallel_for(0, runs.size(), 1, [&](std::size_t i) {
    unpack_run(Reader(message.subspan(runs[i].begin)),
               std::span(arrivals).subspan(runs[i].first_arrival, runs[i].groups));
  });
}

std::vector<std::uint64_t> pack_numbers(std::span<const Piece> pieces) {
  std::vector<std::uint64_t> ranges;
  for (const Piece& piece : pieces) {
    ranges.push_back(piece.primitive);
    ranges.push_back(piece.primitive + piece.count);
  }
  return ranges;
}

void unpack_numbers(std::span<const std::byte> message, const scenes::Scene& scene,
                    std::span<const std::uint64_t> first_primitives,
                    std::vector<Arrival>& arrivals) {
  Reader reader(message);
  while (!reader.at_end()) {
    const auto begin = reader.value<std::uint64_t>();
    for (const Piece& piece :
         pieces_of(scene, first_primitives, begin, reader.value<std::uint64_t>()))
      arrivals.push_back({piece, nullptr});
  }
}

}  // namespace delray::raster
