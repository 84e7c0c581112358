// Wavefront OBJ: "v x y z" and "f a b c", vertices numbered from 1.
#include "delaunay/files/mesh_writers.h"
#include "delaunay/files/output.h"

namespace delray::delaunay {

void write_obj(const std::filesystem::path& path, const MeshView& mesh) {
  Output output(path);
  output.write("# written by delray\n");
  write_rows(output, mesh.points.size(), [&](std::size_t i, std::string& row) {
    row += 'v';
    for (int k = 0; k < 3; ++k) {
      row += ' ';
      append_number(row, mesh.points.positions[i][k]);
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
