// Scenes that the project makes itself.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "scenes/scene.h"

namespace delray::scenes {

struct Generator {
  const char* name;
  const char* description;
  std::uint64_t default_triangles;
  // About `triangles` triangles, the same for the same seed on every machine.
  Scene (*generate)(std::uint64_t triangles, std::uint64_t seed);
};

// terrain, cornell, spheres, city, field.
std::span<const Generator> generators();

// "gen:KIND[:TRIANGLES[:SEED]]" -> the scene. Throws std::invalid_argument naming the legal kinds.
Scene generate(std::string_view name);
bool is_generated(std::string_view name);  // starts with "gen:"

}  // namespace delray::scenes
