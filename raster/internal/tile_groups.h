// The triangles that a tile shows, grouped by cluster.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "raster/internal/mesh_clusters.h"
#include "raster/internal/screen.h"
#include "raster/internal/visibility.h"

namespace delray::raster {

// First all triangles are added, as often as one likes, then they get indices: those of a group are
// consecutive, in the order of their places in the cluster. O(triangles added).
//
// REQUIRES: at most kTilePixels triangles.
class TileGroups {
 public:
  struct Group {
    std::uint32_t cluster = 0;
    std::uint16_t first = 0, count = 0;  // indices of its triangles
    std::uint16_t slot = 0;              // in the hash table
    std::uint64_t places[kClusterTriangles / 64] = {};
  };

  TileGroups();
  void clear();
  // The triangle's group.
  std::uint16_t add(std::uint32_t number);
  void number_triangles();

  std::span<const Group> groups() const { return groups_; }
  std::uint16_t index(std::uint16_t group, std::uint32_t number) const {
    return indices_[group * kClusterTriangles + number % kClusterTriangles];
  }
  // In the cluster, of all triangles.
  std::span<const std::uint8_t> places() const { return places_; }

 private:
  static constexpr std::uint32_t kSlots = 2 * kTilePixels;
  static constexpr std::uint16_t kNone = 0xFFFFU;

  std::uint16_t group_of(std::uint32_t cluster);

  std::vector<Group> groups_;
  std::vector<std::uint16_t> indices_;  // by group and place
  std::vector<std::uint8_t> places_;    // by index
  std::uint16_t slots_[kSlots];         // into groups_, kNone where free
  std::uint32_t last_cluster_ = kNothing;
  std::uint16_t last_group_ = 0;
};

}  // namespace delray::raster
