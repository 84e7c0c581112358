// Pieces as VTU files with arrays appended as raw bytes, each after its length in 64 bits, and the
// PVTU file that names them (VTK File Formats). In this order: coordinates, rows, corners, where
// corners of each cell end, kinds of cells.
#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include "delaunay/pieces/piece_layout.h"

namespace delray::delaunay::internal {
namespace {

constexpr std::uint64_t kLength = sizeof(std::uint64_t);
constexpr std::size_t kPointsAtOnce = 16384;  // points or cells that are converted: 400 kB
constexpr std::string_view kEnd = "\n</AppendedData>\n</VTKFile>\n";

// Sizes of the arrays in bytes, without their lengths.
std::array<std::uint64_t, 5> array_bytes(const PieceShape& shape) {
  return {shape.points * 3 * sizeof(double), shape.points * sizeof(std::int64_t),
          shape.corners() * sizeof(std::int32_t), shape.simplices * sizeof(std::int32_t),
          shape.simplices};
}

std::string vtu_piece_header(const PieceShape& shape) {
  const auto bytes = array_bytes(shape);
  std::array<std::uint64_t, 5> offsets{};
  for (std::size_t i = 1; i < offsets.size(); ++i) {
    offsets[i] = offsets[i - 1] + kLength + bytes[i - 1];
  }
  const auto array = [&](std::size_t i, const char* type, const char* name) {
    return std::string("<DataArray type=\"") + type + "\" Name=\"" + name +
           (i == 0 ? "\" NumberOfComponents=\"3" : "") + "\" format=\"appended\" offset=\"" +
           std::to_string(offsets[i]) + "\"/>\n";
  };
  return "<?xml version=\"1.0\"?>\n"
         "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
         "header_type=\"UInt64\">\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"" +
         std::to_string(shape.points) + "\" NumberOfCells=\"" + std::to_string(shape.simplices) +
         "\">\n<Points>\n" + array(0, "Float64", "Points") +
         "</Points>\n<PointData GlobalIds=\"row\">\n" + array(1, "Int64", "row") +
         "</PointData>\n<Cells>\n" + array(2, "Int32", "connectivity") +
         array(3, "Int32", "offsets") + array(4, "UInt8", "types") +
         "</Cells>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";
}

template <class T>
std::string_view bytes_of(std::span<const T> values) {
  return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}
template <class T>
std::span<char> room_of(std::span<T> values) {
  return {reinterpret_cast<char*>(values.data()), values.size_bytes()};
}
std::string_view length_of(const std::uint64_t& bytes) {
  return bytes_of(std::span<const std::uint64_t>(&bytes, 1));
}

// Calls f(first, last) for runs of [0, n).
template <class F>
void for_runs(std::size_t n, F&& f) {
  for (std::size_t first = 0; first < n; first += kPointsAtOnce) {
    f(first, std::min(n, first + kPointsAtOnce));
  }
}

// The arrays that follow from the number of simplices, given run by run.
template <class Take>
void for_cells(const PieceShape& shape, const std::array<std::uint64_t, 5>& bytes, Take&& take) {
  const std::int32_t corners = shape.dim + 1;
  std::vector<std::int32_t> ends;
  take(length_of(bytes[3]));
  for_runs(shape.simplices, [&](std::size_t first, std::size_t last) {
    ends.clear();
    for (std::size_t i = first; i < last; ++i) {
      ends.push_back(static_cast<std::int32_t>(i + 1) * corners);
    }
    take(bytes_of(std::span<const std::int32_t>(ends)));
  });
  constexpr char kTriangle = 5, kTetrahedron = 10;  // VTK's cell types
  const std::string types(kPointsAtOnce, shape.dim == 2 ? kTriangle : kTetrahedron);
  take(length_of(bytes[4]));
  for_runs(shape.simplices, [&](std::size_t first, std::size_t last) {
    take(std::string_view(types).substr(0, last - first));
  });
}

std::uint64_t vtu_piece_bytes(const PieceShape& shape) {
  std::uint64_t sum = vtu_piece_header(shape).size() + kEnd.size();
  for (const std::uint64_t bytes : array_bytes(shape)) sum += kLength + bytes;
  return sum;
}

void write_vtu_piece(ByteSink& sink, const PieceShape& shape, std::span<const RowPoint> points,
                     std::span<const std::uint32_t> corners) {
  const auto bytes = array_bytes(shape);
  sink.write(vtu_piece_header(shape));
  sink.write(length_of(bytes[0]));
  std::vector<glm::dvec3> positions;
  for_runs(points.size(), [&](std::size_t first, std::size_t last) {
    positions.clear();
    for (std::size_t i = first; i < last; ++i) positions.push_back(points[i].position);
    sink.write(bytes_of(std::span<const glm::dvec3>(positions)));
  });
  sink.write(length_of(bytes[1]));
  std::vector<std::uint64_t> rows;
  for_runs(points.size(), [&](std::size_t first, std::size_t last) {
    rows.clear();
    for (std::size_t i = first; i < last; ++i) rows.push_back(points[i].row);
    sink.write(bytes_of(std::span<const std::uint64_t>(rows)));
  });
  sink.write(length_of(bytes[2]));
  sink.write(bytes_of(corners));
  for_cells(shape, bytes, [&](std::string_view run) { sink.write(run); });
  sink.write(kEnd);
}

void read_vtu_piece(ByteSource& source, const PieceShape& shape, std::span<RowPoint> points,
                    std::span<std::uint32_t> corners) {
  const auto bytes = array_bytes(shape);
  source.expect(vtu_piece_header(shape));
  source.expect(length_of(bytes[0]));
  std::vector<glm::dvec3> positions(std::min(points.size(), kPointsAtOnce));
  for_runs(points.size(), [&](std::size_t first, std::size_t last) {
    source.read(room_of(std::span(positions).first(last - first)));
    for (std::size_t i = first; i < last; ++i) points[i].position = positions[i - first];
  });
  source.expect(length_of(bytes[1]));
  std::vector<std::uint64_t> rows(std::min(points.size(), kPointsAtOnce));
  for_runs(points.size(), [&](std::size_t first, std::size_t last) {
    source.read(room_of(std::span(rows).first(last - first)));
    for (std::size_t i = first; i < last; ++i) points[i].row = rows[i - first];
  });
  source.expect(length_of(bytes[2]));
  source.read(room_of(corners));
  for_cells(shape, bytes, [&](std::string_view run) { source.expect(run); });
  source.expect(kEnd);
}

std::string write_pvtu(const MeshIndex& index) {
  std::string xml =
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"PUnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n<PUnstructuredGrid GhostLevel=\"0\">\n"
      "<PPoints>\n<PDataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\"/>\n"
      "</PPoints>\n<PPointData GlobalIds=\"row\">\n<PDataArray type=\"Int64\" Name=\"row\"/>\n"
      "</PPointData>\n";
  for (const MeshPiece& piece : index.pieces) xml += "<Piece Source=\"" + piece.file + "\"/>\n";
  return xml + "</PUnstructuredGrid>\n</VTKFile>\n";
}

}  // namespace

const PieceCodec kVtuPieces = {{"vtu", "VTU pieces and a PVTU file that names them", true},
                               ".vtu",
                               &vtu_piece_bytes,
                               &write_vtu_piece,
                               &read_vtu_piece,
                               "mesh.pvtu",
                               &write_pvtu};

}  // namespace delray::delaunay::internal
