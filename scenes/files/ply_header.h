// The header of a PLY file (Turk 1994).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/files/source.h"

namespace delray::scenes::internal {

enum class PlyType : std::uint8_t { i8, u8, i16, u16, i32, u32, f32, f64, none };

std::size_t size_of(PlyType type);  // bytes; 0 of none
// The largest whole number of the type; 1 of those that are real: the code of a full colour.
double full_scale(PlyType type);

struct PlyProperty {
  std::string_view name;
  PlyType length = PlyType::none;  // of a list; none for a single value
  PlyType value = PlyType::none;

  bool is_list() const { return length != PlyType::none; }
};

struct PlyElement {
  std::string_view name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

enum class PlyCoding : std::uint8_t { text, little, big };

struct PlyHeader {
  PlyCoding coding = PlyCoding::text;
  std::vector<PlyElement> elements;
  std::vector<std::string_view> textures;  // of comments "TextureFile NAME"
  std::size_t size = 0;                    // bytes
  std::uint64_t lines = 0;
  std::uint64_t vertices = 0;
};

// Fails where the header is malformed or claims more elements than the file has room for. The body
// begins right after the end of the line "end_header", which is "\n", "\r\n" or "\r" as it is after
// the first line. Names are views of `start`, which has all of the header, of a file of so many
// bytes.
PlyHeader read_ply_header(const Source& source, std::string_view start, std::uint64_t bytes);

// The same, of a file of which no more is read than the header needs, into `start`.
PlyHeader read_ply_header(const Source& source, const files::FileBytes& bytes, std::string& start);

}  // namespace delray::scenes::internal
