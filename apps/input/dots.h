// Points of space drawn as dots.
#pragma once

#include "scenes/scene.h"

namespace delray::apps {

// A dot of a scene without triangles: large enough for neighbours to touch if all lie on a surface
// as large as the box, within what can be told apart in a picture.
float dot_diameter(std::size_t points, const glm::vec3& size);

// Replaces every vertex of a mesh by an octahedron of its colour, shaded as a ball. Of more than
// kMostDots vertices each k-th is kept, for the smallest k that will do. Returns k.
inline constexpr std::size_t kMostDots = 4'000'000;
inline constexpr std::size_t kBytesPerDot = 8 * sizeof(glm::uvec3) + 6 * 40;
std::size_t draw_as_dots(scenes::Mesh& mesh, float diameter);

}  // namespace delray::apps
