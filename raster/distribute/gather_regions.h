// Bringing the regions of many ranks together.
#pragma once

#include <span>
#include <vector>

#include "comm/communicator.h"
#include "image/image.h"
#include "loadbalance/partition.h"

namespace delray::raster {

// Copies every region of the partition from its owner's image to rank 0's; all images have the size
// of the frame. Collective. Each pixel that rank 0 does not own is sent once.
template <class Colour>
void gather_regions(comm::Communicator& communicator, const loadbalance::Partition& partition,
                    image::BasicImage<Colour>& image);

// The pictures of the displays that this rank owns, in their order, of every region from its
// owner's image; an image may be of size 0 where a rank owns no region. See loadbalance/deliver.h.
// Collective.
template <class Colour>
std::vector<image::BasicImage<Colour>> deliver_regions(
    comm::Communicator& communicator, const loadbalance::Partition& partition,
    const image::BasicImage<Colour>& image, std::span<const loadbalance::Region> displays);

}  // namespace delray::raster
