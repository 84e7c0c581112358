// The verifier's options, and what it does with a mesh in pieces.
#pragma once

#include <string>

#include "apps/input/point_input.h"
#include "apps/launch.h"
#include "apps/session.h"

namespace delray::apps {

// What the command line says.
struct VerifyOptions {
  std::string mesh, statistics;
  PointInput points;
  int dim = 2;
  bool canonical = false, complete = false;
  bool part = false;  // simplices may be missing
  Launch launch;
  std::string scratch;  // a folder; empty: the system's
};

// Throws FileError for a folder that is no mesh, and for a file of one that is.
void refuse_parts_of_folders(const std::string& mesh);

// Looks at the pieces of a folder by all ranks, and tells of them. The exit code. Throws FileError
// for a vertex that is none of the points. REQUIRES: the mesh is a folder.
int verify_folder(Session& session, const VerifyOptions& options);

}  // namespace delray::apps
