// Readers of the formats whose geometry is text or plain records; glTF has its own header.
//
// All are linear in the file's size. They throw files::FileError that names line, byte or element
// for whatever is wrong, a file without triangles included; polygons are cut into triangles.
#pragma once

#include "scenes/files/source.h"
#include "scenes/scene.h"

namespace delray::scenes::internal {

// One mesh for each material, and for faces with and without normals, lines (1.5 pixels wide) and
// points (3 pixels); groups and objects are one mesh. Materials are those of MTL files beside it.
// Free forms are left out with a warning.
Scene read_obj(const Source& source);

// ASCII and binary of either byte order: faces and triangle strips (Stanford's, with -1 between
// strips), normals, colours, texture coordinates of vertices or of corners.
Scene read_ply(const Source& source);

// Vertices and faces, without colours and normals.
Scene read_off(const Source& source);

// Text and binary, with the colours of facets where a file has them.
Scene read_stl(const Source& source);

}  // namespace delray::scenes::internal
