#include "raster/internal/tile_groups.h"

#include <algorithm>
#include <bit>

namespace delray::raster {
namespace {

// Neighbouring clusters mostly have neighbouring numbers: sixteen of them share a cache line. The
// others are scattered by Fibonacci hashing (Knuth 1973, 6.4).
template <std::uint32_t kSlots>
std::uint32_t first_slot(std::uint32_t number) {
  constexpr std::uint32_t kGoldenRatio = 0x9E3779B9U;
  constexpr std::uint32_t kNear = 16;
  return ((number / kNear * kGoldenRatio) >> (32 - std::bit_width(kSlots / kNear - 1))) * kNear +
         number % kNear;
}

}  // namespace

TileGroups::TileGroups() { std::fill_n(slots_, kSlots, kNone); }

void TileGroups::clear() {
  for (const Group& group : groups_) slots_[group.slot] = kNone;
  groups_.clear();
  last_cluster_ = kNothing;
}

std::uint16_t TileGroups::group_of(std::uint32_t cluster) {
  std::uint32_t slot = first_slot<kSlots>(cluster);
  while (slots_[slot] != kNone && groups_[slots_[slot]].cluster != cluster)
    slot = (slot + 1) % kSlots;
  if (slots_[slot] == kNone) {
    slots_[slot] = static_cast<std::uint16_t>(groups_.size());
    Group& group = groups_.emplace_back();
    group.cluster = cluster;
    group.slot = static_cast<std::uint16_t>(slot);
  }
  return slots_[slot];
}

std::uint16_t TileGroups::add(std::uint32_t number) {
  if (const std::uint32_t cluster = number >> kClusterBits; cluster != last_cluster_) {
    last_cluster_ = cluster;
    last_group_ = group_of(cluster);
  }
  const std::uint32_t place = number % kClusterTriangles;
  groups_[last_group_].places[place / 64] |= std::uint64_t{1} << place % 64;
  return last_group_;
}

void TileGroups::number_triangles() {
  indices_.resize(groups_.size() * kClusterTriangles);
  places_.resize(kTilePixels);
  std::size_t size = 0;
  std::uint16_t* indices = indices_.data();
  for (Group& group : groups_) {
    group.first = static_cast<std::uint16_t>(size);
    for (std::uint32_t word = 0; word < kClusterTriangles / 64; ++word)
      for (std::uint64_t bits = group.places[word]; bits != 0; bits &= bits - 1) {
        const std::uint32_t place = word * 64 + static_cast<std::uint32_t>(std::countr_zero(bits));
        indices[place] = static_cast<std::uint16_t>(size);
        places_[size++] = static_cast<std::uint8_t>(place);
      }
    group.count = static_cast<std::uint16_t>(size - group.first);
    indices += kClusterTriangles;
  }
  places_.resize(size);
}

}  // namespace delray::raster
