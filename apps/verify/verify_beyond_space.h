// Verification of triangulations of four and more dimensions.
#pragma once

#include "apps/session.h"
#include "apps/verify/verify_folder.h"

namespace delray::apps {

// What `verify --dim 4` does. Returns the exit code. Throws FileError, UsageError.
int verify_beyond_space(const Session& session, const VerifyOptions& options);

}  // namespace delray::apps
