// The functions behind the table of generators; see scenes/generate.h for their arguments.
#pragma once

#include <cstdint>

#include "scenes/generate.h"
#include "scenes/scene.h"

namespace delray::scenes::internal {

// A fractal height field, y up, 2 units wide, coloured by height and slope.
Scene generate_terrain(std::uint64_t triangles, std::uint64_t seed);

ScenePart generate_terrain_part(std::uint64_t triangles, std::uint64_t seed, int part, int parts);

// The Cornell box (Goral et al. 1984) with its area light and two blocks. Every rectangle is cut
// into squares of cells to reach the number of triangles; the seed changes nothing.
Scene generate_cornell(std::uint64_t triangles, std::uint64_t seed);

// Reflective and refractive spheres over a chequered plane, after Whitted (1980). The seed places
// the small ones.
Scene generate_spheres(std::uint64_t triangles, std::uint64_t seed);

// Blocks of buildings between streets: high in the middle, low outside.
Scene generate_city(std::uint64_t triangles, std::uint64_t seed);

// Up to 1008 instances of four detailed models on a plain, most of them far away or hidden.
Scene generate_field(std::uint64_t triangles, std::uint64_t seed);

// A heap of glass spheres in the top left corner of the picture, next to nothing elsewhere: work
// for rays that is spread as unevenly as can be. The seed places the spheres.
Scene generate_corner(std::uint64_t triangles, std::uint64_t seed);

// Up to 1024 moving instances of four models: gears that turn (linear), pistons that slide (cubic
// spline), lamps that jump (step), once in 4 seconds. The seed changes nothing.
Scene generate_machine(std::uint64_t triangles, std::uint64_t seed);

// A flag in the wind: two morph targets, once in 2 seconds. The seed changes nothing.
Scene generate_cloth(std::uint64_t triangles, std::uint64_t seed);

// An arm that bends: a skin over a chain of joints, once in 4 seconds. The seed changes nothing.
Scene generate_arm(std::uint64_t triangles, std::uint64_t seed);

}  // namespace delray::scenes::internal
