#include "composite/internal/exchange.h"
#include "composite/internal/schemes.h"

namespace delray::composite::internal {

Part bus(comm::Communicator& communicator, std::unique_ptr<Layer> layer,
         const ComposeOptions& /*options*/) {
  const PixelRange all{0, layer->pixels()};
  const int rank = communicator.rank(), size = communicator.size();
  if (all.size() == 0) return {{}, std::move(layer)};
  for (int turn = 0; turn < size; ++turn) {
    if (rank > 0 && turn > rank) break;
    if (size > 1) communicator.mark(comm::Phase::compose, turn);
    if (turn == rank) {
      const comm::Buffer image = layer->cut(all);
      for (int to = rank + 1; to < size; ++to) communicator.send(to, kTagCompose, image.copy());
      if (rank > 0) communicator.send(0, kTagCompose, image.copy());
      continue;
    }
    const comm::Buffer pixels = communicator.receive(turn, kTagCompose);
    communicator.work(comm::Work::pixels_composited, rank == 0
                                                         ? layer->merge(all, pixels, Side::higher)
                                                         : layer->prune(all, pixels));
  }
  return part_of(rank == 0 ? all : PixelRange{}, std::move(layer));
}

}  // namespace delray::composite::internal
