// Finds the columns of a text by the names in its first line, or by how many its first row has.
#include "delaunay/files/text_layout.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

namespace delray::delaunay {
namespace {

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
TextLayout named_columns(const Input& input, std::size_t line_number,
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
  TextLayout layout;
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

std::optional<TextCounts> counts_of(const std::vector<std::string_view>& fields) {
  std::array<std::int64_t, 2> values{};
  if (fields.empty() || fields.size() > 2) return std::nullopt;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (!parse_integer(fields[i], values[i]) || values[i] < 0) return std::nullopt;
  }
  return TextCounts{static_cast<std::size_t>(values[0]), static_cast<std::size_t>(values[1]),
                    fields.size() == 1};
}

struct FirstRow {
  TextPlace begin, rest;  // where it and what follows it begin
  std::string_view line;
  std::vector<std::string_view> fields;
};

FirstRow first_row(const Input& start) {
  TextPlace place;
  if (start.content.starts_with("\xef\xbb\xbf")) place.byte = 3;  // UTF-8 byte order mark
  const RowIndex first = index_rows(start, place, 1, is_data_row);
  if (first.count == 0) fail(start, "", "no points");
  FirstRow row;
  row.begin = row.rest = first.blocks[0];
  row.line = take_line(start.content, row.rest);
  row.fields = split(start, row.line, separator_of(row.line));
  return row;
}

std::uint8_t to_byte(double value) {
  return static_cast<std::uint8_t>(std::clamp(std::round(value), 0.0, 255.0));
}

}  // namespace

std::optional<TextCounts> announced_counts(const Input& start) {
  return counts_of(first_row(start).fields);
}

TextLayout text_layout(const Input& start, bool with_counts) {
  const FirstRow row = first_row(start);
  TextLayout layout;
  layout.begin = row.begin;
  if (!row.fields.empty() && is_name(row.fields[0])) {
    layout = named_columns(start, row.begin.line, split_names(start, row.line));
    layout.begin = row.rest;
  } else if (with_counts) {
    layout.begin = row.rest;
  }
  const RowIndex first = index_rows(start, layout.begin, 1, is_data_row);
  if (first.count == 0) fail(start, "", "no points");
  TextPlace place = first.blocks[0];
  const std::size_t first_number = place.line;
  const std::string_view first_line = take_line(start.content, place);
  layout.separator = separator_of(first_line);
  const auto first_fields = split(start, first_line, layout.separator);
  if (first_fields.size() < 2) {
    fail(start, at_line(first_number), "a point needs two numbers at least");
  }
  if (layout.columns.empty()) {
    layout.columns = unnamed_columns(first_fields);
    layout.is_plane = first_fields.size() == 2;
  }
  return layout;
}

bool begins_as_points(const Input& start) {
  for (const bool with_counts : {false, true}) {
    try {
      if (with_counts && !announced_counts(start)) continue;
      const TextLayout layout = text_layout(start, with_counts);
      const RowIndex first = index_rows(start, layout.begin, 1, is_data_row);
      TextPlace place = first.blocks.at(0);
      const std::size_t line = place.line;
      Fields fields(start, take_line(start.content, place), line, layout.separator);
      const TextRowParser parser(layout);
      PointCloud cloud;
      parser.resize(cloud, 1);
      parser.parse(fields, 0, cloud);
      return true;
    } catch (const files::FileError&) {
      continue;
    }
  }
  return false;
}

TextRowParser::TextRowParser(const TextLayout& layout)
    : columns_(layout.columns), is_plane_(layout.is_plane) {
  while (!columns_.empty() && columns_.back() == kSkipped) columns_.pop_back();
  has_z_ = has(kZ);
  has_colour_ = has(kRed) && has(kGreen) && has(kBlue);
  has_intensity_ = has(kIntensity);
  has_class_ = has(kClass);
}

bool TextRowParser::has(Quantity quantity) const {
  return std::ranges::find(columns_, quantity) != columns_.end();
}

void TextRowParser::resize(PointCloud& cloud, std::size_t rows) const {
  cloud.has_z = has_z_;
  cloud.positions.resize(rows);
  if (has_colour_) cloud.colours.resize(rows);
  if (has_intensity_) cloud.intensity.resize(rows);
  if (has_class_) cloud.classification.resize(rows);
}

bool TextRowParser::parse(Fields& fields, std::size_t row, PointCloud& cloud) const {
  std::array<double, kQuantities> values{};
  for (const Quantity quantity : columns_) {
    std::string_view skipped;
    if (quantity != kSkipped) {
      values[quantity] = fields.number();
    } else if (!fields.next(skipped)) {
      fields.fail("the line ends too early");
    }
  }
  std::string_view rest;
  if (is_plane_ && fields.next(rest)) fields.fail("has more than the two numbers of the first row");
  cloud.positions[row] = {values[kX], values[kY], values[kZ]};
  bool whole = true;
  if (has_colour_) {
    const glm::u8vec4 colour(to_byte(values[kRed]), to_byte(values[kGreen]), to_byte(values[kBlue]),
                             255);
    cloud.colours[row] = colour;
    whole = values[kRed] == colour.r && values[kGreen] == colour.g && values[kBlue] == colour.b;
  }
  if (has_intensity_) cloud.intensity[row] = static_cast<float>(values[kIntensity]);
  if (has_class_) cloud.classification[row] = to_byte(values[kClass]);
  return whole;
}

}  // namespace delray::delaunay
