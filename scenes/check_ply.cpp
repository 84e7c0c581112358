#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>

#include "scenes/internal/check_file.h"
#include "scenes/internal/text_lines.h"

namespace delray::scenes::internal {
namespace {

struct ScalarType {
  const char* name;
  const char* other_name;
  int size;
  bool is_real, is_signed;
};
constexpr std::array kScalarTypes = {
    ScalarType{"char", "int8", 1, false, true},    ScalarType{"uchar", "uint8", 1, false, false},
    ScalarType{"short", "int16", 2, false, true},  ScalarType{"ushort", "uint16", 2, false, false},
    ScalarType{"int", "int32", 4, false, true},    ScalarType{"uint", "uint32", 4, false, false},
    ScalarType{"float", "float32", 4, true, true}, ScalarType{"double", "float64", 8, true, true}};

struct Property {
  std::string_view name;
  const ScalarType* length = nullptr;  // of a list; null for a single value
  const ScalarType* value = nullptr;
};

struct Element {
  std::string_view name;
  std::uint64_t count = 0;
  std::vector<Property> properties;

  bool is_vertex() const { return name == "vertex"; }
  std::uint64_t least_size(bool text) const {
    std::uint64_t size = 0;
    for (const Property& p : properties) {
      size += text ? 2 : static_cast<std::uint64_t>((p.length ? p.length : p.value)->size);
    }
    return size;
  }
};

enum class Coding { text, little, big };

struct Header {
  Coding coding = Coding::text;
  std::vector<Element> elements;
  std::size_t size = 0;  // bytes
  std::uint64_t lines = 0;
  std::uint64_t vertices = 0;
};

const ScalarType* scalar_type(const Source& source, const Lines& lines, std::string_view name) {
  for (const ScalarType& type : kScalarTypes) {
    if (name == type.name || name == type.other_name) return &type;
  }
  source.fail(lines.place(), "there is no type '" + std::string(name.substr(0, 20)) + "'");
}

void read_property(const Source& source, const Lines& lines, Words& words, Header& header) {
  if (header.elements.empty()) source.fail(lines.place(), "a property before the first element");
  Property property;
  std::string_view word = words.next();
  if (word == "list") {
    property.length = scalar_type(source, lines, words.next());
    if (property.length->is_real) source.fail(lines.place(), "the length of a list must be whole");
    word = words.next();
  }
  property.value = scalar_type(source, lines, word);
  property.name = words.next();
  if (property.name.empty()) source.fail(lines.place(), "the property has no name");
  header.elements.back().properties.push_back(property);
}

void read_element(const Source& source, const Lines& lines, Words& words, Header& header) {
  Element element;
  element.name = words.next();
  if (!parse(words.next(), element.count)) {
    source.fail(lines.place(), "the element has no valid count");
  }
  if (element.is_vertex()) header.vertices = element.count;
  header.elements.push_back(std::move(element));
}

Coding read_coding(const Source& source, const Lines& lines, std::string_view word) {
  if (word == "ascii") return Coding::text;
  if (word == "binary_little_endian") return Coding::little;
  if (word == "binary_big_endian") return Coding::big;
  source.fail(lines.place(), "unknown format '" + std::string(word.substr(0, 40)) + "'");
}

Header read_header(const Source& source) {
  Lines lines(source.content);
  std::string_view line;
  if (!lines.next(line) || Words(line).next() != "ply")
    source.fail("line 1", "this is not a PLY file");
  Header header;
  bool has_format = false;
  while (lines.next(line)) {
    Words words(line);
    const std::string_view key = words.next();
    if (key == "format") {
      header.coding = read_coding(source, lines, words.next());
      has_format = true;
    } else if (key == "element") {
      read_element(source, lines, words, header);
    } else if (key == "property") {
      read_property(source, lines, words, header);
    } else if (key == "end_header") {
      if (!has_format) source.fail(lines.place(), "the header has no format");
      // The body starts after this line's end, which is "\n", "\r\n" or "\r".
      std::size_t end = static_cast<std::size_t>(line.data() + line.size() - source.content.data());
      if (end < source.content.size() && source.content[end] == '\r') ++end;
      if (end < source.content.size() && source.content[end] == '\n') ++end;
      header.size = end;
      header.lines = lines.number();
      return header;
    } else if (!key.empty() && key != "comment" && key != "obj_info") {
      source.fail(lines.place(),
                  "unknown word '" + std::string(key.substr(0, 20)) + "' in the header");
    }
  }
  source.fail(lines.place(), "the file ends within its header");
}

void check_counts(const Source& source, const Header& header) {
  const std::uint64_t size = source.content.size() - header.size;
  for (const Element& element : header.elements) {
    const std::uint64_t each =
        std::max<std::uint64_t>(1, element.least_size(header.coding == Coding::text));
    // The last text value needs no separator.
    if (element.count > (size + 1) / each) {
      source.fail("header", "it claims " + std::to_string(element.count) + " of element " +
                                std::string(element.name) + ", more than the file has room for");
    }
  }
}

double decode(const char* data, const ScalarType& type, bool swap) {
  std::array<char, 8> bytes{};
  std::copy_n(data, type.size, bytes.begin());
  if (swap) std::reverse(bytes.begin(), bytes.begin() + type.size);
  if (type.is_real) {
    return type.size == 4 ? static_cast<double>(std::bit_cast<std::array<float, 2>>(bytes)[0])
                          : std::bit_cast<double>(bytes);
  }
  std::uint64_t whole = std::bit_cast<std::uint64_t>(bytes);
  const int unused = 64 - 8 * type.size;
  if (type.is_signed)
    return static_cast<double>(static_cast<std::int64_t>(whole << unused) >> unused);
  return static_cast<double>(whole);
}

// Hands out the values of the body one after the other, from text or binary.
class Body {
 public:
  Body(const Source& source, const Header& header)
      : source_(source),
        header_(header),
        rest_(source.content.substr(header.size)),
        lines_(rest_) {}

  void start_item() {
    if (header_.coding != Coding::text) return;
    std::string_view line;
    // Where an item has no values at all there is no line for it either.
    if (!lines_.next_with_words(line, '\0')) fail("the file ends before its last element");
    words_ = Words(line);
  }
  double next(const ScalarType& type) {
    if (header_.coding == Coding::text) {
      double value = 0;
      const std::string_view word = words_.next();
      if (word.empty()) fail("the line has too few values");
      if (!parse(word, value)) fail("'" + std::string(word.substr(0, 40)) + "' is not a number");
      return value;
    }
    const auto size = static_cast<std::size_t>(type.size);
    if (rest_.size() < size) fail("the file ends before its last element");
    const double value = decode(rest_.data(), type, header_.coding == Coding::big);
    rest_.remove_prefix(size);
    return value;
  }
  // The number of values that could still follow, at most.
  double room(const ScalarType& type) const {
    return static_cast<double>(header_.coding == Coding::text
                                   ? source_.content.size()
                                   : rest_.size() / static_cast<std::size_t>(type.size));
  }
  [[noreturn]] void fail(const std::string& what) const {
    if (header_.coding == Coding::text) {
      source_.fail("line " + std::to_string(header_.lines + lines_.number()), what);
    }
    source_.fail("byte " + std::to_string(source_.content.size() - rest_.size()), what);
  }

 private:
  const Source& source_;
  const Header& header_;
  std::string_view rest_;
  Lines lines_;
  Words words_{""};
};

void check_value(const Body& body, const Element& element, const Property& property, double value) {
  const bool is_position = property.name == "x" || property.name == "y" || property.name == "z";
  if (!element.is_vertex() || !is_position) return;
  if (!std::isfinite(value)) body.fail("a coordinate is not finite");
  if (std::abs(value) > kLargestCoordinate) body.fail("a coordinate is larger than 1e18");
}

// True if the list may hold a triangle: the corners of a face, or those of strips.
bool check_list(Body& body, const Header& header, const Property& property) {
  const double length = body.next(*property.length);
  if (!(length >= 0) || length != std::floor(length) || length > body.room(*property.value)) {
    body.fail("a list is longer than the file");
  }
  const bool is_index = property.name == "vertex_indices" || property.name == "vertex_index";
  const bool is_strip = property.name == "tristrips" || property.name == "trindex";
  for (double i = 0; i < length; ++i) {
    const double value = body.next(*property.value);
    if (!is_index) continue;
    if (!(value >= 0 && value < static_cast<double>(header.vertices)) ||
        value != std::floor(value)) {
      body.fail("there is no vertex " +
                std::to_string(static_cast<std::int64_t>(
                    std::isfinite(value) ? std::clamp(value, -1e18, 1e18) : -1)) +
                " (" + std::to_string(header.vertices) + " vertices, from 0)");
    }
  }
  return (is_index || is_strip) && length >= 3;
}

}  // namespace

void check_ply(const Source& source) {
  const Header header = read_header(source);
  check_counts(source, header);
  Body body(source, header);
  bool has_triangles = false;
  for (const Element& element : header.elements) {
    if (element.properties.empty()) continue;
    for (std::uint64_t i = 0; i < element.count; ++i) {
      body.start_item();
      for (const Property& property : element.properties) {
        if (property.length) {
          has_triangles |= check_list(body, header, property);
        } else {
          check_value(body, element, property, body.next(*property.value));
        }
      }
    }
  }
  if (!has_triangles) source.fail("", kNoTriangles);
}

}  // namespace delray::scenes::internal
