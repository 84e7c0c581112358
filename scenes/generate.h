// Scenes that the project makes itself.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "scenes/scene.h"
#include "scenes/scene_part.h"

namespace delray::scenes {

// An entry of the table of generated scenes.
struct Generator {
  const char* name;
  const char* description;
  std::uint64_t default_triangles;
  double bytes_per_triangle;  // that making the scene takes at most, of large ones (measured)
  // About `triangles` triangles, the same for the same seed on every machine.
  Scene (*generate)(std::uint64_t triangles, std::uint64_t seed);
  // Part `part` of `parts` in the memory that it takes alone; null where there is no such way.
  // REQUIRES: 0 <= part < parts.
  ScenePart (*generate_part)(std::uint64_t triangles, std::uint64_t seed, int part,
                             int parts) = nullptr;
};

// That a generated scene may be asked for: 3e9 corners still have 32-bit numbers.
inline constexpr std::uint64_t kMostTriangles = 1'000'000'000;

// terrain, cornell, spheres, city, field, corner, machine, cloth, arm.
std::span<const Generator> generators();

// "gen:KIND[:TRIANGLES[:SEED]]" -> the scene; numbers as files::parse_count reads them. Throws
// std::invalid_argument naming the legal kinds.
Scene generate(std::string_view name);
bool is_generated(std::string_view name);  // starts with "gen:"
// The name with triangles and seed, whatever was left to the defaults. Throws as generate.
std::string full_name(std::string_view name);

// The memory that making it takes, nearly. Throws as generate.
std::uint64_t generated_bytes(std::string_view name);

// Generation in parts. Throws as generate.
bool has_parts(std::string_view name);
// REQUIRES: has_parts(name), 0 <= part < parts.
ScenePart generate_part(std::string_view name, int part, int parts);

}  // namespace delray::scenes
