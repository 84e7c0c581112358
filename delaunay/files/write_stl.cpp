// Binary STL: 80 bytes of header, the number of triangles in 32 bits, then normal, three corners
// and two zero bytes for each.
#include <cmath>
#include <limits>

#include "delaunay/files/mesh_writers.h"
#include "delaunay/files/output.h"
#include "files/error.h"
#include "files/format.h"

namespace delray::delaunay {
namespace {

glm::vec3 normal_of(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const glm::dvec3 normal = glm::cross(b - a, c - a);
  const double length = glm::length(normal);
  // Readers take a zero normal as "not given".
  return std::isfinite(length) && length > 0 ? glm::vec3(normal / length) : glm::vec3(0);
}

void append_vector(std::string& row, const glm::vec3& vector) {
  for (int k = 0; k < 3; ++k) append_bytes(row, vector[k]);
}

}  // namespace

void write_stl(const std::filesystem::path& path, const MeshView& mesh) {
  constexpr std::size_t kHeader = 80;
  if (mesh.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw files::FileError(files::Cause::device, path.string(), "",
                           "more triangles than an STL file can count");
  }
  std::string header(files::kWrittenByDelray);
  header.resize(kHeader, ' ');
  append_bytes(header, static_cast<std::uint32_t>(mesh.size()));
  Output output(path);
  output.write(header);
  write_rows(output, mesh.size(), [&](std::size_t i, std::string& row) {
    const auto corner = [&](std::size_t k) {
      return mesh.points.positions[mesh.simplices[i * 3 + k]];
    };
    append_vector(row, normal_of(corner(0), corner(1), corner(2)));
    for (std::size_t k = 0; k < 3; ++k) append_vector(row, glm::vec3(corner(k)));
    append_bytes(row, std::uint16_t{0});
  });
  output.close();
  output.commit();
}

}  // namespace delray::delaunay
