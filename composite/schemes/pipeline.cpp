// Compositing down a chain of ranks, in pieces (PixelFlow: Molnar, Eyles and Poulton 1992).
//
// A rank merges a piece that comes from the next higher rank into its own and sends the result to
// the next lower one, while the higher one works on the piece after it. n - 2 + P rounds for P
// pieces; all but the last rank composite A.
//
// Degenerate: an image below two pieces' worth of pixels travels whole, and ranks work one after
// the other.
#include "composite/schemes/exchange.h"
#include "composite/schemes/schemes.h"

namespace delray::composite::internal {
namespace {

// A piece that takes far longer than a message without bytes, and enough pieces to keep ranks busy.
constexpr std::uint64_t kPixelsOfPiece = 1 << 16;
constexpr std::uint64_t kMostPieces = 64;

}  // namespace

OwnedPixels pipeline(comm::Communicator& communicator, std::unique_ptr<Layer> layer,
                     const ComposeOptions& options) {
  const PixelRange all{0, layer->pixels()};
  const int rank = communicator.rank(), last = communicator.size() - 1;
  const int pieces =
      static_cast<int>(std::clamp<std::uint64_t>(all.size() / kPixelsOfPiece, 1, kMostPieces));
  for (int i = 0; i < pieces; ++i) {
    const PixelRange piece = piece_of(all, i, pieces, options.samples_per_pixel);
    const int round = i + last - 1 - rank;  // in which the piece comes here
    if (rank < last) {
      communicator.mark(comm::Phase::compose, round);
      merge(communicator, *layer, piece, rank + 1, options.samples_per_pixel);
    }
    if (rank > 0) {
      communicator.mark(comm::Phase::compose, round + 1);
      send(communicator, *layer, piece, rank - 1, options.samples_per_pixel);
    }
  }
  return part_of(rank == 0 ? all : PixelRange{}, std::move(layer));
}

}  // namespace delray::composite::internal
