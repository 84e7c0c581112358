// XYZ, CSV, TXT: rows of numbers. Before them there may be
// - one line of column names: x, y, z (also easting, lon, height, ele ...), red, green, blue,
//   intensity, classification, in any order; other columns are skipped and told, as are names of
//   which none is known;
// - one line with the number of points;
// - one line "points edges", followed by the points and then by pairs of vertex numbers (an
//   outline, of which the points are read).
// Without names the columns are x, y and, if there are three or more, z; of exactly six columns the
// last three are a colour if they are whole numbers from 0 to 255 throughout.
#include <atomic>

#include "delaunay/files/parts/file_parts.h"
#include "delaunay/files/point_readers.h"
#include "delaunay/files/text_layout.h"

namespace delray::delaunay {
namespace {

// Whether the last rows of an outline are pairs of numbers of its points, counted from 0 or 1.
bool are_edges(const Input& input, TextPlace begin, std::size_t points) {
  const RowIndex rows = index_rows(input, begin, kAllRows, is_data_row);
  std::atomic<bool> edges{true};
  for_each_row(input, rows, is_data_row, [&](std::size_t, Fields& fields) {
    std::string_view field;
    int count = 0;
    for (; fields.next(field); ++count) {
      std::int64_t vertex = 0;
      const bool known = parse_integer(field, vertex) && vertex >= 0 &&
                         static_cast<std::uint64_t>(vertex) <= points;
      if (!known) edges = false;
    }
    if (count != 2) edges = false;
  });
  return edges;
}

// True if "points edges" in the first line is no point itself: the number of rows must agree, and
// either pairs of vertex numbers close the file or the coordinates, unlike the counts, have
// fractions.
bool is_outline(const Input& input, const TextCounts& counts, TextPlace rest) {
  const RowIndex rows = index_rows(input, rest, kAllRows, is_data_row);
  if (counts.points == 0 || counts.points > rows.count ||
      counts.edges != rows.count - counts.points) {
    return false;
  }
  if (counts.edges > 0) {
    const RowIndex points = index_rows(input, rest, counts.points, is_data_row);
    return are_edges(input, points.end, counts.points);
  }
  TextPlace place = rest;
  std::string_view line;
  while (!is_data_row(line)) line = take_line(input.content, place);
  return line.find('.') != std::string_view::npos;
}

// The rows of coordinates, and the number of edges behind them, which are not read.
struct TextRows {
  TextLayout layout;
  std::size_t limit = kAllRows, edges = 0;
};

TextRows find_rows(const Input& input) {
  const auto counts = announced_counts(input);
  if (!counts) return {text_layout(input, false)};
  TextPlace rest;
  if (input.content.starts_with("\xef\xbb\xbf")) rest.byte = 3;
  const RowIndex first = index_rows(input, rest, 1, is_data_row);
  rest = first.end;
  if (!counts->single && !is_outline(input, *counts, rest)) return {text_layout(input, false)};
  const RowIndex points = index_rows(input, rest, counts->points, is_data_row);
  if (points.count < counts->points) {
    fail(input, at_line(first.blocks[0].line),
         "announces " + std::to_string(counts->points) + " points, the file has " +
             std::to_string(points.count));
  }
  if (counts->points == 0) fail(input, "", "no points");
  return {text_layout(input, true), counts->points, counts->edges};
}

}  // namespace

PointCloud read_text_points(const Input& input) {
  const TextRows text = find_rows(input);
  const RowIndex rows = index_rows(input, text.layout.begin, text.limit, is_data_row);
  input.require_points(rows.count);
  const TextRowParser parser(text.layout);
  PartPoints points;
  parser.resize(points.cloud, rows.count);
  std::atomic<bool> whole_colours{true};
  for_each_row(
      input, rows, is_data_row,
      [&](std::size_t i, Fields& fields) {
        if (!parser.parse(fields, i, points.cloud)) {
          whole_colours.store(false, std::memory_order_relaxed);
        }
      },
      text.layout.separator);
  points.whole_colours = whole_colours;
  AttributeRanges ranges;
  ranges.include(points);
  FileFacts facts;
  facts.geographic = text.layout.geographic;
  finish_points(facts, ranges, points);
  PointCloud& cloud = points.cloud;
  if (text.edges > 0) cloud.warnings.push_back(edges_left_out(text.edges));
  if (!text.layout.warning.empty()) cloud.warnings.push_back(text.layout.warning);
  return std::move(cloud);
}

}  // namespace delray::delaunay
