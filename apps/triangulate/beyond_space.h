// Triangulations of four and more dimensions.
#pragma once

#include "apps/session.h"
#include "apps/triangulate/triangulate_options.h"

namespace delray::apps {

// Whether the options ask for more dimensions than meshes have.
inline bool is_beyond_space(const TriangulateOptions& options) { return options.how.dim > 3; }

// Throws UsageError for options that have no effect there.
void check_beyond_space(const Session& session, const TriangulateOptions& options);

// What `triangulate --dim 4` does. Returns the exit code. Throws FileError, UsageError.
int triangulate_beyond_space(Session& session, const TriangulateOptions& options);

}  // namespace delray::apps
