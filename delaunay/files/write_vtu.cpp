// VTU: the XML format of VTK for unstructured grids, with the arrays appended as raw bytes, each
// after its length in 64 bits.
#include "delaunay/files/mesh_writers.h"
#include "delaunay/files/output.h"

namespace delray::delaunay {
namespace {

constexpr std::uint8_t kTriangle = 5, kTetrahedron = 10;  // VTK's cell types

// The XML element of one array; counts where the arrays begin.
class Arrays {
 public:
  std::string add(const char* type, const char* name, int components, std::size_t bytes) {
    std::string tag = std::string("<DataArray type=\"") + type + "\" Name=\"" + name + "\"";
    if (components > 1) tag += " NumberOfComponents=\"" + std::to_string(components) + "\"";
    tag += " format=\"appended\" offset=\"" + std::to_string(offset_) + "\"/>\n";
    offset_ += sizeof(std::uint64_t) + bytes;
    return tag;
  }

 private:
  std::size_t offset_ = 0;
};

std::string describe(const MeshView& mesh) {
  const PointCloud& points = mesh.points;
  const std::size_t n = points.size(), cells = mesh.size();
  Arrays arrays;
  std::string xml =
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n<UnstructuredGrid>\n";
  xml += "<Piece NumberOfPoints=\"" + std::to_string(n) + "\" NumberOfCells=\"" +
         std::to_string(cells) + "\">\n";
  xml += "<Points>\n" + arrays.add("Float64", "Points", 3, n * 24) + "</Points>\n<Cells>\n";
  xml += arrays.add("Int64", "connectivity", 1, mesh.simplices.size() * 8);
  xml += arrays.add("Int64", "offsets", 1, cells * 8);
  xml += arrays.add("UInt8", "types", 1, cells) + "</Cells>\n<PointData>\n";
  if (!points.colours.empty()) xml += arrays.add("UInt8", "colour", 4, n * 4);
  if (!points.intensity.empty()) xml += arrays.add("Float32", "intensity", 1, n * 4);
  if (!points.classification.empty()) xml += arrays.add("UInt8", "classification", 1, n);
  xml += "</PointData>\n";
  if (!mesh.created_by.empty()) {
    xml += "<CellData>\n" + arrays.add("UInt16", "thread", 1, cells * 2) + "</CellData>\n";
  }
  return xml + "</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";
}

// Writes an array of n rows whose bytes `append` adds one row at a time.
template <class F>
void write_array(Output& output, std::size_t n, std::size_t bytes_per_row, F&& append) {
  std::string length;
  append_bytes(length, std::uint64_t{n * bytes_per_row});
  output.write(length);
  write_rows(output, n, append);
}

template <class T>
void write_values(Output& output, const std::vector<T>& values) {
  write_array(output, values.size(), sizeof(T),
              [&](std::size_t i, std::string& row) { append_bytes(row, values[i]); });
}

}  // namespace

void write_vtu(const std::filesystem::path& path, const MeshView& mesh) {
  Output output(path);
  output.write(describe(mesh));
  const PointCloud& points = mesh.points;
  write_values(output, points.positions);
  write_array(output, mesh.simplices.size(), 8, [&](std::size_t i, std::string& row) {
    append_bytes(row, std::int64_t{mesh.simplices[i]});
  });
  write_array(output, mesh.size(), 8, [&](std::size_t i, std::string& row) {
    append_bytes(row, static_cast<std::int64_t>(i + 1) * mesh.corners);
  });
  write_array(output, mesh.size(), 1, [&](std::size_t, std::string& row) {
    append_bytes(row, mesh.corners == 3 ? kTriangle : kTetrahedron);
  });
  if (!points.colours.empty()) write_values(output, points.colours);
  if (!points.intensity.empty()) write_values(output, points.intensity);
  if (!points.classification.empty()) write_values(output, points.classification);
  if (!mesh.created_by.empty()) {
    write_array(output, mesh.size(), 2,
                [&](std::size_t i, std::string& row) { append_bytes(row, mesh.created_by[i]); });
  }
  output.write("\n</AppendedData>\n</VTKFile>\n");
  output.close();
  output.commit();
}

}  // namespace delray::delaunay
