// Facts that ranks which have each loaded the same scene must agree in.
#pragma once

#include <string>
#include <vector>

#include "apps/render/render_frames.h"
#include "comm/handshake.h"

namespace delray::apps {

// Counts, the camera, and hashes of samples of meshes, textures and whatever else is in the scene:
// files that a scene names may differ where the scene's own file does not. Reads 128 KiB of an
// array at most.
std::vector<comm::Fact> scene_facts(const Prepared& prepared);

// Likewise, of the textures.
std::string texture_hash(const scenes::Scene& scene);

}  // namespace delray::apps
