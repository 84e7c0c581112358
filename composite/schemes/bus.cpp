// Compositing on a medium that all ranks listen to (Cox and Hanrahan 1994).
//
// Ranks take turns in ascending order. One multicasts its image, rank 0 merges it, and later ranks
// forget what it hides before their own turn comes. n rounds; what is hidden by then does not
// travel.
//
// Degenerate: rank 0 sends too, for others to prune by, and owns all in the end.
#include <algorithm>
#include <numeric>
#include <vector>

#include "composite/schemes/exchange.h"
#include "composite/schemes/schemes.h"

namespace delray::composite::internal {

OwnedPixels bus(comm::Communicator& communicator, std::unique_ptr<Layer> layer,
                const ComposeOptions& options) {
  const PixelRange all{0, layer->pixels()};
  const int rank = communicator.rank(), size = communicator.size();
  std::vector<int> listeners(static_cast<std::size_t>(std::max(0, size - rank - 1)));
  std::iota(listeners.begin(), listeners.end(), rank + 1);
  if (rank > 0) listeners.push_back(0);
  for (int turn = 0; turn < size; ++turn) {
    if (rank > 0 && turn > rank) break;
    if (size > 1) communicator.mark(comm::Phase::compose, turn);
    for_each_message(all, options.samples_per_pixel, [&](PixelRange piece) {
      if (turn == rank) {
        communicator.multicast(listeners, kTagCompose, layer->encode(piece));
        return;
      }
      const comm::Buffer pixels = communicator.receive(turn, kTagCompose);
      communicator.work(
          comm::Work::pixels_composited,
          rank == 0 ? layer->merge(piece, pixels, Side::higher) : layer->prune(piece, pixels));
    });
  }
  return part_of(rank == 0 ? all : PixelRange{}, std::move(layer));
}

}  // namespace delray::composite::internal
