// Binary swap (Ma, Painter, Hansen and Krogh 1994), folded: n ranks, A pixels, p the largest power
// of two up to n.
//
// In n - p pairs of neighbours the second sends its whole image to the first and is done. Among the
// p that are left, partners exchange halves of the range that both hold, and merge the half that
// they keep. log2 p rounds in which a rank sends and composites A (1 - 1/p), and one of A for
// pairs.
//
// Degenerate: a power of two has no pairs; with fewer pixels than ranks some own nothing.
#include <bit>

#include "composite/schemes/exchange.h"
#include "composite/schemes/schemes.h"
#include "composite/schemes/sub_communicator.h"

namespace delray::composite::internal {

OwnedPixels binary_swap_folded(comm::Communicator& communicator, std::unique_ptr<Layer> layer,
                               const ComposeOptions& options) {
  const PixelRange all{0, layer->pixels()};
  const int rank = communicator.rank(), size = communicator.size();
  const int kept = static_cast<int>(std::bit_floor(static_cast<unsigned>(size)));
  const int folded = size - kept;  // pairs (0, 1), (2, 3) ...
  int round = 0;
  if (folded > 0) communicator.mark(comm::Phase::compose, round++);
  if (rank < 2 * folded) {
    if (rank % 2 == 1) {
      send(communicator, *layer, all, rank - 1, options.samples_per_pixel);
      return {{}, std::move(layer)};
    }
    merge(communicator, *layer, all, rank + 1, options.samples_per_pixel);
  }
  std::vector<int> ranks;
  for (int i = 0; i < kept; ++i) ranks.push_back(i < folded ? 2 * i : i + folded);
  SubCommunicator members(communicator, std::move(ranks));
  const PixelRange mine = swap(members, *layer, all, options.samples_per_pixel, round);
  return part_of(mine, std::move(layer));
}

}  // namespace delray::composite::internal
