// Scene files of which every rank reads a part.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "comm/communicator.h"
#include "scenes/load.h"
#include "scenes/scene_part.h"

namespace delray::scenes {

// Fewer triangles for each rank are not worth a part of their own.
inline constexpr std::uint64_t kLeastTrianglesOfPart = 1024;

// Rank k of n gets the k-th of n nearly equal runs of the triangles that load() would give, with
// the normals that complete_surfaces() would give them, and reads no more of the file than it needs
// for that: its triangles and their vertices, and an n-th of all vertices to look at. The bits of
// triangles, positions and attributes are those of the whole scene; vertices have numbers of their
// own. Collective; what ranks exchange are positions and the triangles along their borders. O(1 / n
// of the file), if triangles near each other in the file have vertices near each other.
//
// Nothing, on all ranks, for files that are no binary PLY of triangles and no glTF of one indexed
// mesh of triangles that is placed once; of those in which anything may move or bend; that load()
// would put into another order, whose materials glow or have normal maps without tangents, or that
// are far from 0 and glTF; of fewer than kLeastTrianglesOfPart a rank; and where anything is wrong
// with the file, which load() tells.
//
// Warnings are rank 0's. Throws what all ranks throw; files::FileError only for lack of memory.
std::optional<ScenePart> load_part(comm::Communicator& communicator,
                                   const std::filesystem::path& path,
                                   std::vector<std::string>& warnings,
                                   const LoadOptions& options = {});

}  // namespace delray::scenes
