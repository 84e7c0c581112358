// Wavefront OBJ: "v x y z", or "v x y z r g b" with colours from 0 to 1, and "f a b c", vertices
// numbered from 1.
#include <cmath>

#include "delaunay/files/mesh_writers.h"
#include "delaunay/files/output.h"
#include "files/format.h"

namespace delray::delaunay {

void write_obj(const std::filesystem::path& path, const MeshView& mesh) {
  Output output(path);
  output.write("# " + std::string(files::kWrittenByDelray) + "\n");
  write_rows(output, mesh.points.size(), [&](std::size_t i, std::string& row) {
    row += 'v';
    for (int k = 0; k < 3; ++k) {
      row += ' ';
      append_number(row, mesh.points.positions[i][k]);
    }
    for (int k = 0; !mesh.points.colours.empty() && k < 3; ++k) {
      row += ' ';
      // Four digits tell 256 values apart.
      append_number(row, std::round(mesh.points.colours[i][k] / 255.0 * 1e4) / 1e4);
    }
    row += '\n';
  });
  write_rows(output, mesh.size(), [&](std::size_t i, std::string& row) {
    row += 'f';
    for (std::size_t k = 0; k < 3; ++k) {
      row += ' ';
      append_number(row, std::uint64_t{mesh.simplices[i * 3 + k]} + 1);
    }
    row += '\n';
  });
  output.close();
  output.commit();
}

}  // namespace delray::delaunay
