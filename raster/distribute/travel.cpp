// Packs pieces of meshes with the vertices that they use, renumbered by a table where these lie
// close together and else by binary search in a sorted list, or as ranges of primitive numbers
// where the receiver has the scene.
#include "raster/distribute/travel.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace delray::raster {
namespace {

// Followed by triangles, then positions, then the attributes that `attributes` names, in ascending
// order of their bits: all in units of four bytes.
struct PieceHeader {
  std::uint64_t primitive;
  std::uint32_t vertices, triangles, material, attributes;
  glm::mat4x3 transform;
};
static_assert(sizeof(PieceHeader) == 72);

// Calls f(attribute, bit) for each attribute that a mesh may have.
template <class Mesh, class F>
void for_each_attribute(Mesh& mesh, F&& f) {
  f(mesh.normals, 1U);
  f(mesh.uvs, 2U);
  f(mesh.tangents, 4U);
  f(mesh.colours, 8U);
  f(mesh.uvs2, 16U);
}

// The vertices that a piece uses, in the order in which its triangles name them first, and their
// numbers in that order: open addressing, at most half full.
class UsedVertices {
 public:
  void set(std::span<const glm::uvec3> triangles) {
    used_.clear();
    local_.clear();
    bits_ = std::bit_width(6 * triangles.size());
    slots_.assign(std::size_t{1} << bits_, {kFree, 0});
    for (const glm::uvec3& t : triangles) local_.emplace_back(add(t.x), add(t.y), add(t.z));
  }
  std::span<const std::uint32_t> used() const { return used_; }
  std::span<const glm::uvec3> triangles() const { return local_; }  // by numbers of those used

 private:
  static constexpr std::uint32_t kFree = 0xFFFFFFFFU;
  struct Slot {
    std::uint32_t vertex, number;
  };

  std::uint32_t add(std::uint32_t vertex) {
    // Fibonacci hashing (Knuth 1973, 6.4).
    std::size_t slot = std::uint64_t{vertex * 0x9E3779B9U} << bits_ >> 32;
    while (slots_[slot].vertex != vertex) {
      if (slots_[slot].vertex == kFree) {
        slots_[slot] = {vertex, static_cast<std::uint32_t>(used_.size())};
        used_.push_back(vertex);
        break;
      }
      slot = (slot + 1) & (slots_.size() - 1);
    }
    return slots_[slot].number;
  }

  int bits_ = 0;
  std::vector<Slot> slots_;
  std::vector<std::uint32_t> used_;
  std::vector<glm::uvec3> local_;
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
  std::vector<std::byte> bytes;
  UsedVertices vertices;
  for (const Piece& piece : pieces) {
    const scenes::Mesh& mesh = *piece.mesh;
    const auto triangles = std::span(mesh.triangles).subspan(piece.first, piece.count);
    vertices.set(triangles);
    const std::span<const std::uint32_t> used = vertices.used();
    PieceHeader header{
        piece.primitive, static_cast<std::uint32_t>(used.size()), piece.count, mesh.material, 0,
        *piece.transform};
    std::size_t vertex_bytes = sizeof(mesh.positions[0]);
    for_each_attribute(mesh, [&](const auto& attribute, std::uint32_t bit) {
      if (attribute.empty()) return;
      header.attributes |= bit;
      vertex_bytes += sizeof(attribute[0]);
    });
    const std::size_t before = bytes.size();
    bytes.resize(before + sizeof(PieceHeader) + triangles.size_bytes() +
                 used.size() * vertex_bytes);
    std::byte* to = bytes.data() + before;
    const auto write = [&](const auto& value) {
      std::memcpy(to, &value, sizeof value);
      to += sizeof value;
    };
    write(header);
    for (const glm::uvec3& t : vertices.triangles()) write(t);
    const auto write_used = [&](const auto& attribute) {
      for (const std::uint32_t vertex : used) write(attribute[vertex]);
    };
    write_used(mesh.positions);
    for_each_attribute(mesh, [&](const auto& attribute, std::uint32_t) {
      if (!attribute.empty()) write_used(attribute);
    });
  }
  return comm::Buffer::of(std::span<const std::byte>(bytes));
}

void unpack_geometry(const comm::Buffer& message, Arrivals& arrivals) {
  Reader reader(message);
  while (!reader.at_end()) {
    PieceHeader header;
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
