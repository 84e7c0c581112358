// Direct-send (Hsu 1993): every rank owns an n-th of the image, which all others send it, in one
// round.
//
// A rank sends n - 1 messages and composites A (1 - 1/n) pixels. Degenerate: with fewer pixels than
// ranks some own nothing.
#include "composite/schemes/exchange.h"
#include "composite/schemes/schemes.h"

namespace delray::composite::internal {

OwnedPixels direct_send(comm::Communicator& communicator, std::unique_ptr<Layer> layer,
                        const ComposeOptions& options) {
  communicator.mark(comm::Phase::compose, 0);
  const PixelRange mine = exchange(communicator, *layer, {0, layer->pixels()},
                                   {0, 1, communicator.size()}, options.samples_per_pixel);
  return part_of(mine, std::move(layer));
}

}  // namespace delray::composite::internal
