// Key frames at a time.
#pragma once

#include <span>

#include "scenes/animation.h"

namespace delray::scenes::internal {

// The value of a channel, of as many numbers as it is wide; rotations have unit length. Before the
// first and after the last key the value there. O(log keys + width).
void interpolate(const AnimationChannel& channel, double seconds, std::span<double> value);

}  // namespace delray::scenes::internal
