// Triangulations with points added until triangles are well shaped and small.
#pragma once

#include "apps/triangulate/triangulate_options.h"

namespace delray::apps {

// Whether options ask for refinement.
bool is_refined(const TriangulateOptions& options);

// Adds --min-angle, --max-area, --refinement and --whole.
void add_refine_options(CLI::App& command, RefinementChoice& choice);

// Throws UsageError for options that mean nothing to it, FileError for outputs that cannot be.
void check_refine(const Session& session, TriangulateOptions& options);

// What `triangulate --min-angle` and `--max-area` do. Returns the exit code. Throws FileError.
int refine_points(Session& session, const TriangulateOptions& options);

}  // namespace delray::apps
