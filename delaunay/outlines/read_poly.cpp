// .poly, the outlines of Triangle (Shewchuk 1996): points as in .node, then "segments markers" with
// rows "number point point marker", then "holes" with rows "number x y", then regional attributes,
// which are left out. No points mean that they are in the .node file beside it.
#include <limits>
#include <string>

#include "delaunay/files/line_ends.h"
#include "delaunay/files/point_readers.h"
#include "delaunay/outline.h"
#include "files/read_file.h"

namespace delray::delaunay {
namespace {

// Whether anything stands behind a place.
bool has_more(const Input& input, TextPlace place) {
  return index_rows(input, place, 1, is_data_row).count > 0;
}

TextPlace end_of(const NodeTable& table, TextPlace begin, const Input& input) {
  if (table.rows.count > 0) return table.rows.end;
  return index_rows(input, begin, 1, is_data_row).end;
}

std::vector<std::array<std::uint32_t, 2>> read_segments(const Input& input, const NodeTable& table,
                                                        std::int64_t base, std::size_t points) {
  std::vector<std::array<std::uint32_t, 2>> segments;
  input.require_memory(table.rows.count * sizeof segments[0]);
  segments.resize(table.rows.count);
  for_each_row(input, table.rows, is_data_row, [&](std::size_t i, Fields& fields) {
    fields.integer();
    for (std::uint32_t& end : segments[i]) {
      const std::uint64_t row = number_from(base, fields);
      if (row >= points) {
        fields.fail("refers to a point that is not there");
      }
      end = static_cast<std::uint32_t>(row);
    }
  });
  return segments;
}

std::vector<glm::dvec2> read_holes(const Input& input, const NodeTable& table) {
  std::vector<glm::dvec2> holes;
  input.require_memory(table.rows.count * sizeof holes[0]);
  holes.resize(table.rows.count);
  for_each_row(input, table.rows, is_data_row, [&](std::size_t i, Fields& fields) {
    fields.integer();
    holes[i].x = fields.number();
    holes[i].y = fields.number();
  });
  return holes;
}

// The content of a file that an Input refers to.
std::string content_of(const std::filesystem::path& path, const files::MemoryBudget& memory) {
  return with_line_feeds(files::Format::poly, files::read_file(path, memory));
}

}  // namespace

PointCloud read_poly_points(const Input& input) {
  const NodeTable table = find_node_table(input, "points");
  if (table.rows.count == 0) {
    fail(input, "", "its points are in the .node file beside it: name that");
  }
  PointCloud points = read_points_of(input, table, first_number(input, table));
  const TextPlace behind = end_of(table, {}, input);
  if (!has_more(input, behind)) return points;
  if (const std::size_t count = find_counted_rows(input, "segments", behind).rows.count;
      count > 0) {
    points.warnings.push_back(std::to_string(count) +
                              " segments left out: triangulate --min-angle 0 keeps them");
  }
  return points;
}

Outline read_outline(const Input& input, const Input* nodes) {
  const NodeTable own = find_node_table(input, "points");
  if (own.columns != 2) fail(input, "", "an outline has points of dimension 2");
  const bool is_elsewhere = own.rows.count == 0 && nodes != nullptr;
  const Input& of_points = is_elsewhere ? *nodes : input;
  const NodeTable points = is_elsewhere ? find_node_table(*nodes, "points") : own;
  if (points.columns != 2) fail(of_points, "", "an outline has points of dimension 2");
  const std::int64_t base = first_number(of_points, points);
  Outline outline;
  outline.points = read_points_of(of_points, points, base);
  const TextPlace behind_points = end_of(own, {}, input);
  const NodeTable segments = find_counted_rows(input, "segments", behind_points);
  outline.segments = read_segments(input, segments, base, outline.points.size());
  const TextPlace behind_segments = end_of(segments, behind_points, input);
  if (has_more(input, behind_segments)) {
    outline.holes = read_holes(input, find_counted_rows(input, "holes", behind_segments));
  }
  return outline;
}

Outline read_outline(const std::filesystem::path& path, const files::MemoryBudget& memory) {
  const std::string content = content_of(path, memory);
  const Input input{path == "-" ? "standard input" : path.string(), content, memory};
  if (content.empty()) fail(input, "", "the file is empty");
  const bool is_elsewhere = path != "-" && find_node_table(input, "points").rows.count == 0;
  Outline outline;
  if (is_elsewhere) {
    const std::filesystem::path beside = std::filesystem::path(path).replace_extension(".node");
    const std::string node_content = content_of(beside, memory);
    const Input nodes{beside.string(), node_content, memory};
    outline = read_outline(input, &nodes);
  } else {
    outline = read_outline(input, nullptr);
  }
  if (outline.points.size() == 0) fail(input, "", "no points");
  return outline;
}

}  // namespace delray::delaunay
