#include "raytrace/tiles.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace delray::raytrace {
namespace {

int count(int length) { return (length + kTileSide - 1) / kTileSide; }

// Each row starts one rank further on, so that a rank's tiles do not line up below each other.
int interlaced(int x, int y, int /*columns*/, int ranks) { return (x + y) % ranks; }

constexpr Schedule kSchedules[] = {
    {"interlaced", "tiles dealt out in turn, each row shifted by one", interlaced},
};

}  // namespace

std::vector<geometry::Rect> tiles(int width, int height) {
  std::vector<geometry::Rect> result;
  result.reserve(static_cast<std::size_t>(count(width)) * static_cast<std::size_t>(count(height)));
  for (int y = 0; y < height; y += kTileSide) {
    for (int x = 0; x < width; x += kTileSide) {
      result.push_back({x, y, std::min(x + kTileSide, width), std::min(y + kTileSide, height)});
    }
  }
  return result;
}

std::span<const Schedule> schedules() { return kSchedules; }

const Schedule& schedule(std::string_view name) {
  std::string names;
  for (const Schedule& candidate : kSchedules) {
    if (candidate.name == name) return candidate;
    names += std::string(names.empty() ? "" : ", ") + candidate.name;
  }
  throw std::invalid_argument("unknown schedule '" + std::string(name) + "'; there are: " + names);
}

std::vector<std::uint32_t> tiles_of_rank(const Schedule& schedule, int width, int height, int rank,
                                         int ranks) {
  const int columns = count(width), rows = count(height);
  std::vector<std::uint32_t> result;
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      if (schedule.owner(x, y, columns, ranks) == rank) {
        result.push_back(static_cast<std::uint32_t>(y * columns + x));
      }
    }
  }
  return result;
}

}  // namespace delray::raytrace
