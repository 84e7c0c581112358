// The header of PCD files, one keyword a line (Rusu and Cousins, 3D is here: Point Cloud Library,
// 2011; the format is described at pointclouds.org).
#include "delaunay/files/parts/pcd_header.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string>
#include <string_view>

namespace delray::delaunay {
namespace {

struct FieldName {
  std::string_view name;
  Quantity quantity;
  bool packed_colour = false;
};
constexpr std::array kFieldNames = {
    FieldName{"x", kX},
    FieldName{"y", kY},
    FieldName{"z", kZ},
    FieldName{"rgb", kRed, true},
    FieldName{"rgba", kRed, true},
    FieldName{"intensity", kIntensity},
    FieldName{"intensities", kIntensity},
    FieldName{"i", kIntensity},
    FieldName{"classification", kClass},
    FieldName{"class", kClass},
};

constexpr std::size_t kMostFields = 1024;

// The rest of a line, a value for each field.
template <class Set>
void for_each_value(Fields& line, std::vector<PcdField>& fields, const Set& set) {
  for (PcdField& field : fields) {
    std::string_view word;
    if (!line.next(word)) line.fail("has fewer values than there are fields");
    set(field, word);
  }
}

std::size_t positive(Fields& line, std::string_view word, std::int64_t most) {
  std::int64_t value = 0;
  if (!parse_integer(word, value) || value < 1 || value > most) {
    line.fail("not a number from 1 to " + std::to_string(most));
  }
  return static_cast<std::size_t>(value);
}

void parse_fields(Fields& line, std::vector<PcdField>& fields) {
  std::string_view word;
  while (line.next(word)) {
    if (fields.size() == kMostFields) line.fail("too many fields");
    PcdField field;
    const auto known = std::ranges::find(kFieldNames, word, &FieldName::name);
    if (known != kFieldNames.end() &&
        std::ranges::find(fields, known->quantity, &PcdField::quantity) == fields.end()) {
      field.quantity = known->quantity;
      field.packed_colour = known->packed_colour;
    }
    fields.push_back(field);
  }
}

bool is_known_type(const PcdField& field) {
  if (field.type == 'F') return field.size == 4 || field.size == 8;
  const bool integer = field.type == 'I' || field.type == 'U';
  return integer && std::has_single_bit(field.size) && field.size <= 8;
}

void parse_encoding(Fields& line, PcdHeader& header) {
  std::string_view word;
  line.next(word);
  if (word == "ascii") {
    header.encoding = PcdEncoding::ascii;
  } else if (word == "binary") {
    header.encoding = PcdEncoding::binary;
  } else if (word == "binary_compressed") {
    header.encoding = PcdEncoding::compressed;
  } else {
    line.fail("DATA is neither ascii nor binary nor binary_compressed");
  }
}

// Fills in where fields lie, and skips those that cannot be what their names say.
void lay_out(const Input& input, PcdHeader& header) {
  for (PcdField& field : header.fields) {
    if (!is_known_type(field)) {
      fail(input, "the header",
           std::string("a field of type ") +
               (field.type >= ' ' && field.type <= '~' ? field.type : '?') + " and of " +
               std::to_string(field.size) + " bytes is not known");
    }
    const bool wrong_colour = field.packed_colour && field.size != 4;
    if (field.count != 1 || wrong_colour) field.quantity = kSkipped;
    field.offset = header.record_size;
    header.record_size += field.size * field.count;
  }
  if (!header.has(kX) || !header.has(kY)) fail(input, "the header", "the fields have no x or no y");
}

template <class T>
double load_number(const char* data) {
  T value;
  std::memcpy(&value, data, sizeof value);
  return static_cast<double>(value);
}

}  // namespace

bool PcdHeader::has(Quantity quantity) const {
  return std::ranges::find(fields, quantity, &PcdField::quantity) != fields.end();
}

PcdHeader parse_pcd_header(const Input& start) {
  constexpr std::int64_t kMostBytes = 8, kMostCount = 1 << 16, kMostPoints = std::int64_t{1} << 48;
  PcdHeader header;
  std::uint64_t width = 0, height = 1;
  TextPlace place;
  while (place.byte < start.content.size()) {
    const std::size_t number = place.line;
    Fields line(start, take_line(start.content, place), number);
    std::string_view keyword;
    if (!line.next(keyword)) continue;
    if (keyword == "FIELDS" || keyword == "COLUMNS") {
      header.fields.clear();
      parse_fields(line, header.fields);
    } else if (keyword == "SIZE") {
      for_each_value(line, header.fields, [&](PcdField& field, std::string_view value) {
        field.size = positive(line, value, kMostBytes);
      });
    } else if (keyword == "TYPE") {
      for_each_value(line, header.fields,
                     [](PcdField& field, std::string_view value) { field.type = value[0]; });
    } else if (keyword == "COUNT") {
      for_each_value(line, header.fields, [&](PcdField& field, std::string_view value) {
        field.count = positive(line, value, kMostCount);
      });
    } else if (keyword == "WIDTH" || keyword == "HEIGHT" || keyword == "POINTS") {
      const std::int64_t value = line.integer();
      if (value < 0 || value > kMostPoints) line.fail("a number of points that cannot be");
      std::uint64_t& told = keyword == "WIDTH"    ? width
                            : keyword == "HEIGHT" ? height
                                                  : header.points;
      told = static_cast<std::uint64_t>(value);
    } else if (keyword == "DATA") {
      parse_encoding(line, header);
      header.body = place;
      if (header.points == 0 && height > 0 && width <= kMostPoints / height) {
        header.points = width * height;
      }
      lay_out(start, header);
      return header;
    } else if (keyword != "VERSION" && keyword != "VIEWPOINT") {
      line.fail("not a line of a PCD header");
    }
  }
  fail(start, at_line(place.line), "the header has no DATA");
}

double pcd_number(const PcdField& field, const char* data) {
  if (field.type == 'F')
    return field.size == 8 ? load_number<double>(data) : load_number<float>(data);
  const bool negative = field.type == 'I';
  switch (field.size) {
    case 1:
      return negative ? load_number<std::int8_t>(data) : load_number<std::uint8_t>(data);
    case 2:
      return negative ? load_number<std::int16_t>(data) : load_number<std::uint16_t>(data);
    case 4:
      return negative ? load_number<std::int32_t>(data) : load_number<std::uint32_t>(data);
    default:
      return negative ? load_number<std::int64_t>(data) : load_number<std::uint64_t>(data);
  }
}

}  // namespace delray::delaunay
