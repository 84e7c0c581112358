#include "delaunay/tiles/region.h"

namespace delray::delaunay {

void append(Region& all, const Region& other) {
  const auto first = static_cast<std::uint32_t>(all.points.size());
  all.points.insert(all.points.end(), other.points.begin(), other.points.end());
  all.own = all.points.size();
  for (const std::uint32_t corner : other.walls) all.walls.push_back(first + corner);
}

}  // namespace delray::delaunay
