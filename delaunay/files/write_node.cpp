// .node and .ele, numbered from 0 (see read_node.cpp). Triangles are 2D for the programs that read
// these files, so a height goes into an attribute.
#include "delaunay/files/mesh_writers.h"
#include "delaunay/files/output.h"

namespace delray::delaunay {
namespace {

void write_rows_of_points(Output& output, const PointCloud& points, int dim) {
  const int columns = points.has_z || dim == 3 ? 3 : 2;
  output.write(std::to_string(points.size()) + " " + std::to_string(dim) + " " +
               std::to_string(columns - dim) + " 0\n");
  write_rows(output, points.size(), [&](std::size_t i, std::string& row) {
    append_number(row, std::uint64_t{i});
    for (int k = 0; k < columns; ++k) {
      row += ' ';
      append_number(row, points.positions[i][k]);
    }
    row += '\n';
  });
}

}  // namespace

void write_node(const std::filesystem::path& path, const MeshView& mesh) {
  Output nodes(std::filesystem::path(path).replace_extension(".node"));
  Output elements(std::filesystem::path(path).replace_extension(".ele"));
  write_rows_of_points(nodes, mesh.points, mesh.corners - 1);
  const auto corners = static_cast<std::size_t>(mesh.corners);
  elements.write(std::to_string(mesh.size()) + " " + std::to_string(corners) + " 0\n");
  write_rows(elements, mesh.size(), [&](std::size_t i, std::string& row) {
    append_number(row, std::uint64_t{i});
    for (std::size_t k = 0; k < corners; ++k) {
      row += ' ';
      append_number(row, std::uint64_t{mesh.simplices[i * corners + k]});
    }
    row += '\n';
  });
  nodes.close();
  elements.close();
  nodes.commit();
  elements.commit();
}

void write_node_points(const std::filesystem::path& path, const PointCloud& points) {
  Output output(path);
  write_rows_of_points(output, points, points.has_z ? 3 : 2);
  output.close();
  output.commit();
}

}  // namespace delray::delaunay
