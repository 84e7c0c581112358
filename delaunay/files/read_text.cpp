// XYZ, CSV, TXT: rows of numbers. Before them there may be
// - one line of column names: x, y, z (also easting, lon, height, ele ...), red, green, blue,
//   intensity, classification, in any order; other columns are skipped and told, as are names of
//   which none is known;
// - one line with the number of points;
// - one line "points edges", followed by the points and then by pairs of vertex numbers (an
//   outline, of which the points are read).
// Without names the columns are x, y and, if there are three or more, z; of exactly six columns the
// last three are a colour if they are whole numbers from 0 to 255 throughout.
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <optional>
#include <string>

#include "delaunay/files/point_readers.h"
#include "delaunay/files/quantity.h"
#include "delaunay/files/text_rows.h"

namespace delray::delaunay {
namespace {

// columns[i] is the quantity in column i of the file.
struct Layout {
  std::vector<Quantity> columns;
  bool is_plane = false;    // unnamed columns, two in the first row
  bool geographic = false;  // columns are named longitude and latitude
  std::string warning;      // of columns that are left out, or guessed
  std::size_t edges = 0;    // of an outline, which are not read
  Separator separator = Separator::comma;
  TextPlace begin;               // of the first row of coordinates
  std::size_t limit = kAllRows;  // rows of coordinates
};

struct ColumnName {
  std::string_view name;
  Quantity quantity;
  bool degrees = false;
};
// The first of these names wins where a file has several columns for one quantity.
constexpr std::array kColumnNames = {
    ColumnName{"x", kX},
    ColumnName{"easting", kX},
    ColumnName{"x_coord", kX},
    ColumnName{"point_x", kX},
    ColumnName{"lon", kX, true},
    ColumnName{"lng", kX, true},
    ColumnName{"long", kX, true},
    ColumnName{"longitude", kX, true},
    ColumnName{"east", kX},
    ColumnName{"e", kX},
    ColumnName{"y", kY},
    ColumnName{"northing", kY},
    ColumnName{"y_coord", kY},
    ColumnName{"point_y", kY},
    ColumnName{"lat", kY, true},
    ColumnName{"latitude", kY, true},
    ColumnName{"north", kY},
    ColumnName{"n", kY},
    ColumnName{"z", kZ},
    ColumnName{"z_coord", kZ},
    ColumnName{"point_z", kZ},
    ColumnName{"height", kZ},
    ColumnName{"elevation", kZ},
    ColumnName{"altitude", kZ},
    ColumnName{"elev", kZ},
    ColumnName{"ele", kZ},
    ColumnName{"alt", kZ},
    ColumnName{"h", kZ},
    ColumnName{"dem", kZ},
    ColumnName{"value", kZ},
    ColumnName{"red", kRed},
    ColumnName{"r", kRed},
    ColumnName{"green", kGreen},
    ColumnName{"g", kGreen},
    ColumnName{"blue", kBlue},
    ColumnName{"b", kBlue},
    ColumnName{"intensity", kIntensity},
    ColumnName{"classification", kClass},
    ColumnName{"class", kClass},
};

// The index in kColumnNames; its size for other names.
std::size_t column_of(std::string_view field) {
  std::string name;
  for (const char c : field) {
    if (c != '"' && c != '\'')
      name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return static_cast<std::size_t>(std::ranges::find(kColumnNames, name, &ColumnName::name) -
                                  kColumnNames.begin());
}

// Names for a message: short, printable, with commas between them.
std::string listed(const std::vector<std::string_view>& names) {
  constexpr std::size_t kMost = 12, kLongest = 40;
  std::string list;
  for (std::size_t i = 0; i < names.size() && i < kMost; ++i) {
    list += i > 0 ? ", " : "";
    for (const char c : names[i].substr(0, kLongest)) list += c >= ' ' && c <= '~' ? c : '?';
  }
  return list + (names.size() > kMost ? " ..." : "");
}

std::vector<std::string_view> split(const Input& input, std::string_view line,
                                    Separator separator) {
  std::vector<std::string_view> result;
  Fields fields(input, line, 0, separator);
  for (std::string_view field; fields.next(field);) result.push_back(field);
  return result;
}

// Names may contain blanks where commas or semicolons separate them.
std::vector<std::string_view> split_names(const Input& input, std::string_view line) {
  constexpr std::string_view kSeparators = ",;", kBlanks = " \t\r";
  if (line.find_first_of(kSeparators) == std::string_view::npos) {
    return split(input, line, Separator::comma);
  }
  std::vector<std::string_view> result;
  while (true) {
    const std::size_t end = line.find_first_of(kSeparators);
    std::string_view name = line.substr(0, end);
    name.remove_prefix(std::min(name.find_first_not_of(kBlanks), name.size()));
    result.push_back(name.substr(0, name.find_last_not_of(kBlanks) + 1));
    if (end == std::string_view::npos) return result;
    line.remove_prefix(end + 1);
  }
}

// With semicolons between the fields a comma is part of a number, and then an error: better than
// two numbers made of one.
Separator separator_of(std::string_view line) {
  return line.find(';') == std::string_view::npos ? Separator::comma : Separator::semicolon;
}

bool is_colour_value(std::string_view field) {
  std::int64_t value = 0;
  return parse_integer(field, value) && value >= 0 && value <= 255;
}

std::vector<Quantity> unnamed_columns(const std::vector<std::string_view>& first_row) {
  const std::size_t n = first_row.size();
  if (n == 2) return {kX, kY};
  if (n == 6 && std::all_of(first_row.begin() + 3, first_row.end(), is_colour_value)) {
    return {kX, kY, kZ, kRed, kGreen, kBlue};
  }
  return {kX, kY, kZ};
}

// No columns if no name of a coordinate is known: a title, or another language.
Layout named_columns(const Input& input, std::size_t line_number,
                     const std::vector<std::string_view>& names) {
  constexpr std::size_t kNone = kColumnNames.size();
  std::array<std::size_t, kQuantities> taken;
  taken.fill(kNone);
  for (const std::string_view name : names) {
    const std::size_t number = column_of(name);
    if (number == kNone) continue;
    std::size_t& best = taken[kColumnNames[number].quantity];
    best = std::min(best, number);
  }
  Layout layout;
  if (taken[kX] == kNone && taken[kY] == kNone && taken[kZ] == kNone) {
    layout.warning = at_line(line_number) + " names no column that is known (" + listed(names) +
                     "): took the first columns for x, y and z";
    return layout;
  }
  if (taken[kX] == kNone || taken[kY] == kNone) {
    fail(input, at_line(line_number), "the column names have no x or no y: " + listed(names));
  }
  std::vector<std::string_view> left_out;
  int degrees = 0;
  for (const std::string_view name : names) {
    const std::size_t number = column_of(name);
    const bool used = number != kNone && taken[kColumnNames[number].quantity] == number;
    layout.columns.push_back(used ? kColumnNames[number].quantity : kSkipped);
    if (used) taken[kColumnNames[number].quantity] = kNone;  // a name that comes twice counts once
    if (used && kColumnNames[number].degrees) ++degrees;
    if (!used) left_out.push_back(name);
  }
  layout.geographic = degrees == 2;
  if (!left_out.empty()) layout.warning = "columns left out: " + listed(left_out);
  return layout;
}

// Whether a first field is no number, not even a broken one.
bool is_name(std::string_view field) {
  double value = 0;
  return (field.empty() || std::string_view("0123456789+-.").find(field[0]) == field.npos) &&
         parse_number(field, value) == NumberError::not_a_number;
}

struct Counts {
  std::size_t points = 0, edges = 0;
  bool single = false;  // the line holds the number of points alone
};

std::optional<Counts> counts_of(const std::vector<std::string_view>& fields) {
  std::array<std::int64_t, 2> values{};
  if (fields.empty() || fields.size() > 2) return std::nullopt;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (!parse_integer(fields[i], values[i]) || values[i] < 0) return std::nullopt;
  }
  return Counts{static_cast<std::size_t>(values[0]), static_cast<std::size_t>(values[1]),
                fields.size() == 1};
}

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
bool is_outline(const Input& input, const Counts& counts, TextPlace rest) {
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

Layout find_layout(const Input& input) {
  TextPlace place;
  if (input.content.starts_with("\xef\xbb\xbf")) place.byte = 3;  // UTF-8 byte order mark
  RowIndex first = index_rows(input, place, 1, is_data_row);
  if (first.count == 0) fail(input, "", "no points");
  const std::size_t line_number = first.blocks[0].line;
  TextPlace rest = first.blocks[0];
  const std::string_view line = take_line(input.content, rest);
  const auto fields = split(input, line, separator_of(line));

  Layout layout;
  layout.begin = first.blocks[0];
  const auto counts = counts_of(fields);
  if (!fields.empty() && is_name(fields[0])) {
    layout = named_columns(input, line_number, split_names(input, line));
    layout.begin = rest;
  } else if (counts && (counts->single || is_outline(input, *counts, rest))) {
    const RowIndex points = index_rows(input, rest, counts->points, is_data_row);
    if (points.count < counts->points) {
      fail(input, at_line(line_number),
           "announces " + std::to_string(counts->points) + " points, the file has " +
               std::to_string(points.count));
    }
    layout.begin = rest;
    layout.limit = counts->points;
    layout.edges = counts->edges;
  }
  first = index_rows(input, layout.begin, std::min<std::size_t>(layout.limit, 1), is_data_row);
  if (first.count == 0) fail(input, "", "no points");
  const std::size_t first_number = first.blocks[0].line;
  const std::string_view first_row = take_line(input.content, first.blocks[0]);
  layout.separator = separator_of(first_row);
  const auto first_fields = split(input, first_row, layout.separator);
  if (first_fields.size() < 2) {
    fail(input, at_line(first_number), "a point needs two numbers at least");
  }
  if (layout.columns.empty()) {
    layout.columns = unnamed_columns(first_fields);
    layout.is_plane = first_fields.size() == 2;
  }
  return layout;
}

std::uint8_t to_byte(double value, double scale) {
  return static_cast<std::uint8_t>(std::clamp(std::round(value * scale), 0.0, 255.0));
}

float largest(const std::vector<float>& values) {
  return values.empty() ? 0.0F : *std::ranges::max_element(values);
}

}  // namespace

PointCloud read_text_points(const Input& input) {
  const Layout layout = find_layout(input);
  const RowIndex rows = index_rows(input, layout.begin, layout.limit, is_data_row);
  const auto has = [&](Quantity quantity) {
    return std::ranges::find(layout.columns, quantity) != layout.columns.end();
  };
  const bool has_colour = has(kRed) && has(kGreen) && has(kBlue);
  const bool has_intensity = has(kIntensity), has_class = has(kClass);
  PointCloud cloud;
  cloud.has_z = has(kZ);
  cloud.geographic = layout.geographic;
  if (layout.edges > 0) cloud.warnings.push_back(edges_left_out(layout.edges));
  if (!layout.warning.empty()) cloud.warnings.push_back(layout.warning);
  input.require_points(rows.count);
  cloud.positions.resize(rows.count);
  if (has_colour) cloud.colours.resize(rows.count);
  if (has_intensity) cloud.intensity.resize(rows.count);
  if (has_class) cloud.classification.resize(rows.count);
  std::size_t columns = layout.columns.size();
  while (columns > 0 && layout.columns[columns - 1] == kSkipped) --columns;

  std::atomic<bool> whole_colours{true};
  for_each_row(
      input, rows, is_data_row,
      [&](std::size_t i, Fields& fields) {
        std::array<double, kQuantities> values{};
        for (std::size_t column = 0; column < columns; ++column) {
          const Quantity quantity = layout.columns[column];
          std::string_view skipped;
          if (quantity != kSkipped) {
            values[quantity] = fields.number();
          } else if (!fields.next(skipped)) {
            fields.fail("the line ends too early");
          }
        }
        std::string_view rest;
        if (layout.is_plane && fields.next(rest)) {
          fields.fail("has more than the two numbers of the first row");
        }
        cloud.positions[i] = {values[kX], values[kY], values[kZ]};
        if (has_colour) {
          cloud.colours[i] = {to_byte(values[kRed], 1), to_byte(values[kGreen], 1),
                              to_byte(values[kBlue], 1), 255};
          const bool exact = values[kRed] == cloud.colours[i].r &&
                             values[kGreen] == cloud.colours[i].g &&
                             values[kBlue] == cloud.colours[i].b;
          if (!exact) whole_colours.store(false, std::memory_order_relaxed);
        }
        if (has_intensity) cloud.intensity[i] = static_cast<float>(values[kIntensity]);
        if (has_class) cloud.classification[i] = to_byte(values[kClass], 1);
      },
      layout.separator);
  if (!whole_colours) cloud.colours.clear();  // normals, or something else
  if (const float top = largest(cloud.intensity); top > 1) {
    for (float& value : cloud.intensity) value = std::clamp(value / top, 0.0F, 1.0F);
  }
  return cloud;
}

}  // namespace delray::delaunay
