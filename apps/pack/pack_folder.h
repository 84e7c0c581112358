// A mesh in pieces as a pack, piece by piece.
#pragma once

#include "apps/input/scene_input.h"
#include "packs/pack_writer.h"

namespace delray::apps {

// Whether the input is a folder of pieces whose triangles are a surface: memory need not hold it.
bool is_surface_in_pieces(const SceneInput& input);

// Writes the pack that load_scene() and write_pack() would make of the folder: the same triangles
// in the same order, with the same normals on the borders of pieces. Its picture is also that of
// the mesh in one file, which has the triangles in another order, but for ties of depth. Memory: a
// piece at a time, two bits for each row of the input, and the triangles on borders of pieces. The
// folder is read four times, five where there are outliers or rows that no triangle has.
//
// Degenerate: points of two pieces that are one as 32-bit floats without either being on the border
// are not seen to be one, so that each keeps the normal of its own piece.
//
// Throws FileError (input) for pieces that are not what the index says, (memory), (device);
// UsageError for colours of attributes that pieces do not have. REQUIRES: is_surface_in_pieces.
void pack_folder(const SceneInput& input, const std::string& output,
                 const packs::WriteOptions& options, parallel::Progress* progress);

}  // namespace delray::apps
