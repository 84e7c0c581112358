// Groups the triangles that a tile shows by cluster, as bit masks of their places, and numbers them
// in that order. A table over clusters finds a group without hashing; clearing resets the entries
// in use only.
#include "raster/shading/tile_groups.h"

#include <algorithm>
#include <bit>

namespace delray::raster {

void TileGroups::clear() {
  for (const Group& group : groups_) group_of_cluster_[group.cluster] = kNone;
  groups_.clear();
}

std::uint16_t TileGroups::new_group(std::uint32_t cluster) {
  if (cluster >= group_of_cluster_.size())
    group_of_cluster_.resize(cluster + cluster / 2 + 1, kNone);
  groups_.emplace_back().cluster = cluster;
  return group_of_cluster_[cluster] = static_cast<std::uint16_t>(groups_.size() - 1);
}

void TileGroups::add(std::uint32_t number) {
  const std::uint32_t cluster = number >> kClusterBits;
  std::uint16_t group = cluster < group_of_cluster_.size() ? group_of_cluster_[cluster] : kNone;
  if (group == kNone) group = new_group(cluster);
  const std::uint32_t place = number % kClusterTriangles;
  groups_[group].places[place / 64] |= std::uint64_t{1} << place % 64;
}

void TileGroups::number_triangles() {
  indices_.resize(groups_.size() * kClusterTriangles);
  places_.resize(kTilePixels);
  std::size_t size = 0;
  std::uint16_t* indices = indices_.data();
  for (Group& group : groups_) {
    group.first = static_cast<std::uint16_t>(size);
    for (std::uint32_t word = 0; word < kClusterTriangles / 64; ++word) {
      for (std::uint64_t bits = group.places[word]; bits != 0; bits &= bits - 1) {
        const std::uint32_t place = word * 64 + static_cast<std::uint32_t>(std::countr_zero(bits));
        indices[place] = static_cast<std::uint16_t>(size);
        places_[size++] = static_cast<std::uint8_t>(place);
      }
    }
    group.count = static_cast<std::uint16_t>(size - group.first);
    indices += kClusterTriangles;
  }
  places_.resize(size);
}

}  // namespace delray::raster
