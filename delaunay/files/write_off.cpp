// OFF (Geomview): the keyword, the three counts with 0 for edges, then "x y z" and "3 a b c",
// vertices numbered from 0.
#include "delaunay/files/mesh_writers.h"
#include "delaunay/files/output.h"
#include "files/format.h"

namespace delray::delaunay {

void write_off(const std::filesystem::path& path, const MeshView& mesh) {
  Output output(path);
  output.write("OFF\n# " + std::string(files::kWrittenByDelray) + "\n" +
               std::to_string(mesh.points.size()) + " " + std::to_string(mesh.size()) + " 0\n");
  write_rows(output, mesh.points.size(), [&](std::size_t i, std::string& row) {
    for (int k = 0; k < 3; ++k) {
      append_number(row, mesh.points.positions[i][k]);
      row += k < 2 ? ' ' : '\n';
    }
  });
  write_rows(output, mesh.size(), [&](std::size_t i, std::string& row) {
    row += '3';
    for (std::size_t k = 0; k < 3; ++k) {
      row += ' ';
      append_number(row, std::uint64_t{mesh.simplices[i * 3 + k]});
    }
    row += '\n';
  });
  output.close();
  output.commit();
}

}  // namespace delray::delaunay
