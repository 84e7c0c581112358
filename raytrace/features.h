// Properties of a picture's surfaces besides colour: of the first surface that each pixel sees.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace delray::raytrace {

// Means over a pixel's first samples; what lets light through counts by its alpha. All vectors have
// an element per pixel, row by row.
struct Features {
  std::vector<glm::vec3> normal;  // shading normal in the world, to the viewer's side; 0: nothing
  std::vector<glm::vec3> albedo;  // base colour, with alpha; 0: nothing
  std::vector<std::uint32_t> instance, material;  // of the first sample; kMiss: nothing

  Features() = default;
  explicit Features(std::size_t pixels);
};

}  // namespace delray::raytrace
