// Every rank sends its whole image to rank 0, which merges them one after the other in rank order:
// one round, (n - 1) A pixels for rank 0 to receive and composite. Nothing is done in parallel.
// Degenerate: n = 1 sends nothing.
#include "composite/schemes/exchange.h"
#include "composite/schemes/schemes.h"

namespace delray::composite::internal {

OwnedPixels centralized(comm::Communicator& communicator, std::unique_ptr<Layer> layer,
                        const ComposeOptions& options) {
  const PixelRange all{0, layer->pixels()};
  communicator.mark(comm::Phase::compose, 0);
  if (communicator.rank() != 0) {
    send(communicator, *layer, all, 0, options.samples_per_pixel);
    return {{}, std::move(layer)};
  }
  for (int from = 1; from < communicator.size(); ++from)
    merge(communicator, *layer, all, from, options.samples_per_pixel);
  return part_of(all, std::move(layer));
}

}  // namespace delray::composite::internal
