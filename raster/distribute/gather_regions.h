// Bringing the regions of many ranks together.
#pragma once

#include <span>

#include "comm/communicator.h"
#include "image/image.h"
#include "loadbalance/partition.h"

namespace delray::raster {

// Copies every region of the partition from its owner's image to rank 0's; all images have the size
// of the frame. Collective. Each pixel that rank 0 does not own is sent once.
template <class Colour>
void gather_regions(comm::Communicator& communicator, const loadbalance::Partition& partition,
                    image::BasicImage<Colour>& image);

}  // namespace delray::raster
