// From a rendered frame to a file.
#pragma once

#include <string>
#include <vector>

#include "apps/render/render_frames.h"
#include "apps/session.h"

namespace CLI {
class App;
}

namespace delray::apps {

// Adds --metadata.
void add_metadata_option(CLI::App& command, Session& session);

// Whether a picture of colours, which has no background yet, shows nothing of the scene.
bool shows_nothing(const RenderRequest& request, const Picture& picture);

// In place, of a window of the frame: the background behind it and, for files of 8 bits, light
// mapped to what a screen shows.
void put_background_behind(const RenderRequest& request, const Prepared& prepared,
                           const scenes::Camera& camera, const geometry::Rect& window,
                           Picture& picture);

// What is said of a picture in its file.
std::vector<image::Attribute> picture_attributes(const Session& session, const std::string& path,
                                                 const Extras& extras = {});

// Writes the picture to `path`, whole or not at all. Equal pictures make equal files; with
// --metadata the command line and, where rays were sampled, how often, go into them. Returns the
// hash of its 8-bit pixels. Throws files::FileError.
std::string write_picture(const Session& session, const std::string& path, const Picture& picture,
                          const Extras& extras = {});

}  // namespace delray::apps
