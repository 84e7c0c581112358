// OFF (Geomview): "OFF", the numbers of vertices, faces and edges, then vertices and faces, one to
// a line. Prefixes of the keyword say what follows the coordinates of a vertex; it is skipped, but
// for the colours of COFF.
#include <algorithm>
#include <array>
#include <cmath>

#include "delaunay/files/point_readers.h"
#include "delaunay/files/text_rows.h"

namespace delray::delaunay {
namespace {

struct OffHeader {
  std::size_t vertices = 0, faces = 0;
  bool colours = false;
  TextPlace body;
};

OffHeader parse_off_header(const Input& input) {
  OffHeader header;
  TextPlace place;
  if (input.content.starts_with("\xef\xbb\xbf")) place.byte = 3;  // UTF-8 byte order mark
  std::array<std::size_t, 3> counts{};
  std::size_t found = 0;
  bool first = true;
  while (found < 2) {
    const RowIndex row = index_rows(input, place, 1, is_data_row);
    if (row.count == 0) fail(input, "", "the header is not complete");
    place = row.blocks[0];
    const std::size_t number = place.line;
    Fields fields(input, take_line(input.content, place), number);
    std::string_view keyword;
    if (first) {
      if (!fields.next(keyword) || !keyword.ends_with("OFF")) {
        fields.fail("does not begin with \"OFF\"");
      }
      if (keyword.find_first_of("4n") != std::string_view::npos) {
        fields.fail("points of other dimensions than three are not supported");
      }
      header.colours = keyword == "COFF";
      first = false;
    }
    Fields rest = fields;
    for (std::string_view field; found < 3 && rest.next(field); ++found) {
      if (field == "BINARY") fields.fail("binary OFF is not supported");
      const std::int64_t count = fields.integer();
      if (count < 0) fields.fail("a negative number");
      counts[found] = static_cast<std::size_t>(count);
    }
  }
  header.vertices = counts[0];
  header.faces = counts[1];
  header.body = place;
  return header;
}

RowIndex index_exactly(const Input& input, TextPlace begin, std::size_t count, const char* what) {
  RowIndex rows = index_rows(input, begin, count, is_data_row);
  if (rows.count < count) {
    fail(input, at_line(rows.end.line),
         "the header announces " + std::to_string(count) + " " + what + ", the file has " +
             std::to_string(rows.count));
  }
  return rows;
}

std::size_t count_fields(const Input& input, const RowIndex& rows) {
  if (rows.count == 0) return 0;
  TextPlace place = rows.blocks[0];
  Fields fields(input, take_line(input.content, place), place.line);
  std::size_t count = 0;
  for (std::string_view field; fields.next(field);) ++count;
  return count;
}

// Colours are whole numbers to 255 or fractions to 1.
void read_colours(const Input& input, const RowIndex& rows, PointCloud& cloud) {
  std::vector<glm::dvec3> colours(rows.count);
  for_each_row(input, rows, is_data_row, [&](std::size_t i, Fields& fields) {
    for (int k = 0; k < 3; ++k) fields.number();
    for (int k = 0; k < 3; ++k) colours[i][k] = fields.number();
  });
  double top = 0;
  for (const glm::dvec3& colour : colours) top = std::max({top, colour.x, colour.y, colour.z});
  const double scale = top > 1 ? 1 : 255;
  cloud.colours.resize(rows.count);
  for (std::size_t i = 0; i < rows.count; ++i) {
    const glm::dvec3 bytes = glm::clamp(glm::round(colours[i] * scale), 0.0, 255.0);
    cloud.colours[i] = glm::u8vec4(glm::u8vec3(bytes), 255);
  }
}

PointCloud read_vertices(const Input& input, const RowIndex& rows, bool colours) {
  PointCloud cloud;
  cloud.has_z = true;
  input.require_points(rows.count);
  cloud.positions.resize(rows.count);
  for_each_row(input, rows, is_data_row, [&](std::size_t i, Fields& fields) {
    for (int k = 0; k < 3; ++k) cloud.positions[i][k] = fields.number();
  });
  if (colours && count_fields(input, rows) >= 6) read_colours(input, rows, cloud);
  return cloud;
}

}  // namespace

PointCloud read_off_points(const Input& input) {
  const OffHeader header = parse_off_header(input);
  const RowIndex rows = index_exactly(input, header.body, header.vertices, "vertices");
  return read_vertices(input, rows, header.colours);
}

PointMesh read_off_mesh(const Input& input) {
  const OffHeader header = parse_off_header(input);
  const RowIndex rows = index_exactly(input, header.body, header.vertices, "vertices");
  PointMesh mesh;
  mesh.points = read_vertices(input, rows, header.colours);
  const RowIndex faces = index_exactly(input, rows.end, header.faces, "faces");
  std::vector<std::uint32_t>& vertices = mesh.triangulation.vertices;
  input.require_memory(faces.count * 3 * sizeof vertices[0]);
  vertices.resize(faces.count * 3);
  for_each_row(input, faces, is_data_row, [&](std::size_t i, Fields& fields) {
    if (fields.integer() != 3) fields.fail("a triangle is expected");
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int64_t vertex = fields.integer();
      if (vertex < 0 || static_cast<std::uint64_t>(vertex) >= rows.count) {
        fields.fail("refers to a vertex that is not there");
      }
      vertices[i * 3 + k] = static_cast<std::uint32_t>(vertex);
    }
  });
  return mesh;
}

}  // namespace delray::delaunay
