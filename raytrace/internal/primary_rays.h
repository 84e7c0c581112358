// Rays from the camera.
#pragma once

#include <cstdint>

#include "raytrace/walk.h"

namespace delray::raytrace {

// Adds a group for each sample and block of a task, in the order of Walk::samples. Rays reach a
// depth of 1 along the view axis per unit of distance. Returns how many rays there are.
std::uint64_t ask_primary_rays(const Setting& setting, const Task& task, Groups<RayGroup>& groups);

}  // namespace delray::raytrace
