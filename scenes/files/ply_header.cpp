// PLY headers: lines of words up to "end_header".
#include "scenes/files/ply_header.h"

#include <algorithm>
#include <array>

#include "scenes/files/text_lines.h"

namespace delray::scenes::internal {
namespace {

struct PlyTypeName {
  const char* name;
  const char* other_name;
  PlyType type;
};
constexpr std::array kPlyTypes = {
    PlyTypeName{"char", "int8", PlyType::i8},      PlyTypeName{"uchar", "uint8", PlyType::u8},
    PlyTypeName{"short", "int16", PlyType::i16},   PlyTypeName{"ushort", "uint16", PlyType::u16},
    PlyTypeName{"int", "int32", PlyType::i32},     PlyTypeName{"uint", "uint32", PlyType::u32},
    PlyTypeName{"float", "float32", PlyType::f32}, PlyTypeName{"double", "float64", PlyType::f64}};

// Reads the header line by line.
class PlyHeaderReader {
 public:
  PlyHeaderReader(const Source& source, std::string_view start)
      : source_(source), start_(start), lines_(start) {}

  PlyHeader run() {
    std::string_view line;
    if (!lines_.next(line) || Words(line).next() != "ply")
      source_.fail("line 1", "this is not a PLY file");
    const std::string_view line_end = end_of(line);
    while (lines_.next(line)) {
      Words words(line);
      const std::string_view key = words.next();
      if (key == "format") {
        read_coding(words.next());
      } else if (key == "element") {
        read_element(words);
      } else if (key == "property") {
        read_property(words);
      } else if (key == "comment") {
        read_comment(words);
      } else if (key == "end_header") {
        if (!has_format_) source_.fail(lines_.place(), "the header has no format");
        const auto end = static_cast<std::size_t>(line.data() - start_.data());
        header_.size = end + line.size() + std::min(end_of(line).size(), line_end.size());
        header_.lines = lines_.number();
        return std::move(header_);
      } else if (!key.empty() && key != "obj_info") {
        source_.fail(lines_.place(),
                     "unknown word '" + std::string(key.substr(0, 20)) + "' in the header");
      }
    }
    source_.fail(lines_.place(), "the file ends within its header");
  }

 private:
  // The end that separates `line` from the next.
  std::string_view end_of(std::string_view line) const {
    const auto at = static_cast<std::size_t>(line.data() - start_.data()) + line.size();
    const std::string_view rest = start_.substr(at);
    return rest.substr(0, rest.starts_with("\r\n") ? 2 : 1);
  }

  PlyType type_named(std::string_view name) const {
    for (const PlyTypeName& type : kPlyTypes) {
      if (name == type.name || name == type.other_name) return type.type;
    }
    source_.fail(lines_.place(), "there is no type '" + std::string(name.substr(0, 20)) + "'");
  }

  void read_coding(std::string_view word) {
    has_format_ = true;
    if (word == "ascii") {
      header_.coding = PlyCoding::text;
    } else if (word == "binary_little_endian") {
      header_.coding = PlyCoding::little;
    } else if (word == "binary_big_endian") {
      header_.coding = PlyCoding::big;
    } else {
      source_.fail(lines_.place(), "unknown format '" + std::string(word.substr(0, 40)) + "'");
    }
  }

  void read_element(Words& words) {
    PlyElement element;
    element.name = words.next();
    if (!parse(words.next(), element.count)) {
      source_.fail(lines_.place(), "the element has no valid count");
    }
    if (element.name == "vertex") {
      if (has_vertices_) source_.fail(lines_.place(), "there are vertices already");
      has_vertices_ = true;
      header_.vertices = element.count;
    }
    header_.elements.push_back(std::move(element));
  }

  void read_property(Words& words) {
    if (header_.elements.empty()) {
      source_.fail(lines_.place(), "a property before the first element");
    }
    PlyProperty property;
    std::string_view word = words.next();
    if (word == "list") {
      property.length = type_named(words.next());
      if (property.length == PlyType::f32 || property.length == PlyType::f64) {
        source_.fail(lines_.place(), "the length of a list must be whole");
      }
      word = words.next();
    }
    property.value = type_named(word);
    property.name = words.next();
    if (property.name.empty()) source_.fail(lines_.place(), "the property has no name");
    header_.elements.back().properties.push_back(property);
  }

  void read_comment(Words& words) {
    if (words.next() == "TextureFile") {
      const std::string_view name = words.rest();
      if (!name.empty()) header_.textures.push_back(name);
    }
  }

  const Source& source_;
  std::string_view start_;
  Lines lines_;
  PlyHeader header_;
  bool has_format_ = false, has_vertices_ = false;
};

void check_counts(const Source& source, const PlyHeader& header, std::uint64_t bytes) {
  const std::uint64_t size = bytes - header.size;
  for (const PlyElement& element : header.elements) {
    std::uint64_t each = 0;
    for (const PlyProperty& p : element.properties) {
      each += header.coding == PlyCoding::text ? 2 : size_of(p.is_list() ? p.length : p.value);
    }
    // The last text value needs no separator.
    if (element.count > (size + 1) / std::max<std::uint64_t>(each, 1)) {
      source.fail("header", "it claims " + std::to_string(element.count) + " of element " +
                                std::string(element.name) + ", more than the file has room for");
    }
  }
}

}  // namespace

std::size_t size_of(PlyType type) {
  constexpr std::array<std::size_t, 9> kSizes = {1, 1, 2, 2, 4, 4, 4, 8, 0};
  return kSizes[static_cast<std::size_t>(type)];
}

double full_scale(PlyType type) {
  constexpr std::array kScales = {127.0,        255.0, 32767.0, 65535.0, 2147483647.0,
                                  4294967295.0, 1.0,   1.0,     1.0};
  return kScales[static_cast<std::size_t>(type)];
}

PlyHeader read_ply_header(const Source& source, std::string_view start, std::uint64_t bytes) {
  PlyHeader header = PlyHeaderReader(source, start).run();
  check_counts(source, header, bytes);
  return header;
}

// Headers are rarely longer than the first megabyte.
PlyHeader read_ply_header(const Source& source, const files::FileBytes& bytes,
                          std::string& buffer) {
  for (std::uint64_t limit = std::uint64_t{1} << 20;; limit *= 8) {
    const bool all = limit >= bytes.size();
    const std::string_view start = bytes.read(0, all ? bytes.size() : limit, buffer);
    try {
      PlyHeader header = read_ply_header(source, start, bytes.size());
      if (all || header.size + 1 < start.size()) return header;
    } catch (const files::FileError&) {
      if (all) throw;
    }
  }
}

}  // namespace delray::scenes::internal
