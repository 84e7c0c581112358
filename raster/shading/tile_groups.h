// The triangles that a tile shows, grouped by cluster.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "raster/pipeline/mesh_clusters.h"
#include "raster/pipeline/screen.h"
#include "raster/pipeline/visibility.h"

namespace delray::raster {

// By which numbers are turned into indices, without a branch.
struct TriangleIndices {
  const std::uint16_t* group_of_cluster;
  const std::uint16_t* index;  // by group and place

  std::uint16_t of(std::uint32_t number) const {
    const std::uint32_t group = group_of_cluster[number >> kClusterBits];
    return index[group * kClusterTriangles + number % kClusterTriangles];
  }
};

// First all triangles are added, as often as one likes, then they get indices: those of a group are
// consecutive, in the order of their places in the cluster. O(triangles added), and two bytes for
// each cluster up to the last one that was ever added.
//
// REQUIRES: at most kTilePixels triangles.
class TileGroups {
 public:
  struct Group {
    std::uint32_t cluster = 0;
    std::uint16_t first = 0, count = 0;  // indices of its triangles
    std::uint64_t places[kClusterTriangles / 64] = {};
  };

  void clear();
  void add(std::uint32_t number);
  void number_triangles();

  std::span<const Group> groups() const { return groups_; }
  // Where each triangle that was added is; valid until others are.
  TriangleIndices indices() const { return {group_of_cluster_.data(), indices_.data()}; }
  // In the cluster, of all triangles.
  std::span<const std::uint8_t> places() const { return places_; }

 private:
  static constexpr std::uint16_t kNone = 0xFFFFU;

  std::uint16_t new_group(std::uint32_t cluster);

  std::vector<Group> groups_;
  std::vector<std::uint16_t> indices_;           // by group and place
  std::vector<std::uint8_t> places_;             // by index
  std::vector<std::uint16_t> group_of_cluster_;  // kNone where there is none
};

}  // namespace delray::raster
