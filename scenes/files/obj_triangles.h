// The faces of an OBJ file that are triangles of positions alone.
#pragma once

#include "scenes/files/obj_text.h"
#include "scenes/scene.h"

namespace delray::scenes::internal {

// Makes `mesh` of all elements, vertices numbered by their first corners, which takes little more
// memory than the mesh; takes the positions and colours of the text for that. False, and nothing,
// where elements are anything else or something is wrong, of which whoever reads line by line tells
// what. Parallel.
bool read_obj_triangles(ObjText& text, Mesh& mesh);

}  // namespace delray::scenes::internal
