// Parts of a scene that glTF has no words for: its environment and its area lights. They are kept
// under "extras": {"delray": ...} of the glTF scene, where other programs pass over them.
#pragma once

#include "scenes/gltf/json_view.h"
#include "scenes/scene.h"

namespace delray::scenes::internal {

// Null if there is nothing to say.
Json extras_of(const Scene& scene);

// `extras` may be absent. Adds to the scene what it finds.
void read_extras(const JsonView& extras, Scene& scene);

}  // namespace delray::scenes::internal
