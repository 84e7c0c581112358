// Packs clusters into messages and bounds them with slack for rounding. Lengths in a message are
// checked against its size before memory is taken.
#include "raytrace/clusters/cluster.h"

#include <algorithm>
#include <cstring>
#include <type_traits>
#include <utility>

#include "comm/bad_message.h"
#include "raytrace/scene/splat_hits.h"

namespace delray::raytrace {
namespace {

// Beyond the rounding of a transform and of Embree's intersection, relative to the largest number
// that takes part.
constexpr float kSlack = 0x1p-18F;

// Few enough that rays pass between boxes, enough that the tree of all ranks' boxes stays small.
constexpr std::size_t kBoxTriangles = 1024;

template <class T>
std::uint64_t bytes_of(const std::vector<T>& values) {
  return values.capacity() * sizeof(T);
}

class ClusterWriter {
 public:
  template <class T>
  void value(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    append(&value, sizeof(T));
  }
  template <class T>
  void array(const std::vector<T>& values) {
    value(static_cast<std::uint64_t>(values.size()));
    append(values.data(), values.size() * sizeof(T));
  }
  comm::Buffer buffer() const { return comm::Buffer::of(std::span<const std::byte>(bytes_)); }

 private:
  void append(const void* data, std::size_t size) {
    if (size == 0) return;
    const std::size_t at = bytes_.size();
    bytes_.resize(at + size);
    std::memcpy(bytes_.data() + at, data, size);
  }
  std::vector<std::byte> bytes_;
};

class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : bytes_(bytes) {}
  template <class T>
  T value() {
    T result;
    take(&result, sizeof(T));
    return result;
  }
  // Of exactly that capacity, but for `spare` more elements.
  template <class T>
  std::vector<T> array(std::size_t spare = 0) {
    std::vector<T> values;
    const auto size = static_cast<std::size_t>(value<std::uint64_t>());
    comm::check_message(size <= bytes_.size() / sizeof(T));
    values.reserve(size + spare);
    values.resize(size);
    take(values.data(), size * sizeof(T));
    return values;
  }

 private:
  void take(void* to, std::size_t size) {
    if (size == 0) return;
    comm::check_message(size <= bytes_.size());
    std::memcpy(to, bytes_.data(), size);
    bytes_ = bytes_.subspan(size);
  }
  std::span<const std::byte> bytes_;
};

// A geometry instance without its pointers.
struct InstanceValues {
  std::uint32_t piece, material;
  std::uint8_t instanced, identity, see_through, layered, texture_sets, unused[3];
  float orientation, transform_scale;
  glm::mat4x3 to_world;
  glm::mat3 normal_to_world;
};

InstanceValues values_of(const GeometryInstance& p) {
  return {p.mesh_number,
          p.material,
          p.instanced,
          p.identity,
          p.see_through,
          p.layered,
          static_cast<std::uint8_t>(p.texture_sets),
          {},
          p.orientation,
          p.transform_scale,
          p.to_world,
          p.normal_to_world};
}

GeometryInstance instance_of(const InstanceValues& v) {
  GeometryInstance p;
  p.mesh_number = v.piece;
  p.material = v.material;
  p.instanced = v.instanced != 0;
  p.identity = v.identity != 0;
  p.see_through = v.see_through != 0;
  p.layered = v.layered != 0;
  p.texture_sets = std::min<int>(v.texture_sets, 2);
  p.orientation = v.orientation;
  p.transform_scale = v.transform_scale;
  p.to_world = v.to_world;
  p.normal_to_world = v.normal_to_world;
  return p;
}

// Coordinates that are no numbers change nothing.
void include(const glm::vec3& p, geometry::Box3& box) {
  box.low = glm::min(box.low, p);
  box.high = glm::max(box.high, p);
}

// Leaves of a box what is in the other, at least a point of it.
void clip(const geometry::Box3& to, geometry::Box3& box) {
  if (box.empty()) return;
  box.low = glm::clamp(box.low, to.low, to.high);
  box.high = glm::clamp(box.high, to.low, to.high);
}

geometry::Box3 with_slack(const geometry::Box3& box, float more) {
  float reach = more;
  for (int k = 0; k < 3; ++k)
    reach = std::max(reach, std::max(std::abs(box.low[k]), std::abs(box.high[k])));
  const glm::vec3 slack(reach * kSlack);
  return {box.low - slack, box.high + slack};
}

// Adds a box for each kBoxTriangles of the triangles' boxes at most, cut in halves along the
// longest side.
void add_boxes(std::span<geometry::Box3> triangles, std::vector<geometry::Box3>& boxes) {
  geometry::Box3 box;
  for (const geometry::Box3& triangle : triangles) box.include(triangle);
  if (box.empty()) return;
  if (triangles.size() <= kBoxTriangles) {
    boxes.push_back(with_slack(box, 0.0F));
    return;
  }
  const glm::vec3 size = box.high - box.low;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const std::size_t half = triangles.size() / 2;
  std::nth_element(triangles.begin(), triangles.begin() + static_cast<std::ptrdiff_t>(half),
                   triangles.end(), [axis](const geometry::Box3& a, const geometry::Box3& b) {
                     return a.low[axis] < b.low[axis];
                   });
  add_boxes(triangles.first(half), boxes);
  add_boxes(triangles.subspan(half), boxes);
}

}  // namespace

std::uint64_t ClusterData::triangles() const {
  std::uint64_t sum = 0;
  for (const Piece& piece : pieces) sum += piece.triangles.size();
  return sum;
}

std::uint64_t ClusterData::bytes() const {
  std::uint64_t sum = bytes_of(pieces) + bytes_of(instances);
  for (const Piece& piece : pieces) {
    const scenes::Mesh& mesh = piece.mesh;
    sum += bytes_of(mesh.positions) + bytes_of(mesh.normals) + bytes_of(mesh.uvs) +
           bytes_of(mesh.uvs2) + bytes_of(mesh.tangents) + bytes_of(mesh.colours) +
           bytes_of(mesh.triangles) + bytes_of(piece.triangles) + bytes_of(piece.instances);
  }
  return sum;
}

std::vector<geometry::Box3> boxes_of(const ClusterData& cluster) {
  std::vector<geometry::Box3> boxes, triangles;
  for (const GeometryInstance& instance : cluster.instances) {
    const scenes::Mesh& mesh = cluster.pieces[instance.mesh_number].mesh;
    if (!instance.instanced) {
      const bool is_clipped = !cluster.clip.empty() && mesh.has_triangles() &&
                              !instance.see_through && !instance.layered;
      const float radius = mesh.has_triangles() ? 0.0F : splat_radius(instance, mesh.shape);
      for (const glm::uvec3& corners : mesh.triangles) {
        geometry::Box3& box = triangles.emplace_back();
        for (int k = 0; k < 3; ++k) include(mesh.positions[corners[k]], box);
        box.low -= glm::vec3(radius);
        box.high += glm::vec3(radius);
        if (is_clipped) clip(cluster.clip, box);
      }
      continue;
    }
    geometry::Box3 box;
    for (const glm::vec3& p : mesh.positions) include(instance.to_world * glm::vec4(p, 1.0F), box);
    if (!mesh.positions.empty()) boxes.push_back(with_slack(box, instance.transform_scale));
  }
  add_boxes(triangles, boxes);
  return boxes;
}

comm::Buffer pack(const ClusterData& cluster) {
  ClusterWriter out;
  out.value(static_cast<std::uint64_t>(cluster.pieces.size()));
  for (const Piece& piece : cluster.pieces) {
    out.value(piece.mesh.material);
    out.value(piece.mesh.shape);
    out.array(piece.mesh.positions);
    out.array(piece.mesh.normals);
    out.array(piece.mesh.uvs);
    out.array(piece.mesh.uvs2);
    out.array(piece.mesh.tangents);
    out.array(piece.mesh.colours);
    out.array(piece.mesh.triangles);
    out.array(piece.triangles);
    out.array(piece.instances);
  }
  std::vector<InstanceValues> instances;
  for (const GeometryInstance& p : cluster.instances) instances.push_back(values_of(p));
  out.array(instances);
  return out.buffer();
}

ClusterData unpack_cluster(std::span<const std::byte> message) {
  Reader in(message);
  ClusterData cluster;
  const auto pieces = in.value<std::uint64_t>();
  comm::check_message(pieces <= message.size() / sizeof(std::uint64_t));  // each has several
  cluster.pieces.resize(pieces);
  for (Piece& piece : cluster.pieces) {
    piece.mesh.material = in.value<std::uint32_t>();
    piece.mesh.shape = in.value<scenes::Shape>();
    piece.mesh.positions = in.array<glm::vec3>(1);  // Embree loads past the last one
    piece.mesh.normals = in.array<glm::vec3>();
    piece.mesh.uvs = in.array<glm::vec2>();
    piece.mesh.uvs2 = in.array<glm::vec2>();
    piece.mesh.tangents = in.array<glm::vec4>();
    piece.mesh.colours = in.array<glm::vec4>();
    piece.mesh.triangles = in.array<glm::uvec3>();
    piece.triangles = in.array<std::uint32_t>();
    piece.instances = in.array<std::uint32_t>();
  }
  for (const InstanceValues& values : in.array<InstanceValues>())
    cluster.instances.push_back(instance_of(values));
  return cluster;
}

Cluster::Cluster(ClusterData&& data, const shading::Shader& shader,
                 std::span<const LeastAlpha> alphas)
    : data_(std::move(data)) {
  using Bits = std::vector<std::uint64_t>;
  std::vector<std::shared_ptr<const Bits>> opaque;  // of pieces
  for (const Piece& piece : data_.pieces) {
    auto bits = std::make_shared<const Bits>(
        opaque_triangles(piece.mesh, shading::material(shader, piece.mesh.material), alphas));
    bytes_ += bytes_of(*bits);
    opaque.push_back(bits->empty() ? nullptr : std::move(bits));
  }
  for (GeometryInstance& instance : data_.instances) {
    const Piece& piece = data_.pieces[instance.mesh_number];
    instance.mesh = &piece.mesh;
    instance.positions = piece.mesh.positions.data();
    instance.opaque = opaque[instance.mesh_number];
  }
  for (const Piece& piece : data_.pieces) {
    for (const std::uint32_t instance : piece.instances)
      numbers_.push_back({instance, piece.triangles.data()});
  }
  bytes_ += data_.bytes();
}

}  // namespace delray::raytrace
