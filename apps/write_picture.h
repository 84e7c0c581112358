// From a rendered frame to a file.
#pragma once

#include <string>

#include "apps/render_frames.h"
#include "apps/session.h"

namespace delray::apps {

// Puts the background behind the picture, in place, and writes it to `path`, whole or not at all.
// Returns the hash of its 8-bit pixels. Throws files::FileError.
std::string write_picture(const RenderRequest& request, const Session& session,
                          const Prepared& prepared, const scenes::Camera& camera,
                          const std::string& path, Picture& picture);

}  // namespace delray::apps
