// How the frame is cut into tiles and which rank traces which.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "geometry/rect.h"

namespace delray::raytrace {

// A multiple of the side of a packet's block, so that no block lies in two tiles; large enough that
// a tile takes a good part of a millisecond, small enough that there are many for each rank.
inline constexpr int kTileSide = 32;

// Tiles of a frame, row by row; the last of a row or column may be narrower.
// REQUIRES: width, height >= 0.
std::vector<geometry::Rect> tiles(int width, int height);

struct Schedule {
  const char* name;
  const char* description;
  // The rank that traces the tile in column x and row y of the grid of tiles.
  int (*owner)(int x, int y, int columns, int ranks);
};

std::span<const Schedule> schedules();

// Throws std::invalid_argument naming the legal ones.
const Schedule& schedule(std::string_view name);

// Numbers of the tiles that a rank traces, ascending. Every tile has exactly one rank.
std::vector<std::uint32_t> tiles_of_rank(const Schedule& schedule, int width, int height, int rank,
                                         int ranks);

}  // namespace delray::raytrace
