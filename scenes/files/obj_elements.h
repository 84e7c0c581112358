// Faces, lines and points of an OBJ file, corner by corner.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "scenes/files/obj_text.h"

namespace delray::scenes::internal {

// Numbers of a position, texture coordinate and normal, from 0; kNone: none.
using ObjCorner = std::array<std::uint32_t, 3>;

struct ObjElement {
  enum Kind : std::uint8_t { face, line, points } kind = face;
  std::uint32_t corners = 0;
};

// Those of a range, in the order of the file.
struct ObjElements {
  std::vector<ObjCorner> corners;
  std::vector<ObjElement> elements;
};

// Reads those of a range. Fails where a corner names what is not in the file.
ObjElements read_obj_elements(const ObjText& text, std::size_t range);

}  // namespace delray::scenes::internal
