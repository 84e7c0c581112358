// Packs checked as a whole.
#pragma once

#include "apps/session.h"
#include "apps/verify/verify_folder.h"

namespace delray::apps {

// Reads every page of a pack, in parallel, and tells of it. The exit code. Throws FileError
// (input), which names the first page that is damaged, (device); UsageError for options of
// triangulations. REQUIRES: the mesh is a pack.
int verify_pack(Session& session, const VerifyOptions& options);

}  // namespace delray::apps
