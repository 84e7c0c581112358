#include "composite/schemes/exchange.h"
#include "composite/schemes/schemes.h"

namespace delray::composite::internal {

Part tree(comm::Communicator& communicator, std::unique_ptr<Layer> layer,
          const ComposeOptions& options) {
  const PixelRange all{0, layer->pixels()};
  const int rank = communicator.rank();
  int round = 0;
  for (int distance = 1; distance < communicator.size(); distance *= 2) {
    communicator.mark(comm::Phase::compose, round++);
    if (rank & distance) {
      send(communicator, *layer, all, rank - distance, options.samples_per_pixel);
      return {{}, std::move(layer)};
    }
    if (rank + distance < communicator.size()) {
      merge(communicator, *layer, all, rank + distance, options.samples_per_pixel);
    }
  }
  return part_of(all, std::move(layer));
}

}  // namespace delray::composite::internal
