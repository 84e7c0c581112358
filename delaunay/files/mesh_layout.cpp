// Writes arrays run by run, formatted in parallel.
#include "delaunay/files/mesh_layout.h"

#include "delaunay/files/output.h"

namespace delray::delaunay {

MeshShape shape_of(const MeshView& mesh) {
  const PointCloud& points = mesh.points;
  return {points.size(),
          mesh.size(),
          mesh.corners,
          points.has_z,
          !points.colours.empty(),
          !points.intensity.empty(),
          !points.classification.empty(),
          !mesh.created_by.empty()};
}

void write_in_layout(const std::filesystem::path& path, const MeshLayout& layout,
                     const MeshView& mesh) {
  const auto corners = static_cast<std::size_t>(mesh.corners);
  Output output(path);
  output.write(layout.header);
  for (const MeshArray& array : layout.arrays) {
    output.write(array.before);
    const std::size_t n = array.of_points ? mesh.points.size() : mesh.size();
    write_runs(output, n, [&](std::size_t first, std::size_t last, std::string& rows) {
      if (array.of_points) return array.of_points(mesh.points, first, last, rows);
      array.of_simplices({first, mesh.simplices.subspan(first * corners, (last - first) * corners),
                          mesh.created_by.empty() ? mesh.created_by
                                                  : mesh.created_by.subspan(first, last - first)},
                         rows);
    });
  }
  output.write(layout.end);
  output.close();
  output.commit();
}

}  // namespace delray::delaunay
