// The table of mesh writers, chosen by suffix, and the hull facets that formats without tetrahedra
// get instead of a 3D mesh.
#include "delaunay/write_mesh.h"

#include <array>
#include <stdexcept>
#include <string>

#include "delaunay/files/mesh_layout.h"
#include "delaunay/files/mesh_writers.h"
#include "delaunay/mesh/arguments.h"
#include "delaunay/mesh/facets.h"

namespace delray::delaunay {
namespace {

using files::Format;

constexpr std::array kMeshWriters = {
    MeshWriter{Format::ply, "PLY", "binary, coordinates as double, with colours", ".ply", false,
               &write_ply, &ply_layout},
    MeshWriter{Format::obj, "OBJ", "Wavefront, text", ".obj", false, &write_obj},
    MeshWriter{Format::off, "OFF", "object file, text", ".off", false, &write_off},
    MeshWriter{Format::stl, "STL", "binary, coordinates as 32-bit float", ".stl", false,
               &write_stl},
    MeshWriter{Format::vtu, "VTU", "VTK unstructured grid, binary, with all attributes", ".vtu",
               true, &write_vtu, &vtu_layout},
    MeshWriter{Format::node, "NODE+ELE", "two text files, as Triangle and TetGen write them",
               ".node .ele", true, &write_node},
};

}  // namespace

std::span<const MeshWriter> mesh_writers() { return kMeshWriters; }

const MeshWriter& mesh_writer_for(const std::filesystem::path& path) {
  const Format format = path == "-" ? Format::ply : files::format_of_suffix(path);
  for (const MeshWriter& writer : kMeshWriters) {
    if (writer.format == format) return writer;
  }
  throw std::invalid_argument(path.string() + ": no mesh format has the suffix \"" +
                              path.extension().string() + "\"; legal are " +
                              known_suffixes(kMeshWriters));
}

void write_mesh(const std::filesystem::path& path, const PointCloud& points,
                const Triangulation& triangulation, std::span<const std::uint16_t> created_by) {
  const MeshWriter& writer = mesh_writer_for(path);
  internal::check_triangulation(triangulation, points.size());
  internal::check_attributes(points);
  if (!created_by.empty() && created_by.size() != triangulation.size())
    throw std::invalid_argument("created_by: one for each simplex");
  if (triangulation.dim == 3 && !writer.tetrahedra) {
    const std::vector<std::uint32_t> facets = hull_facets(triangulation);
    writer.write(path, {points, 3, facets});
  } else {
    writer.write(path, {points, triangulation.dim + 1, triangulation.vertices, created_by});
  }
}

std::vector<std::uint32_t> hull_facets(const Triangulation& triangulation) {
  internal::check_triangulation(triangulation, std::numeric_limits<std::size_t>::max());
  const std::span<const std::uint32_t> simplices = triangulation.vertices;
  const auto corners = static_cast<std::size_t>(triangulation.dim) + 1;
  std::uint32_t points = 0;
  for (const std::uint32_t vertex : simplices) points = std::max(points, vertex + 1);
  const FacetMates facets = match_facets(triangulation.dim, simplices, points);
  std::vector<std::uint32_t> result;
  for (std::size_t facet = 0; facet < simplices.size(); ++facet) {
    if (facets.mates[facet] != FacetMates::kNone) continue;
    const std::size_t opposite = facet % corners;
    for (const int i : facet_corners(triangulation.dim, opposite)) {
      result.push_back(simplices[facet - opposite + static_cast<std::size_t>(i)]);
    }
  }
  return result;
}

}  // namespace delray::delaunay
