// PLY (Turk 1994), binary little-endian, coordinates as double. Bare points in the plane are
// written without z.
#include <limits>

#include "delaunay/files/mesh_writers.h"
#include "delaunay/files/output.h"
#include "files/format.h"

namespace delray::delaunay {

void write_ply(const std::filesystem::path& path, const MeshView& mesh) {
  const PointCloud& points = mesh.points;
  // Many readers know signed indices only.
  const bool large = points.size() > std::numeric_limits<std::int32_t>::max();
  std::string header = "ply\nformat binary_little_endian 1.0\n";
  header += "comment " + std::string(files::kWrittenByDelray) + "\n";
  header += "element vertex " + std::to_string(points.size()) + "\n";
  header += "property double x\nproperty double y\n";
  // A mesh needs z for every viewer; points in the plane stay so.
  const bool write_z = points.has_z || mesh.size() > 0;
  if (write_z) header += "property double z\n";
  const bool colours = !points.colours.empty();
  if (colours) header += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  header += "element face " + std::to_string(mesh.size()) + "\n";
  header += std::string("property list uchar ") + (large ? "uint" : "int") + " vertex_indices\n";
  header += "end_header\n";

  Output output(path);
  output.write(header);
  write_rows(output, points.size(), [&](std::size_t i, std::string& row) {
    for (int k = 0; k < (write_z ? 3 : 2); ++k) append_bytes(row, points.positions[i][k]);
    for (int k = 0; colours && k < 3; ++k) append_bytes(row, points.colours[i][k]);
  });
  write_rows(output, mesh.size(), [&](std::size_t i, std::string& row) {
    append_bytes(row, std::uint8_t{3});
    for (std::size_t k = 0; k < 3; ++k) append_bytes(row, mesh.simplices[i * 3 + k]);
  });
  output.close();
  output.commit();
}

}  // namespace delray::delaunay
