// PLY (Turk 1994), binary little-endian, coordinates as double. Bare points in the plane are
// written without z.
#include <cstring>
#include <limits>

#include "delaunay/files/mesh_layout.h"
#include "delaunay/files/mesh_writers.h"
#include "delaunay/files/output.h"
#include "files/format.h"

namespace delray::delaunay {
namespace {

// A mesh needs z for every viewer; points in the plane stay so.
bool writes_z(const MeshShape& shape) { return shape.has_z || shape.simplices > 0; }

std::string ply_mesh_header(const MeshShape& shape) {
  // Many readers know signed indices only.
  const bool large = shape.points > std::numeric_limits<std::int32_t>::max();
  std::string header = "ply\nformat binary_little_endian 1.0\n";
  header += "comment " + std::string(files::kWrittenByDelray) + "\n";
  header += "element vertex " + std::to_string(shape.points) + "\n";
  header += "property double x\nproperty double y\n";
  if (writes_z(shape)) header += "property double z\n";
  if (shape.colours) header += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  header += "element face " + std::to_string(shape.simplices) + "\n";
  header += std::string("property list uchar ") + (large ? "uint" : "int") + " vertex_indices\n";
  return header + "end_header\n";
}

}  // namespace

MeshLayout ply_layout(const MeshShape& shape) {
  const int coordinates = writes_z(shape) ? 3 : 2;
  MeshArray vertices, faces;
  vertices.row_bytes = static_cast<std::uint64_t>(coordinates) * 8 + (shape.colours ? 3 : 0);
  vertices.of_points = [coordinates, colours = shape.colours](const PointCloud& points,
                                                              std::size_t first, std::size_t last,
                                                              std::string& rows) {
    if (coordinates == 3 && !colours) {
      rows.append(reinterpret_cast<const char*>(points.positions.data() + first),
                  (last - first) * sizeof(glm::dvec3));
      return;
    }
    for (std::size_t i = first; i < last; ++i) {
      for (int k = 0; k < coordinates; ++k) append_bytes(rows, points.positions[i][k]);
      for (int k = 0; colours && k < 3; ++k) append_bytes(rows, points.colours[i][k]);
    }
  };
  constexpr std::size_t kFaceBytes = 13;  // how many corners, and these
  faces.row_bytes = kFaceBytes;
  faces.of_simplices = [](const SimplexRun& run, std::string& rows) {
    std::size_t at = rows.size();
    rows.resize(at + run.corners.size() / 3 * kFaceBytes);
    for (std::size_t i = 0; i < run.corners.size(); i += 3, at += kFaceBytes) {
      rows[at] = 3;
      std::memcpy(&rows[at + 1], &run.corners[i], kFaceBytes - 1);
    }
  };
  return {ply_mesh_header(shape), {vertices, faces}, ""};
}

void write_ply(const std::filesystem::path& path, const MeshView& mesh) {
  write_in_layout(path, ply_layout(shape_of(mesh)), mesh);
}

}  // namespace delray::delaunay
