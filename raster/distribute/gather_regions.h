// Bringing the regions of many ranks together.
#pragma once

#include <span>
#include <vector>

#include "comm/communicator.h"
#include "image/image.h"
#include "loadbalance/partition.h"

namespace delray::raster {

// What is known of the tiles of an image; spans that are empty: nothing, and it is looked at.
struct ImageTiles {
  int side = 0, columns = 0;            // in pixels; in tiles
  std::span<const std::uint8_t> empty;  // by tile: this rank's parts of it show nothing
  std::span<std::uint8_t> clear;  // by tile: none of its pixels shows anything; kept up to date
};

// Copies every region of the partition from its owner's image to rank 0's; all images have the size
// of the frame. Collective. Each pixel that rank 0 does not own is sent once, but those of parts of
// tiles that are empty not at all.
template <class Colour>
void gather_regions(comm::Communicator& communicator, const loadbalance::Partition& partition,
                    const ImageTiles& tiles, image::BasicImage<Colour>& image);

// The pictures of the displays that this rank owns, in their order, of every region from its
// owner's image; an image may be of size 0 where a rank owns no region. See loadbalance/deliver.h.
// Collective.
template <class Colour>
std::vector<image::BasicImage<Colour>> deliver_regions(
    comm::Communicator& communicator, const loadbalance::Partition& partition,
    const image::BasicImage<Colour>& image, std::span<const loadbalance::Region> displays);

}  // namespace delray::raster
