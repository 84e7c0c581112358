// The Polygon File Format: its header, and walking over its elements.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "delaunay/files/input.h"
#include "delaunay/files/text_rows.h"

namespace delray::delaunay {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
enum class PlyEncoding { ascii, little_endian, big_endian };

struct PlyProperty {
  std::string name;
  PlyType type;
  std::optional<PlyType> count_type;  // of a list; none for a single value
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;  // as the header says; not yet compared with the size of the file
  std::vector<PlyProperty> properties;

  bool has_lists() const;
  // Bytes of a binary row whose lists are all empty.
  std::size_t smallest_row() const;
};

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::ascii;
  std::vector<PlyElement> elements;
  TextPlace body;
};

// Throws FileError (input) with the line at fault.
PlyHeader parse_ply_header(const Input& input);

std::size_t ply_size(PlyType type);
// The value at `data`, unaligned; every PLY type fits a double exactly.
double ply_value(const char* data, PlyType type, PlyEncoding encoding);

// One property of one row of a binary element: `count` values of the property's type.
struct PlyValues {
  const char* data = nullptr;
  std::size_t count = 0;
};

// Fills values[j] with property j of the row at `byte` and returns where the next row begins;
// throws FileError if the file ends before. REQUIRES: values has one entry per property.
std::size_t read_ply_row(const Input& input, PlyEncoding encoding, const PlyElement& element,
                         std::size_t byte, std::vector<PlyValues>& values);

// Where element number `wanted` begins: skips the elements before it. Checks that its rows fit what
// is left of the file, so that `count` may be allocated.
TextPlace ply_element_start(const Input& input, const PlyHeader& header, std::size_t wanted);

}  // namespace delray::delaunay
