#include "composite/schemes/exchange.h"
#include "composite/schemes/schemes.h"

namespace delray::composite::internal {

Part direct_send(comm::Communicator& communicator, std::unique_ptr<Layer> layer,
                 const ComposeOptions& options) {
  communicator.mark(comm::Phase::compose, 0);
  const PixelRange mine = exchange(communicator, *layer, {0, layer->pixels()},
                                   {0, 1, communicator.size()}, options.samples_per_pixel);
  return part_of(mine, std::move(layer));
}

}  // namespace delray::composite::internal
