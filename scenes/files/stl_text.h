// STL as text.
#pragma once

#include "files/file_bytes.h"
#include "scenes/files/source.h"
#include "scenes/scene.h"

namespace delray::scenes::internal {

// A mesh of all facets with three vertices each, not joined; in the order of the file. Parallel;
// O(bytes). Throws FileError that names the line.
Scene read_stl_text(const Source& source, const files::FileBytes& bytes);

}  // namespace delray::scenes::internal
