// Looks up facets among walls.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

namespace delray::delaunay {

// Walls by their corners, in any order. A facet and the same facet from its other side differ by
// the parity of their corners' order. O(1) expected.
template <int D>
class WallTable {
 public:
  using Facet = std::array<std::uint32_t, D>;

  // REQUIRES: walls differ; corners are below `vertices`.
  WallTable(const std::vector<Facet>& walls, std::size_t vertices) : is_corner_(vertices) {
    mask_ = std::bit_ceil(2 * walls.size() + 1) - 1;
    slots_.assign(mask_ + 1, kFree);
    for (const Facet& wall : walls) {
      const auto number = static_cast<std::uint32_t>(sorted_.size());
      sorted_.push_back(sort(wall));
      for (const std::uint32_t corner : wall) is_corner_[corner] = 1;
      std::size_t slot = hash(sorted_.back().first) & mask_;
      while (slots_[slot] != kFree) slot = (slot + 1) & mask_;
      slots_[slot] = number;
    }
  }

  static constexpr std::uint32_t kNoWall = 0xffffffffU;
  struct Found {
    std::uint32_t wall = kNoWall;  // its number
    bool turned = false;           // whether the facet is the wall from its other side
  };
  Found find(const Facet& facet) const {
    for (const std::uint32_t corner : facet) {
      if (is_corner_[corner] == 0) return {};
    }
    const auto [corners, odd] = sort(facet);
    for (std::size_t slot = hash(corners) & mask_; slots_[slot] != kFree;
         slot = (slot + 1) & mask_) {
      const auto& [wall, wall_odd] = sorted_[slots_[slot]];
      if (wall == corners) return {slots_[slot], odd != wall_odd};
    }
    return {};
  }

 private:
  static constexpr std::uint32_t kFree = kNoWall;
  using Sorted = std::pair<Facet, bool>;

  static Sorted sort(Facet facet) {
    bool odd = false;
    const auto order = [&](std::size_t i, std::size_t j) {
      if (facet[i] <= facet[j]) return;
      std::swap(facet[i], facet[j]);
      odd = !odd;
    };
    order(0, 1);
    if constexpr (D == 3) {
      order(1, 2);
      order(0, 1);
    }
    return {facet, odd};
  }
  static std::size_t hash(const Facet& facet) {
    std::uint64_t key = 0;
    for (const std::uint32_t corner : facet) {
      key = (key ^ (key >> 32)) * 0xd6e8feb86659fd93 + corner;
    }
    key = (key ^ (key >> 32)) * 0xd6e8feb86659fd93;
    return key ^ (key >> 32);
  }

  std::vector<Sorted> sorted_;
  std::vector<std::uint32_t> slots_;
  std::vector<std::uint8_t> is_corner_;  // of any wall
  std::size_t mask_ = 0;
};

}  // namespace delray::delaunay
