// Compositing up a binomial tree of n ranks, A pixels.
//
// In round i a rank whose lowest set bit is bit i sends its whole image to the rank without that
// bit, and is done; the other one merges it. Receivers have always merged an interval of ranks, so
// order is kept. ceil(log2 n) rounds; all but rank 0 send A, which composites A in each round,
// while ever fewer ranks work.
//
// Degenerate: n = 1 has no round; where n is no power of two, some ranks have no partner in a round
// and go on to the next.
#include "composite/schemes/exchange.h"
#include "composite/schemes/schemes.h"

namespace delray::composite::internal {

OwnedPixels tree(comm::Communicator& communicator, std::unique_ptr<Layer> layer,
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
