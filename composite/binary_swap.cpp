#include <bit>

#include "composite/internal/range.h"
#include "composite/internal/schemes.h"

namespace delray::composite::internal {
namespace {

// Who swaps: `count` members, a power of two, numbered in ascending order of their ranks. The first
// `folded` of them stand for the pairs of ranks (0, 1), (2, 3) ...; the others for one rank each.
struct Members {
  int count = 1, folded = 0;
  int rank_of(int member) const { return member < folded ? 2 * member : member + folded; }
};

Members members_of(int ranks) {
  const int count = static_cast<int>(std::bit_floor(static_cast<unsigned>(ranks)));
  return {count, ranks - count};
}

void merge(comm::Communicator& communicator, Layer& layer, PixelRange range, int from) {
  const comm::Buffer pixels = communicator.receive(from, kTagCompose);
  const Side side = from < communicator.rank() ? Side::lower : Side::higher;
  communicator.work(comm::Work::pixels_composited, layer.merge(range, pixels, side));
}

}  // namespace

Part binary_swap(comm::Communicator& communicator, std::unique_ptr<Layer> layer,
                 const ComposeOptions& options) {
  const Members members = members_of(communicator.size());
  const int rank = communicator.rank();
  PixelRange range{0, layer->pixels()};
  if (range.size() == 0) return {{}, std::move(layer)};

  int round = 0, member = rank - members.folded;
  if (members.folded > 0) communicator.mark(comm::Phase::compose, round++);
  if (rank < 2 * members.folded) {
    member = rank / 2;
    if (rank % 2 == 1) {
      communicator.send(rank - 1, kTagCompose, layer->cut(range));
      return {{}, std::move(layer)};
    }
    merge(communicator, *layer, range, rank + 1);
  }

  for (int distance = 1; distance < members.count; distance *= 2) {
    communicator.mark(comm::Phase::compose, round++);
    const int partner = members.rank_of(member ^ distance);
    const int kept = member & distance ? 1 : 0;
    const PixelRange given = half_of(range, 1 - kept, options.samples_per_pixel);
    range = half_of(range, kept, options.samples_per_pixel);
    if (given.size() > 0) communicator.send(partner, kTagCompose, layer->cut(given));
    if (range.size() > 0) merge(communicator, *layer, range, partner);
  }
  if (range.size() == 0) return {{}, std::move(layer)};
  return {{range}, std::move(layer)};
}

}  // namespace delray::composite::internal
