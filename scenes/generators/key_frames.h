// Key frames of generated animations.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "scenes/animation.h"
#include "scenes/geometry/noise.h"

namespace delray::scenes::internal {

// The rotation by a part of a turn about an axis of unit length.
inline glm::dvec4 rotation_by(const glm::dvec3& axis, double turns) {
  const glm::dvec2 half = turn(0.5 * turns);
  return {axis * half.y, half.x};
}

// A channel without key frames.
inline AnimationChannel channel_of(std::uint32_t node, AnimationChannel::Path path,
                                   AnimationChannel::Interpolation interpolation,
                                   std::uint32_t width) {
  return {path, interpolation, node, width, {}, {}};
}

// Appends numbers to a channel's values.
inline void append(std::vector<float>& values, std::initializer_list<double> numbers) {
  for (const double number : numbers) values.push_back(static_cast<float>(number));
}

}  // namespace delray::scenes::internal
