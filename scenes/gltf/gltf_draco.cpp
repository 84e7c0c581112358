// Decodes what KHR_draco_mesh_compression puts in the place of accessors: a buffer view holds a
// mesh and "attributes" tells which of the mesh's attributes, by their numbers, are which of
// glTF's.
#include "scenes/gltf/gltf_draco.h"

#include <draco/compression/decode.h>
#include <draco/core/varint_decoding.h>
#include <draco/metadata/metadata_decoder.h>

#include <array>
#include <cmath>
#include <exception>
#include <limits>
#include <optional>

namespace delray::scenes::internal {
namespace {

// The value that stands for 1 in a normalised integer of this type; 1 of floats.
double unit_of(draco::DataType type) {
  switch (type) {
    case draco::DT_INT8:
      return std::numeric_limits<std::int8_t>::max();
    case draco::DT_UINT8:
      return std::numeric_limits<std::uint8_t>::max();
    case draco::DT_INT16:
      return std::numeric_limits<std::int16_t>::max();
    case draco::DT_UINT16:
      return std::numeric_limits<std::uint16_t>::max();
    default:
      return 1;
  }
}

void check_indices(const draco::Mesh& mesh, const JsonView& extension) {
  for (draco::FaceIndex f(0); f < mesh.num_faces(); ++f) {
    for (const draco::PointIndex& point : mesh.face(f)) {
      if (point.value() >= mesh.num_points()) extension.fail("an index is out of range");
    }
  }
}

struct Sizes {
  std::uint32_t triangles = 0, vertices = 0;
};

// The counts that the bytes say they unpack to: the decoder believes them before it looks any
// further. glTF has bitstreams of version 2.2 only.
std::optional<Sizes> announced(std::string_view bytes) {
  draco::DecoderBuffer buffer;
  buffer.Init(bytes.data(), bytes.size());
  std::array<char, 5> magic{};
  std::array<std::uint8_t, 4> start{};  // two parts of the version, kind of geometry, method
  std::uint16_t flags = 0;
  if (!buffer.Decode(&magic) || !buffer.Decode(&start) || !buffer.Decode(&flags)) return {};
  const auto [version, revision, geometry, method] = start;
  if (version != 2 || revision != 2 || geometry != draco::TRIANGULAR_MESH) return {};
  buffer.set_bitstream_version(DRACO_BITSTREAM_VERSION(2, 2));
  if ((flags & METADATA_FLAG_MASK) != 0) {
    draco::GeometryMetadata ignored;
    if (!draco::MetadataDecoder().DecodeGeometryMetadata(&buffer, &ignored)) return {};
  }
  Sizes sizes;
  std::uint8_t traversal = 0;
  const bool edgebreaker = method == draco::MESH_EDGEBREAKER_ENCODING;
  if (edgebreaker && !buffer.Decode(&traversal)) return {};
  std::uint32_t* const first = edgebreaker ? &sizes.vertices : &sizes.triangles;
  std::uint32_t* const second = edgebreaker ? &sizes.triangles : &sizes.vertices;
  if (!draco::DecodeVarint(first, &buffer) || !draco::DecodeVarint(second, &buffer)) return {};
  return sizes;
}

std::unique_ptr<draco::Mesh> decode(const Source& source, std::string_view bytes,
                                    const JsonView& extension) {
  const std::optional<Sizes> sizes = announced(bytes);
  if (!sizes) extension.fail("is no mesh that Draco 1.0 or later compressed");
  // Its table of corners and ours of triangles; positions and what else vertices have, both as they
  // were compressed and as they are.
  constexpr std::uint64_t kBytesOfTriangle = 72, kBytesOfVertex = 64;
  source.require_memory(sizes->triangles * kBytesOfTriangle + sizes->vertices * kBytesOfVertex,
                        extension.place());
  draco::DecoderBuffer buffer;
  buffer.Init(bytes.data(), bytes.size());
  std::string why;
  try {
    draco::Decoder decoder;
    auto result = decoder.DecodeMeshFromBuffer(&buffer);
    if (result.ok()) return std::move(result).value();
    why = result.status().error_msg_string();
  } catch (const std::length_error&) {
    why = "a count is too large";
  }
  extension.fail("cannot be decoded" + (why.empty() ? "" : ": " + why));
}

const draco::PointAttribute* attribute_of(const draco::Mesh& mesh, const JsonView& extension,
                                          const char* name) {
  const JsonView number = extension["attributes"][name];
  if (!number) return nullptr;
  const std::uint64_t id = number.whole();
  const draco::PointAttribute* attribute =
      id <= std::numeric_limits<std::uint32_t>::max()
          ? mesh.GetAttributeByUniqueId(static_cast<std::uint32_t>(id))
          : nullptr;
  if (!attribute) number.fail("there is no such attribute");
  return attribute;
}

}  // namespace

DracoPrimitive::DracoPrimitive(std::unique_ptr<draco::Mesh> mesh, const JsonView& extension)
    : mesh_(std::move(mesh)), extension_(extension) {}
DracoPrimitive::DracoPrimitive(DracoPrimitive&&) noexcept = default;
DracoPrimitive::~DracoPrimitive() = default;

std::optional<DracoPrimitive> DracoPrimitive::read(const GltfDocument& document,
                                                   const JsonView& primitive) {
  const JsonView extension = primitive["extensions"]["KHR_draco_mesh_compression"];
  if (!extension) return std::nullopt;
  const std::uint32_t view =
      extension["bufferView"].reference(document.root()["bufferViews"].size());
  if (view == kNone) extension["bufferView"].fail("is missing");
  const GltfBytes bytes = buffer_view(document, view);
  std::string buffer;
  std::unique_ptr<draco::Mesh> mesh =
      decode(document.source, bytes.read(0, bytes.size, buffer), extension);
  check_indices(*mesh, extension);
  return DracoPrimitive(std::move(mesh), extension);
}

std::size_t DracoPrimitive::vertices() const { return mesh_->num_points(); }

std::vector<std::uint32_t> DracoPrimitive::indices() const {
  std::vector<std::uint32_t> indices;
  indices.reserve(std::size_t{mesh_->num_faces()} * 3);
  for (draco::FaceIndex f(0); f < mesh_->num_faces(); ++f) {
    for (const draco::PointIndex& point : mesh_->face(f)) indices.push_back(point.value());
  }
  return indices;
}

bool DracoPrimitive::has(const char* attribute) const {
  return static_cast<bool>(extension_["attributes"][attribute]);
}

int DracoPrimitive::components(const char* attribute) const {
  return attribute_of(*mesh_, extension_, attribute)->num_components();
}

template <int N>
std::vector<glm::vec<N, float>> DracoPrimitive::vectors(const char* attribute,
                                                        bool normalized) const {
  const draco::PointAttribute& from = *attribute_of(*mesh_, extension_, attribute);
  const JsonView place = extension_["attributes"][attribute];
  if (from.num_components() != N) {
    place.fail("has " + std::to_string(from.num_components()) + " components, not " +
               std::to_string(N));
  }
  // Draco divides by itself where the attribute says so.
  const bool divide = normalized && !from.normalized();
  const auto scale = static_cast<float>(divide ? 1 / unit_of(from.data_type()) : 1);
  std::vector<glm::vec<N, float>> values(vertices());
  for (std::uint32_t i = 0; i < values.size(); ++i) {
    const draco::AttributeValueIndex index = from.mapped_index(draco::PointIndex(i));
    bool usable = index.value() < from.size() && from.ConvertValue<float, N>(index, &values[i][0]);
    for (int k = 0; k < N; ++k) {
      values[i][k] *= scale;
      usable = usable && std::isfinite(values[i][k]);
    }
    if (!usable) place.fail("element " + std::to_string(i) + " is missing or not finite");
  }
  return values;
}

template std::vector<glm::vec2> DracoPrimitive::vectors<2>(const char*, bool) const;
template std::vector<glm::vec3> DracoPrimitive::vectors<3>(const char*, bool) const;
template std::vector<glm::vec4> DracoPrimitive::vectors<4>(const char*, bool) const;

}  // namespace delray::scenes::internal
