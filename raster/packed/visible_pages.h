// Which pages of a pack a frame may show.
#pragma once

#include <cstdint>
#include <vector>

#include "raster/distribute/rank_context.h"
#include "raster/packed/packed_scene.h"

namespace delray::raster {

// A page placed by an instance.
struct PlacedPage {
  std::uint32_t instance = 0, page = 0;
  geometry::Rect pixels;  // of the screen, in samples, that it may touch
  float nearest = -1;     // depth at least
  // What is added to the radius of its points, in their units (Draw::widening): they stand for
  // others, which are so far from them at most. 0 for triangles and where errors are not allowed.
  float widening = 0;
  // Of its row in the table, which is large.
  std::uint32_t bytes_in_memory = 0;
  std::uint16_t triangles = 0;
  std::uint8_t clusters = 0, level = 0;
};

// Those that are not outside of the view, nor show hidden sides only, as far as boxes and cones
// tell; ascending by instance and page, that is by primitives. The same on all ranks. O(pages that
// are not left out by boxes of many).
std::vector<PlacedPage> visible_pages(const RankContext& rank, const PackedScene& packed);

// The part of them that one of several ranks draws: neighbours, with about as many triangles as
// each.
std::vector<PlacedPage> share_of_pages(std::vector<PlacedPage>&& pages, int rank, int ranks);

}  // namespace delray::raster
