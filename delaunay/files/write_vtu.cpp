// VTU: the XML format of VTK for unstructured grids, with the arrays appended as raw bytes, each
// after its length in 64 bits.
#include <cstring>
#include <utility>

#include "delaunay/files/mesh_layout.h"
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

std::string vtu_mesh_header(const MeshShape& shape) {
  const std::uint64_t n = shape.points, cells = shape.simplices;
  const auto corners = static_cast<std::uint64_t>(shape.corners);
  Arrays arrays;
  std::string xml =
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n<UnstructuredGrid>\n";
  xml += "<Piece NumberOfPoints=\"" + std::to_string(n) + "\" NumberOfCells=\"" +
         std::to_string(cells) + "\">\n";
  xml += "<Points>\n" + arrays.add("Float64", "Points", 3, n * 24) + "</Points>\n<Cells>\n";
  xml += arrays.add("Int64", "connectivity", 1, cells * corners * 8);
  xml += arrays.add("Int64", "offsets", 1, cells * 8);
  xml += arrays.add("UInt8", "types", 1, cells) + "</Cells>\n<PointData>\n";
  if (shape.colours) xml += arrays.add("UInt8", "colour", 4, n * 4);
  if (shape.intensity) xml += arrays.add("Float32", "intensity", 1, n * 4);
  if (shape.classification) xml += arrays.add("UInt8", "classification", 1, n);
  xml += "</PointData>\n";
  if (shape.created_by) {
    xml += "<CellData>\n" + arrays.add("UInt16", "thread", 1, cells * 2) + "</CellData>\n";
  }
  return xml + "</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";
}

// An array without its rows.
MeshArray array_of(std::uint64_t rows, std::uint64_t row_bytes) {
  MeshArray array;
  append_bytes(array.before, rows * row_bytes);
  array.row_bytes = row_bytes;
  return array;
}

// An array that is a member of the points.
template <class T>
MeshArray values_of_points(std::uint64_t points, std::vector<T> PointCloud::*member) {
  MeshArray array = array_of(points, sizeof(T));
  array.of_points = [member](const PointCloud& cloud, std::size_t first, std::size_t last,
                             std::string& rows) {
    rows.append(reinterpret_cast<const char*>((cloud.*member).data() + first),
                (last - first) * sizeof(T));
  };
  return array;
}

// An array of `each` values for each simplex, of which value(run, i) is the i-th of a run.
template <class T, class Value>
MeshArray values_of_simplices(const MeshShape& shape, std::size_t each, Value value) {
  MeshArray array = array_of(shape.simplices, each * sizeof(T));
  const auto corners = static_cast<std::size_t>(shape.corners);
  array.of_simplices = [corners, each, value](const SimplexRun& run, std::string& rows) {
    const std::size_t n = run.corners.size() / corners * each;
    std::size_t at = rows.size();
    rows.resize(at + n * sizeof(T));
    for (std::size_t i = 0; i < n; ++i, at += sizeof(T)) {
      const T number = value(run, i);
      std::memcpy(&rows[at], &number, sizeof(T));
    }
  };
  return array;
}

}  // namespace

MeshLayout vtu_layout(const MeshShape& shape) {
  const auto corners = static_cast<std::uint64_t>(shape.corners);
  MeshLayout layout{vtu_mesh_header(shape), {}, "\n</AppendedData>\n</VTKFile>\n"};
  std::vector<MeshArray>& arrays = layout.arrays;
  arrays.push_back(values_of_points(shape.points, &PointCloud::positions));
  arrays.push_back(values_of_simplices<std::int64_t>(
      shape, corners,
      [](const SimplexRun& run, std::size_t i) { return std::int64_t{run.corners[i]}; }));
  arrays.push_back(values_of_simplices<std::uint64_t>(
      shape, 1,
      [corners](const SimplexRun& run, std::size_t i) { return (run.first + i + 1) * corners; }));
  const std::uint8_t type = corners == 3 ? kTriangle : kTetrahedron;
  arrays.push_back(values_of_simplices<std::uint8_t>(
      shape, 1, [type](const SimplexRun&, std::size_t) { return type; }));
  if (shape.colours) arrays.push_back(values_of_points(shape.points, &PointCloud::colours));
  if (shape.intensity) arrays.push_back(values_of_points(shape.points, &PointCloud::intensity));
  if (shape.classification) {
    arrays.push_back(values_of_points(shape.points, &PointCloud::classification));
  }
  if (shape.created_by) {
    arrays.push_back(values_of_simplices<std::uint16_t>(
        shape, 1, [](const SimplexRun& run, std::size_t i) { return run.created_by[i]; }));
  }
  return layout;
}

void write_vtu(const std::filesystem::path& path, const MeshView& mesh) {
  write_in_layout(path, vtu_layout(shape_of(mesh)), mesh);
}

}  // namespace delray::delaunay
