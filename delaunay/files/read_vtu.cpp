// VTU with appended raw arrays, as write_vtu.cpp writes it.
#include <cmath>
#include <cstring>
#include <optional>

#include "delaunay/files/point_readers.h"
#include "delaunay/files/text_rows.h"

namespace delray::delaunay {
namespace {

constexpr std::string_view kKind =
    "only VTU with raw appended arrays, as delray writes it, is read";

// The parts of a file: XML, and the bytes that it refers to.
struct Parts {
  std::string_view xml, appended;
  std::size_t appended_byte = 0;
};

Parts split(const Input& input) {
  constexpr std::string_view kAppended = "<AppendedData encoding=\"raw\">";
  const std::size_t tag = input.content.find(kAppended);
  if (tag == std::string_view::npos) fail(input, "", std::string(kKind));
  const std::size_t mark = input.content.find('_', tag + kAppended.size());
  if (mark == std::string_view::npos) fail(input, at_byte(tag), "the appended data are cut off");
  Parts parts{input.content.substr(0, tag), input.content.substr(mark + 1), mark + 1};
  for (const std::string_view needed : {"byte_order=\"LittleEndian\"", "header_type=\"UInt64\""}) {
    if (parts.xml.find(needed) == std::string_view::npos) fail(input, "", std::string(kKind));
  }
  if (parts.xml.find("compressor=") != std::string_view::npos) fail(input, "", std::string(kKind));
  return parts;
}

std::string_view attribute(std::string_view tag, std::string_view name) {
  const std::string mark = " " + std::string(name) + "=\"";
  const std::size_t begin = tag.find(mark);
  if (begin == std::string_view::npos) return {};
  tag.remove_prefix(begin + mark.size());
  return tag.substr(0, tag.find('"'));
}

// What the file calls the type of an array; empty if it has none of this name.
std::string_view type_of_array(const Parts& parts, std::string_view name) {
  const std::size_t mark = parts.xml.find(" Name=\"" + std::string(name) + "\"");
  if (mark == std::string_view::npos) return {};
  const std::size_t begin = parts.xml.rfind('<', mark);
  if (begin == std::string_view::npos) return {};
  return attribute(parts.xml.substr(begin, parts.xml.find('>', begin) - begin), "type");
}

// The bytes of an array of `type`; none if the file has no array of this name.
std::optional<std::string_view> find_array(const Input& input, const Parts& parts,
                                           std::string_view name, std::string_view type) {
  constexpr std::string_view kTag = "<DataArray";
  for (std::size_t at = parts.xml.find(kTag); at != std::string_view::npos;
       at = parts.xml.find(kTag, at + 1)) {
    const std::string_view tag = parts.xml.substr(at, parts.xml.find('>', at) - at);
    if (attribute(tag, "Name") != name) continue;
    std::int64_t offset = 0;
    if (attribute(tag, "type") != type || attribute(tag, "format") != "appended" ||
        !parse_integer(attribute(tag, "offset"), offset)) {
      fail(input, at_byte(at), std::string(kKind));
    }
    std::uint64_t length = 0;
    const std::uint64_t size = parts.appended.size();
    if (offset < 0 || size < sizeof length ||
        static_cast<std::uint64_t>(offset) > size - sizeof length) {
      fail(input, at_byte(at), "the array begins after the end of the file");
    }
    const std::size_t begin = static_cast<std::size_t>(offset);
    std::memcpy(&length, parts.appended.data() + begin, sizeof length);
    if (length > size - sizeof length - begin) {
      fail(input, at_byte(parts.appended_byte + begin), "the array is longer than the file");
    }
    return parts.appended.substr(begin + sizeof length, length);
  }
  return std::nullopt;
}

std::string_view require_array(const Input& input, const Parts& parts, std::string_view name,
                               std::string_view type) {
  const auto array = find_array(input, parts, name, type);
  if (!array) fail(input, "", "has no array \"" + std::string(name) + "\"");
  return *array;
}

template <class T>
std::vector<T> copy_rows(const Input& input, std::string_view bytes, const char* name) {
  if (bytes.size() % sizeof(T) != 0) {
    fail(input, "", std::string("array \"") + name + "\" has an odd length");
  }
  input.require_memory(bytes.size());
  std::vector<T> rows(bytes.size() / sizeof(T));
  if (!rows.empty()) std::memcpy(rows.data(), bytes.data(), bytes.size());
  return rows;
}

// An attribute of the points; empty if the file does not have it.
template <class T>
std::vector<T> copy_attribute(const Input& input, const Parts& parts, const char* name,
                              std::string_view type, std::size_t points) {
  const auto bytes = find_array(input, parts, name, type);
  if (!bytes) return {};
  std::vector<T> rows = copy_rows<T>(input, *bytes, name);
  if (rows.size() != points) {
    fail(input, "", std::string("array \"") + name + "\" has not one entry per point");
  }
  return rows;
}

PointCloud read_cloud(const Input& input, const Parts& parts) {
  PointCloud cloud;
  cloud.has_z = true;
  cloud.positions =
      copy_rows<glm::dvec3>(input, require_array(input, parts, "Points", "Float64"), "Points");
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const glm::dvec3& p = cloud.positions[i];
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
      fail(input, "point " + std::to_string(i), "not a finite number");
    }
  }
  const std::size_t n = cloud.size();
  cloud.colours = copy_attribute<glm::u8vec4>(input, parts, "colour", "UInt8", n);
  cloud.intensity = copy_attribute<float>(input, parts, "intensity", "Float32", n);
  cloud.classification = copy_attribute<std::uint8_t>(input, parts, "classification", "UInt8", n);
  return cloud;
}

// The dimension of the cells, which must be of one kind.
int cell_dimension(const Input& input, std::string_view types) {
  constexpr char kTriangle = 5, kTetrahedron = 10;
  if (types.empty()) return 2;
  const char type = types.front();
  if ((type != kTriangle && type != kTetrahedron) ||
      types.find_first_not_of(type) != std::string_view::npos) {
    fail(input, "", "the cells are not all triangles or all tetrahedra");
  }
  return type == kTriangle ? 2 : 3;
}

template <class Index>
void copy_corners(const Input& input, const Parts& parts, std::string_view type, std::size_t wanted,
                  PointMesh& mesh) {
  const auto connectivity =
      copy_rows<Index>(input, require_array(input, parts, "connectivity", type), "connectivity");
  if (connectivity.size() != wanted) {
    fail(input, "", "array \"connectivity\" does not match the cells");
  }
  input.require_memory(connectivity.size() * sizeof mesh.triangulation.vertices[0]);
  mesh.triangulation.vertices.resize(connectivity.size());
  const auto corners = static_cast<std::size_t>(mesh.triangulation.dim) + 1;
  for (std::size_t i = 0; i < connectivity.size(); ++i) {
    const Index vertex = connectivity[i];
    if (vertex < 0 || static_cast<std::uint64_t>(vertex) >= mesh.points.size()) {
      fail(input, "cell " + std::to_string(i / corners), "refers to a point that is not there");
    }
    mesh.triangulation.vertices[i] = static_cast<std::uint32_t>(vertex);
  }
}

}  // namespace

PointCloud read_vtu_points(const Input& input) { return read_cloud(input, split(input)); }

PointMesh read_vtu_mesh(const Input& input) {
  const Parts parts = split(input);
  PointMesh mesh;
  mesh.points = read_cloud(input, parts);
  const std::string_view types = require_array(input, parts, "types", "UInt8");
  mesh.triangulation.dim = cell_dimension(input, types);
  const auto corners = static_cast<std::size_t>(mesh.triangulation.dim) + 1;
  // Pieces of large meshes have indices of 32 bits.
  if (type_of_array(parts, "connectivity") == "Int32") {
    copy_corners<std::int32_t>(input, parts, "Int32", types.size() * corners, mesh);
  } else {
    copy_corners<std::int64_t>(input, parts, "Int64", types.size() * corners, mesh);
  }
  return mesh;
}

}  // namespace delray::delaunay
