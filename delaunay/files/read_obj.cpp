// Wavefront OBJ: "v x y z [w | r g b]" and "f a b c", each corner as "vertex[/texture[/normal]]".
#include <algorithm>
#include <cmath>

#include "delaunay/files/point_readers.h"
#include "delaunay/files/text_rows.h"

namespace delray::delaunay {
namespace {

bool has_keyword(std::string_view line, char keyword) {
  line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
  return line.size() > 1 && line[0] == keyword && (line[1] == ' ' || line[1] == '\t');
}

bool is_vertex(std::string_view line) { return has_keyword(line, 'v'); }
bool is_line(std::string_view line) { return has_keyword(line, 'l'); }
bool is_face(std::string_view line) { return has_keyword(line, 'f'); }

// Colours are an extension that scanners write: three more numbers from 0 to 1.
bool has_colours(const Input& input, const RowIndex& rows) {
  if (rows.count == 0) return false;
  TextPlace place = rows.blocks[0];
  Fields fields(input, take_line(input.content, place), place.line);
  std::size_t count = 0;
  for (std::string_view field; fields.next(field);) ++count;
  return count >= 7;
}

std::uint8_t fraction_to_byte(double value) {
  return static_cast<std::uint8_t>(std::round(std::clamp(value, 0.0, 1.0) * 255));
}

std::uint32_t read_corner(Fields& fields, std::size_t vertices) {
  std::string_view corner;
  std::int64_t vertex = 0;
  if (!fields.next(corner)) fields.fail("a face needs three corners");
  if (!parse_integer(corner.substr(0, corner.find('/')), vertex)) {
    fields.fail("not a vertex number");
  }
  if (vertex < 0) fields.fail("relative vertex numbers are not supported");
  if (vertex == 0 || static_cast<std::uint64_t>(vertex) > vertices) {
    fields.fail("refers to a vertex that is not there");
  }
  return static_cast<std::uint32_t>(vertex - 1);
}

}  // namespace

PointCloud read_obj_points(const Input& input) {
  const RowIndex rows = index_rows(input, {}, kAllRows, is_vertex);
  PointCloud cloud;
  cloud.has_z = true;
  input.require_points(rows.count);
  cloud.positions.resize(rows.count);
  if (has_colours(input, rows)) cloud.colours.resize(rows.count);
  for_each_row(input, rows, is_vertex, [&](std::size_t i, Fields& fields) {
    std::string_view keyword;
    fields.next(keyword);
    for (int k = 0; k < 3; ++k) cloud.positions[i][k] = fields.number();
    if (cloud.colours.empty()) return;
    cloud.colours[i].a = 255;
    for (int k = 0; k < 3; ++k) cloud.colours[i][k] = fraction_to_byte(fields.number());
  });
  const std::size_t lines = index_rows(input, {}, kAllRows, is_line).count;
  if (lines > 0) cloud.warnings.push_back(edges_left_out(lines));
  return cloud;
}

PointMesh read_obj_mesh(const Input& input) {
  PointMesh mesh;
  mesh.points = read_obj_points(input);
  const RowIndex rows = index_rows(input, {}, kAllRows, is_face);
  std::vector<std::uint32_t>& vertices = mesh.triangulation.vertices;
  input.require_memory(rows.count * 3 * sizeof vertices[0]);
  vertices.resize(rows.count * 3);
  for_each_row(input, rows, is_face, [&](std::size_t i, Fields& fields) {
    std::string_view rest;
    fields.next(rest);
    for (std::size_t k = 0; k < 3; ++k) {
      vertices[i * 3 + k] = read_corner(fields, mesh.points.size());
    }
    if (fields.next(rest)) fields.fail("has more than three corners; a triangle is expected");
  });
  return mesh;
}

}  // namespace delray::delaunay
