// An image in another order of its pixels, so that every piece of it has something of everywhere.
#pragma once

#include <memory>

#include "composite/layer.h"

namespace delray::composite {

// Schemes give each rank a run of pixels; where the picture is in the middle of the image, those
// with the middle have the work. This layer, which schemes see in place of `layer`, assigns pieces
// of the image to `parts` sets in turn and orders them set by set: an equal run for each of as many
// ranks has a piece of every place (Moreland, Kendall, Peterka and Huang 2011).
//
// An encoded range is the pieces' messages one after the other, each after a u64 that tells its
// size and padded to a multiple of 8 bytes. Costs a copy of what travels, on either side.
//
// REQUIRES: parts >= 1; all ranks interlace alike.
std::unique_ptr<Layer> interlace(std::unique_ptr<Layer> layer, int parts, int samples_per_pixel);

// The part in the image's own order, of the layer that interlace was given. REQUIRES: the part's
// layer is one that interlace gave.
OwnedPixels deinterlace(OwnedPixels&& part);

}  // namespace delray::composite
