// A page as bytes, and back.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "packs/page.h"

namespace delray::packs::internal {

// Two blocks, each compressed on its own, behind the size of the first (u32):
//   clusters: triangles (u16), vertices (u16), box, cone, whether normals agree (u8); references
//     (u16); corners, as Page has them but without padding; positions
//   attributes: normals, uvs, uvs2, tangents, colours, as far as there are any
// Positions and attributes are planes (word_planes.h) of one coordinate after the other.
std::vector<char> encode(const Page& page);

// Into `page`, whatever it was before: its memory is used again. Throws FileError (input) for
// anything that is not a page of the mesh with the row's counts: indices out of range, positions
// that are not in the row's box.
void decode(std::span<const char> bytes, const PageRow& row, const MeshRow& mesh,
            const std::string& file, const std::string& place, Page& page);

}  // namespace delray::packs::internal
