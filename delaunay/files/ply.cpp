// Parses PLY headers (Turk 1994) line by line, decodes values of either byte order, and skips
// elements whose rows may hold lists. Counts in the header are compared with the size of the file
// before anybody allocates by them.
#include "delaunay/files/ply.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace delray::delaunay {
namespace {

struct TypeName {
  std::string_view name;
  PlyType type;
};
constexpr std::array kTypeNames = {
    TypeName{"char", PlyType::int8},      TypeName{"int8", PlyType::int8},
    TypeName{"uchar", PlyType::uint8},    TypeName{"uint8", PlyType::uint8},
    TypeName{"short", PlyType::int16},    TypeName{"int16", PlyType::int16},
    TypeName{"ushort", PlyType::uint16},  TypeName{"uint16", PlyType::uint16},
    TypeName{"int", PlyType::int32},      TypeName{"int32", PlyType::int32},
    TypeName{"uint", PlyType::uint32},    TypeName{"uint32", PlyType::uint32},
    TypeName{"float", PlyType::float32},  TypeName{"float32", PlyType::float32},
    TypeName{"double", PlyType::float64}, TypeName{"float64", PlyType::float64},
};

std::string_view word(Fields& fields) {
  std::string_view field;
  if (!fields.next(field)) fields.fail("the line ends too early");
  return field;
}

PlyType type_named(std::string_view name, const Fields& fields) {
  const auto found = std::ranges::find(kTypeNames, name, &TypeName::name);
  if (found == kTypeNames.end()) fields.fail("unknown type " + std::string(name.substr(0, 40)));
  return found->type;
}

PlyType list_count_type(Fields& fields) {
  const PlyType type = type_named(word(fields), fields);
  if (type == PlyType::float32 || type == PlyType::float64) {
    fields.fail("the length of a list must be an integer");
  }
  return type;
}

void parse_format(Fields& fields, PlyHeader& header) {
  const std::string_view encoding = word(fields);
  if (encoding == "ascii") {
    header.encoding = PlyEncoding::ascii;
  } else if (encoding == "binary_little_endian") {
    header.encoding = PlyEncoding::little_endian;
  } else if (encoding == "binary_big_endian") {
    header.encoding = PlyEncoding::big_endian;
  } else {
    fields.fail("unknown PLY encoding");
  }
}

void parse_element(Fields& fields, PlyHeader& header) {
  PlyElement element;
  element.name = word(fields);
  const std::int64_t count = fields.integer();
  if (count < 0) fields.fail("a negative number of elements");
  element.count = static_cast<std::size_t>(count);
  header.elements.push_back(std::move(element));
}

void parse_property(Fields& fields, PlyHeader& header) {
  if (header.elements.empty()) fields.fail("a property of no element");
  PlyProperty property;
  const std::string_view type = word(fields);
  if (type == "list") {
    property.count_type = list_count_type(fields);
    property.type = type_named(word(fields), fields);
  } else {
    property.type = type_named(type, fields);
  }
  property.name = word(fields);
  header.elements.back().properties.push_back(std::move(property));
}

template <class T>
double load(const char* data, PlyEncoding encoding) {
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), data, sizeof(T));
  const bool little = std::endian::native == std::endian::little;
  if ((encoding == PlyEncoding::little_endian) != little) std::ranges::reverse(bytes);
  return static_cast<double>(std::bit_cast<T>(bytes));
}

void check_fits(const Input& input, const PlyElement& element, std::size_t byte) {
  const std::size_t row = element.smallest_row();
  if (row > 0 && element.count > (input.content.size() - byte) / row) {
    fail(input, at_byte(byte),
         "the header announces " + std::to_string(element.count) + " of \"" + element.name +
             "\", more than the file holds");
  }
}

std::size_t skip_rows(const Input& input, const PlyHeader& header, const PlyElement& element,
                      std::size_t byte) {
  check_fits(input, element, byte);
  if (!element.has_lists()) return byte + element.count * element.smallest_row();
  std::vector<PlyValues> values(element.properties.size());
  for (std::size_t i = 0; i < element.count; ++i) {
    byte = read_ply_row(input, header.encoding, element, byte, values);
  }
  return byte;
}

TextPlace skip_lines(const Input& input, const PlyElement& element, TextPlace place) {
  const RowIndex rows = index_rows(input, place, element.count, is_data_row);
  if (rows.count < element.count) {
    fail(input, at_line(rows.end.line),
         "the header announces " + std::to_string(element.count) + " of \"" + element.name +
             "\", the file has " + std::to_string(rows.count));
  }
  return rows.end;
}

}  // namespace

bool PlyElement::has_lists() const {
  return std::ranges::any_of(properties, [](const auto& p) { return p.count_type.has_value(); });
}

std::size_t PlyElement::smallest_row() const {
  std::size_t size = 0;
  for (const PlyProperty& property : properties) {
    size += ply_size(property.count_type.value_or(property.type));
  }
  return size;
}

std::size_t ply_size(PlyType type) {
  constexpr std::array<std::size_t, 8> kSizes = {1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

double ply_value(const char* data, PlyType type, PlyEncoding encoding) {
  switch (type) {
    case PlyType::int8:
      return load<std::int8_t>(data, encoding);
    case PlyType::uint8:
      return load<std::uint8_t>(data, encoding);
    case PlyType::int16:
      return load<std::int16_t>(data, encoding);
    case PlyType::uint16:
      return load<std::uint16_t>(data, encoding);
    case PlyType::int32:
      return load<std::int32_t>(data, encoding);
    case PlyType::uint32:
      return load<std::uint32_t>(data, encoding);
    case PlyType::float32:
      return load<float>(data, encoding);
    case PlyType::float64:
      return load<double>(data, encoding);
  }
  return 0;
}

PlyHeader parse_ply_header(const Input& input) {
  PlyHeader header;
  TextPlace place;
  std::string_view line = take_line(input.content, place);
  if (line.substr(0, line.find_last_not_of(" \t\r") + 1) != "ply")
    fail(input, at_line(1), "does not begin with \"ply\"");
  bool has_format = false;
  while (place.byte < input.content.size()) {
    const std::size_t number = place.line;
    line = take_line(input.content, place);
    Fields fields(input, line, number);
    std::string_view keyword;
    if (!fields.next(keyword) || keyword == "comment" || keyword == "obj_info") continue;
    if (keyword == "format") {
      parse_format(fields, header);
      has_format = true;
    } else if (keyword == "element") {
      parse_element(fields, header);
    } else if (keyword == "property") {
      parse_property(fields, header);
    } else if (keyword == "end_header") {
      if (!has_format) fields.fail("the header has no format");
      header.body = place;
      return header;
    } else {
      fields.fail("not a line of a PLY header");
    }
  }
  fail(input, at_line(place.line), "the header has no end");
}

std::size_t read_ply_row(const Input& input, PlyEncoding encoding, const PlyElement& element,
                         std::size_t byte, std::vector<PlyValues>& values) {
  for (std::size_t j = 0; j < element.properties.size(); ++j) {
    const PlyProperty& property = element.properties[j];
    std::size_t count = 1;
    if (property.count_type) {
      const std::size_t size = ply_size(*property.count_type);
      if (input.content.size() - byte < size) fail(input, at_byte(byte), "the file ends too early");
      const double length = ply_value(input.content.data() + byte, *property.count_type, encoding);
      if (length < 0) fail(input, at_byte(byte), "a list of negative length");
      count = static_cast<std::size_t>(length);
      byte += size;
    }
    const std::size_t size = ply_size(property.type);
    if (count > (input.content.size() - byte) / size) {
      fail(input, at_byte(byte), "the file ends too early");
    }
    values[j] = {input.content.data() + byte, count};
    byte += count * size;
  }
  return byte;
}

TextPlace ply_element_start(const Input& input, const PlyHeader& header, std::size_t wanted) {
  const bool ascii = header.encoding == PlyEncoding::ascii;
  TextPlace place = header.body;
  for (std::size_t i = 0; i < wanted; ++i) {
    if (ascii) {
      place = skip_lines(input, header.elements[i], place);
    } else {
      place.byte = skip_rows(input, header, header.elements[i], place.byte);
    }
  }
  if (ascii) {
    skip_lines(input, header.elements[wanted], place);
  } else {
    check_fits(input, header.elements[wanted], place.byte);
  }
  return place;
}

}  // namespace delray::delaunay
