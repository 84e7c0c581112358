// What a page is told of a place that was clicked.
#pragma once

#include "apps/render/prepare.h"
#include "apps/statistics.h"
#include "apps/view/viewers.h"

namespace delray::apps::view {

// {"type": "pick", "hit": whether anything is there, "x", "y": of the message, "position": in the
// scene, "facts": [[name, value]]}: coordinates of the file, instance, mesh, primitive, material,
// normal, colour; of a corner that is a point of a file, all that the file says of it; "measured":
// the position without exaggeration, for distances. Of packs, whose geometry is not in memory,
// nothing is found.
Json picked(const Task& task, const Prepared& prepared);

}  // namespace delray::apps::view
