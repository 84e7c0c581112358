// Walls: grids of displays that together show one picture, each with the pixels of its own.
#pragma once

#include <cstdint>
#include <vector>

#include "loadbalance/partition.h"

namespace delray::loadbalance {

// Displays of one size, row by row from the upper left. What a bezel hides between two of them is a
// part of the picture that nobody sees, so that lines go on straight from one to the next.
struct Wall {
  int columns = 1, rows = 1;
  int width = 0, height = 0;     // of a display, in pixels
  int bezel_x = 0, bezel_y = 0;  // pixels of the picture between two neighbours

  int displays() const { return columns * rows; }
  // All of the picture, what is hidden included. REQUIRES: its sides fit an int.
  geometry::Rect frame() const {
    return {0, 0, columns * width + (columns - 1) * bezel_x, rows * height + (rows - 1) * bezel_y};
  }
  geometry::Rect display(int index) const {
    const int x = index % columns * (width + bezel_x), y = index / columns * (height + bezel_y);
    return {x, y, x + width, y + height};
  }
};

// The displays with the ranks that show them, in order: runs of about equal length, or with more
// ranks than displays single ranks with about equal distances. REQUIRES: ranks >= 1.
std::vector<Region> displays_of(const Wall& wall, int ranks);

// The frame cut along the middles of bezels: every display with its owner draws what it shows, and
// some that it does not. `displays` as displays_of gives them, for the wall's frame.
Partition cut_by_displays(const geometry::Rect& frame, std::span<const Region> displays);

// Pixels that are drawn by one rank and shown by another, for an owner of regions per rank. What
// bezels hide does not travel.
struct PixelTraffic {
  std::uint64_t pixels = 0;   // in all
  std::uint64_t busiest = 0;  // the most that one rank sends and receives
};
// O(regions + displays + pairs of them that touch, times the logarithm of displays).
PixelTraffic pixel_traffic(const Partition& partition, std::span<const Region> displays, int ranks);

}  // namespace delray::loadbalance
