// .node and .ele, numbered from 0 (see read_node.cpp). Triangles are 2D for the programs that read
// these files, so a height goes into an attribute.
#include <span>

#include "delaunay/dimensions.h"
#include "delaunay/files/mesh_writers.h"
#include "delaunay/files/output.h"

namespace delray::delaunay {
namespace {

// at(i, k) is column k of point i, of which the first `dim` are coordinates.
template <class At>
void write_point_rows(Output& output, std::size_t points, int dim, int columns, At&& at) {
  output.write(std::to_string(points) + " " + std::to_string(dim) + " " +
               std::to_string(columns - dim) + " 0\n");
  write_rows(output, points, [&](std::size_t i, std::string& row) {
    append_number(row, std::uint64_t{i});
    for (int k = 0; k < columns; ++k) {
      row += ' ';
      append_number(row, at(i, k));
    }
    row += '\n';
  });
}

void write_rows_of_points(Output& output, const PointCloud& points, int dim) {
  write_point_rows(output, points.size(), dim, points.has_z || dim == 3 ? 3 : 2,
                   [&](std::size_t i, int k) { return points.positions[i][k]; });
}

void write_elements(Output& output, std::size_t corners, std::span<const std::uint32_t> simplices) {
  const std::size_t count = simplices.size() / corners;
  output.write(std::to_string(count) + " " + std::to_string(corners) + " 0\n");
  write_rows(output, count, [&](std::size_t i, std::string& row) {
    append_number(row, std::uint64_t{i});
    for (std::size_t k = 0; k < corners; ++k) {
      row += ' ';
      append_number(row, std::uint64_t{simplices[i * corners + k]});
    }
    row += '\n';
  });
}

// Calls write_points(output) for X.node.
template <class WritePoints>
void write_both(const std::filesystem::path& path, std::size_t corners,
                std::span<const std::uint32_t> simplices, WritePoints&& write_points) {
  Output nodes(std::filesystem::path(path).replace_extension(".node"));
  Output elements(std::filesystem::path(path).replace_extension(".ele"));
  write_points(nodes);
  write_elements(elements, corners, simplices);
  nodes.close();
  elements.close();
  nodes.commit();
  elements.commit();
}

}  // namespace

void write_node(const std::filesystem::path& path, const MeshView& mesh) {
  write_both(path, static_cast<std::size_t>(mesh.corners), mesh.simplices,
             [&](Output& nodes) { write_rows_of_points(nodes, mesh.points, mesh.corners - 1); });
}

void write_table_mesh(const std::filesystem::path& path, const PointTable& points,
                      const Triangulation& triangulation) {
  const PointView<double> view = points.view();
  write_both(
      path, static_cast<std::size_t>(points.dim) + 1, triangulation.vertices,
      [&](Output& nodes) { write_point_rows(nodes, points.size(), points.dim, points.dim, view); });
}

void write_node_points(const std::filesystem::path& path, const PointCloud& points) {
  Output output(path);
  write_rows_of_points(output, points, points.has_z ? 3 : 2);
  output.close();
  output.commit();
}

}  // namespace delray::delaunay
