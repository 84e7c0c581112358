// Faces and triangle strips of a PLY file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "scenes/files/ply_header.h"
#include "scenes/files/ply_rows.h"

namespace delray::scenes::internal {

// The polygons of a block.
struct Polygons {
  std::vector<std::uint32_t> corners, sizes;
  std::vector<glm::vec2> uvs;  // of corners, if any face has them
  std::uint64_t left_out = 0;  // points and lines
  bool any = false;            // has polygons

  // Corners without have (0, 0).
  void complete_uvs() { uvs.resize(corners.size(), glm::vec2(0)); }
};

// The polygons of a block of any element; fails where a corner is no vertex of the file.
Polygons read_polygons(const PlyFile& file, const PlyElement& element, const PlyBlock& block);

// Faces of a binary file that are all triangles, if the first is.
struct EvenTriangles {
  const PlyProperty* list = nullptr;  // the corners
  std::size_t offset = 0;             // of the list in a row
};

// Nothing for other elements, and where other elements of the file have faces too.
std::optional<EvenTriangles> even_triangles(const PlyFile& file, const PlyElement& element);

// The triangles of a block of `PlyBlocks::even`. False where one is none, or a corner is no vertex
// of the file.
bool read_even_triangles(const PlyFile& file, const EvenTriangles& faces, const PlyBlock& block,
                         glm::uvec3* to);

}  // namespace delray::scenes::internal
