// Colour maps: numbers shown as colours.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <string_view>

namespace delray::scenes {

// An entry of the table of colour maps.
struct ColourMap {
  const char* name;
  const char* description;
  // Linear RGB, 0 to 1, for x from 0 to 1; x beyond that counts as the nearer end, NaN as 0.
  glm::vec3 (*colour)(float x);
};

// terrain, viridis, turbo, grey, heat. The first is the default.
std::span<const ColourMap> colour_maps();

// Throws std::invalid_argument that lists the names for any other.
const ColourMap& colour_map(std::string_view name);

// Grey of that linear brightness.
glm::vec3 brightness(float x);

// The colour of a class of LAS points (ASPRS codes: 2 ground, 3 to 5 vegetation, 6 building, 9
// water ...), linear; classes without a meaning get colours that differ from their neighbours'.
glm::vec3 classification_colour(unsigned code);

}  // namespace delray::scenes
