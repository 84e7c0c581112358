// The files of a wall's displays, each written by the rank that shows it.
#pragma once

#include <string>
#include <vector>

#include "apps/render/render_frames.h"
#include "apps/session.h"

namespace delray::apps {

// A display, as rank 0 knows it.
struct ShownDisplay {
  int column = 0, row = 0, rank = 0;
  std::string path, hash;
  bool is_empty = false;  // nothing of the scene is in view
};

// Puts the background behind the displays that this rank shows and writes them, each whole or not
// at all. On rank 0 the result is all of them, in order. Collective.
std::vector<ShownDisplay> write_displays(comm::Communicator& communicator, const Prepared& prepared,
                                         const RenderRequest& request, const Session& session,
                                         std::vector<Picture>&& shown);

// One hash for all displays: of their hashes, in order.
std::string hash_of(const std::vector<ShownDisplay>& displays);

// For statistics.
Json wall_statistics(const RenderRequest& request, const std::vector<ShownDisplay>& displays);

}  // namespace delray::apps
