// Meshes of the elements of an OBJ file.
#pragma once

#include <cstdint>
#include <vector>

#include "scenes/files/obj_elements.h"
#include "scenes/scene.h"

namespace delray::scenes::internal {

// Elements of a range from number `begin` on have a material.
struct ObjMaterialRun {
  std::uint64_t begin = 0;
  std::uint32_t material = 0;
};

// Meshes in the order in which elements first ask for them: one for the faces of each material that
// have normals at all corners, for its other faces, for its lines and for its points. Corners of
// equal indices are one vertex of a mesh, numbered by its first corner. Faces of less than three
// corners and lines of one are left out, and counted. `runs`, of each range, begin with element 0,
// if there is one. Takes the elements. O(corners) expected, but for polygons; parallel. Throws
// FileError.
std::vector<Mesh> make_obj_meshes(const ObjText& text, std::vector<ObjElements>&& elements,
                                  const std::vector<std::vector<ObjMaterialRun>>& runs,
                                  std::uint64_t& left_out);

}  // namespace delray::scenes::internal
