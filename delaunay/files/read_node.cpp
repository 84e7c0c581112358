// .node and .ele, the files of Triangle (Shewchuk 1996) and TetGen: "n dimension attributes
// markers", then rows "number coordinates attributes marker"; "n corners attributes", then rows
// "number corners attributes". Numbers begin with 0 or 1. Of points in the plane the first
// attribute is taken as z.
#include "delaunay/dimensions.h"
#include "delaunay/files/point_readers.h"

namespace delray::delaunay {
namespace {

NodeTable find_rows(const Input& input, const char* what, TextPlace begin, bool has_columns) {
  const RowIndex first = index_rows(input, begin, 1, is_data_row);
  if (first.count == 0) fail(input, "", std::string("no ") + what);
  TextPlace place = first.blocks[0];
  const std::size_t number = place.line;
  Fields fields(input, take_line(input.content, place), number);
  const std::int64_t count = fields.integer();
  NodeTable table;
  if (has_columns) table.columns = fields.integer();
  std::string_view attributes;
  if (has_columns && fields.next(attributes) && !parse_integer(attributes, table.attributes)) {
    fields.fail("not a number of attributes");
  }
  if (count < 0 || table.attributes < 0) fields.fail("a negative number");
  table.rows = index_rows(input, place, static_cast<std::size_t>(count), is_data_row);
  if (table.rows.count < static_cast<std::size_t>(count)) {
    fields.fail("announces " + std::to_string(count) + " " + what + ", the file has " +
                std::to_string(table.rows.count));
  }
  return table;
}

}  // namespace

NodeTable find_node_table(const Input& input, const char* what, TextPlace begin) {
  return find_rows(input, what, begin, true);
}

NodeTable find_counted_rows(const Input& input, const char* what, TextPlace begin) {
  return find_rows(input, what, begin, false);
}

std::int64_t first_number(const Input& input, const NodeTable& table) {
  if (table.rows.count == 0) return 0;
  TextPlace place = table.rows.blocks[0];
  const std::size_t line_number = place.line;
  Fields fields(input, take_line(input.content, place), line_number);
  const std::int64_t number = fields.integer();
  if (number != 0 && number != 1) fields.fail("the first number must be 0 or 1");
  return number;
}

PointCloud read_points_of(const Input& input, const NodeTable& table, std::int64_t base) {
  if (table.columns != 2 && table.columns != 3) {
    fail(input, "",
         table.columns > 3 && table.columns <= kMostDimensions
             ? "points of dimension 2 or 3 are expected; `triangulate --dim " +
                   std::to_string(table.columns) + "` takes these"
             : "points of dimension 2 or 3 are expected");
  }
  PointCloud cloud;
  cloud.has_z = table.columns == 3 || table.attributes > 0;
  input.require_points(table.rows.count);
  cloud.positions.resize(table.rows.count);
  for_each_row(input, table.rows, is_data_row, [&](std::size_t i, Fields& fields) {
    if (fields.integer() != static_cast<std::int64_t>(i) + base) {
      fields.fail("points are not numbered one after the other");
    }
    for (int k = 0; k < (cloud.has_z ? 3 : 2); ++k) cloud.positions[i][k] = fields.number();
  });
  return cloud;
}

namespace {

// The corners of elements, rows of `points` points whose numbers begin with `base`.
std::vector<std::uint32_t> read_elements(const Input& elements, const NodeTable& table,
                                         std::int64_t base, std::size_t points) {
  const auto corners = static_cast<std::size_t>(table.columns);
  std::vector<std::uint32_t> vertices;
  elements.require_memory(table.rows.count * corners * sizeof vertices[0]);
  vertices.resize(table.rows.count * corners);
  for_each_row(elements, table.rows, is_data_row, [&](std::size_t i, Fields& fields) {
    fields.integer();
    for (std::size_t k = 0; k < corners; ++k) {
      const std::uint64_t vertex = number_from(base, fields);
      if (vertex >= points) {
        fields.fail("refers to a point that is not there");
      }
      vertices[i * corners + k] = static_cast<std::uint32_t>(vertex);
    }
  });
  return vertices;
}

PointTable read_table_of(const Input& input, const NodeTable& table, std::int64_t base) {
  if (table.columns < 2 || table.columns > kMostDimensions) {
    fail(input, "",
         "points of dimension 2 to " + std::to_string(kMostDimensions) + " are expected, not " +
             std::to_string(table.columns));
  }
  PointTable points;
  points.dim = static_cast<int>(table.columns);
  const auto dim = static_cast<std::size_t>(points.dim);
  input.require_memory(table.rows.count * dim * sizeof(double));
  points.coordinates.resize(table.rows.count * dim);
  for_each_row(input, table.rows, is_data_row, [&](std::size_t i, Fields& fields) {
    if (fields.integer() != static_cast<std::int64_t>(i) + base) {
      fields.fail("points are not numbered one after the other");
    }
    for (std::size_t k = 0; k < dim; ++k) points.coordinates[i * dim + k] = fields.number();
  });
  return points;
}

}  // namespace

PointTable read_point_table(const Input& input) {
  const NodeTable table = find_node_table(input, "points");
  return read_table_of(input, table, first_number(input, table));
}

TableMesh read_table_mesh(const Input& input, const Input& elements) {
  const NodeTable table = find_node_table(input, "points");
  const std::int64_t base = first_number(input, table);
  TableMesh mesh;
  mesh.points = read_table_of(input, table, base);
  const NodeTable simplices = find_node_table(elements, "elements");
  if (simplices.columns != table.columns + 1) {
    fail(elements, "",
         "elements of " + std::to_string(table.columns + 1) + " corners are expected, not " +
             std::to_string(simplices.columns));
  }
  mesh.triangulation.dim = mesh.points.dim;
  mesh.triangulation.vertices = read_elements(elements, simplices, base, mesh.points.size());
  return mesh;
}

PointCloud read_node_points(const Input& input) {
  const NodeTable table = find_node_table(input, "points");
  return read_points_of(input, table, first_number(input, table));
}

PointMesh read_node_mesh(const Input& input, const Input& elements) {
  const NodeTable points = find_node_table(input, "points");
  const std::int64_t base = first_number(input, points);
  PointMesh mesh;
  mesh.points = read_points_of(input, points, base);
  const NodeTable table = find_node_table(elements, "elements");
  if (table.columns != 3 && table.columns != 4) {
    fail(elements, "", "elements of 3 or 4 corners are expected");
  }
  mesh.triangulation.dim = static_cast<int>(table.columns) - 1;
  mesh.triangulation.vertices = read_elements(elements, table, base, mesh.points.size());
  return mesh;
}

}  // namespace delray::delaunay
