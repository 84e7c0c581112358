// Worlds of ANARI's objects as scenes.
#pragma once

#include "c/object.h"
#include "scenes/scene.h"

namespace delray::c {

// The scene of a world's committed parameters: a mesh for each surface, placed by every instance of
// its groups. Throws std::invalid_argument, naming the object, for what is missing or does not fit.
scenes::Scene scene_of(const DelrayObject_& world);

}  // namespace delray::c
