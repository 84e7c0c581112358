// Meshes of other programs made Delaunay.
#pragma once

#include "apps/triangulate/triangulate_options.h"

namespace delray::apps {

// What `triangulate --improve` does. Returns the exit code. Throws FileError (input) with the place
// where the mesh is no triangulation of its points, UsageError.
int improve_mesh(const TriangulateOptions& options);

}  // namespace delray::apps
