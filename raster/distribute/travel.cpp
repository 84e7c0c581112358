// Packs pieces of meshes with the vertices that they use, renumbered by binary search in a sorted
// list, or as ranges of primitive numbers where the receiver has the scene.
#include "raster/distribute/travel.h"

#include <algorithm>
#include <cstring>

namespace delray::raster {
namespace {

// Followed by triangles, then positions, then the attributes that `attributes` names, in ascending
// order of their bits: all in units of four bytes.
struct Header {
  std::uint64_t primitive;
  std::uint32_t vertices, triangles, material, attributes;
  glm::mat4x3 transform;
};
static_assert(sizeof(Header) == 72);

// Calls f(attribute, bit) for each attribute that a mesh may have.
template <class Mesh, class F>
void for_each_attribute(Mesh& mesh, F&& f) {
  f(mesh.normals, 1U);
  f(mesh.uvs, 2U);
  f(mesh.tangents, 4U);
  f(mesh.colours, 8U);
  f(mesh.uvs2, 16U);
}

class Writer {
 public:
  template <class T>
  void write(std::span<const T> values) {
    const auto* bytes = reinterpret_cast<const std::byte*>(values.data());
    bytes_.insert(bytes_.end(), bytes, bytes + values.size_bytes());
  }
  comm::Buffer buffer() const { return comm::Buffer::of(std::span<const std::byte>(bytes_)); }

 private:
  std::vector<std::byte> bytes_;
};

class Reader {
 public:
  explicit Reader(const comm::Buffer& message) : rest_(message.as<std::byte>()) {}
  bool at_end() const { return rest_.empty(); }
  template <class T>
  void read(std::span<T> values) {
    if (!values.empty()) std::memcpy(values.data(), rest_.data(), values.size_bytes());
    rest_ = rest_.subspan(values.size_bytes());
  }

 private:
  std::span<const std::byte> rest_;
};

}  // namespace

comm::Buffer pack_geometry(std::span<const Piece> pieces) {
  Writer writer;
  std::vector<std::uint32_t> used;
  for (const Piece& piece : pieces) {
    const scenes::Mesh& mesh = *piece.mesh;
    const auto triangles = std::span(mesh.triangles).subspan(piece.first, piece.count);
    used.clear();
    for (const glm::uvec3& t : triangles) used.insert(used.end(), {t.x, t.y, t.z});
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());

    Header header{
        piece.primitive, static_cast<std::uint32_t>(used.size()), piece.count, mesh.material, 0,
        *piece.transform};
    for_each_attribute(mesh, [&](const auto& attribute, std::uint32_t bit) {
      if (!attribute.empty()) header.attributes |= bit;
    });
    writer.write(std::span<const Header>(&header, 1));
    const auto renumbered = [&](std::uint32_t vertex) {
      return static_cast<std::uint32_t>(std::lower_bound(used.begin(), used.end(), vertex) -
                                        used.begin());
    };
    for (const glm::uvec3& t : triangles) {
      const glm::uvec3 local{renumbered(t.x), renumbered(t.y), renumbered(t.z)};
      writer.write(std::span<const glm::uvec3>(&local, 1));
    }
    const auto write_used = [&](const auto& attribute) {
      using Value = typename std::decay_t<decltype(attribute)>::value_type;
      for (const std::uint32_t vertex : used)
        writer.write(std::span<const Value>(&attribute[vertex], 1));
    };
    write_used(mesh.positions);
    for_each_attribute(mesh, [&](const auto& attribute, std::uint32_t) {
      if (!attribute.empty()) write_used(attribute);
    });
  }
  return writer.buffer();
}

void unpack_geometry(const comm::Buffer& message, Arrivals& arrivals) {
  Reader reader(message);
  while (!reader.at_end()) {
    Header header;
    reader.read(std::span(&header, 1));
    scenes::Mesh& mesh = arrivals.meshes.emplace_back();
    mesh.material = header.material;
    mesh.triangles.resize(header.triangles);
    reader.read(std::span(mesh.triangles));
    mesh.positions.resize(header.vertices);
    reader.read(std::span(mesh.positions));
    for_each_attribute(mesh, [&](auto& attribute, std::uint32_t bit) {
      if ((header.attributes & bit) == 0) return;
      attribute.resize(header.vertices);
      reader.read(std::span(attribute));
    });
    const glm::mat4x3& transform = arrivals.transforms.emplace_back(header.transform);
    arrivals.pieces.push_back({&mesh, &transform, 0, header.triangles, header.primitive});
  }
}

comm::Buffer pack_numbers(std::span<const Piece> pieces) {
  std::vector<std::uint64_t> ranges;
  for (const Piece& piece : pieces) {
    ranges.push_back(piece.primitive);
    ranges.push_back(piece.primitive + piece.count);
  }
  return comm::Buffer::of(std::span<const std::uint64_t>(ranges));
}

void unpack_numbers(const comm::Buffer& message, const scenes::Scene& scene,
                    std::span<const std::uint64_t> first_primitives, Arrivals& arrivals) {
  const std::span<const std::uint64_t> ranges = message.as<std::uint64_t>();
  for (std::size_t i = 0; i + 1 < ranges.size(); i += 2) {
    for (const Piece& piece : pieces_of(scene, first_primitives, ranges[i], ranges[i + 1]))
      arrivals.pieces.push_back(piece);
  }
}

}  // namespace delray::raster
