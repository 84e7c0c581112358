// The texture of a PLY file, named by a comment.
#pragma once

#include "scenes/files/ply_header.h"
#include "scenes/scene.h"

namespace delray::scenes::internal {

// Gives the first material the first texture, if there is one; warns of others. Throws FileError
// (memory).
void add_ply_texture(const Source& source, const PlyHeader& header, Scene& scene);

}  // namespace delray::scenes::internal
