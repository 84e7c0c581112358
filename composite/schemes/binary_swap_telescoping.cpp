// Binary swap (Ma, Painter, Hansen and Krogh 1994) in groups of 2^k ranks (Moreland, Kendall,
// Peterka and Huang 2011).
//
// The first group is the largest power of two up to n, the next one that of what is left, and so
// on. Each swaps on its own; then each, from the smallest, sends the pieces that its members hold
// to the members of the next larger group that hold the same pixels. The largest group, of p, takes
// log2 p rounds and one to merge what the next one sends.
//
// Degenerate: a power of two is one group.
#include <bit>
#include <numeric>

#include "composite/schemes/exchange.h"
#include "composite/schemes/schemes.h"
#include "composite/schemes/sub_communicator.h"

namespace delray::composite::internal {
namespace {

// Ranks first <= i < first + count, a power of two.
struct PowerGroup {
  int first = 0, count = 0;
  int rounds() const { return std::bit_width(static_cast<unsigned>(count)) - 1; }
};

// The group that follows the ranks before `first`; of 0 ranks at the end.
PowerGroup group_after(int first, int ranks) {
  return {first, first < ranks
                     ? static_cast<int>(std::bit_floor(static_cast<unsigned>(ranks - first)))
                     : 0};
}

}  // namespace

OwnedPixels binary_swap_telescoping(comm::Communicator& communicator, std::unique_ptr<Layer> layer,
                                    const ComposeOptions& options) {
  const int samples = options.samples_per_pixel, rank = communicator.rank();
  const PixelRange all{0, layer->pixels()};
  PowerGroup before, own = group_after(0, communicator.size());
  while (rank >= own.first + own.count) {
    before = own;
    own = group_after(own.first + own.count, communicator.size());
  }
  const PowerGroup after = group_after(own.first + own.count, communicator.size());

  std::vector<int> ranks(static_cast<std::size_t>(own.count));
  std::iota(ranks.begin(), ranks.end(), own.first);
  SubCommunicator members(communicator, std::move(ranks));
  int round = 0;
  const PixelRange mine = swap(members, *layer, all, samples, round);

  // The pieces of member i of a group lie in that of member i % count of a smaller one, because the
  // lowest bits of a member's number decide first.
  if (after.count > 0) {
    communicator.mark(comm::Phase::compose, own.rounds());
    merge(communicator, *layer, mine, after.first + members.rank() % after.count, samples);
  }
  if (before.count == 0) return part_of(mine, std::move(layer));
  communicator.mark(comm::Phase::compose, before.rounds());
  for (int i = members.rank(); i < before.count; i += own.count) {
    send(communicator, *layer, swapped_piece(all, i, before.count, samples), before.first + i,
         samples);
  }
  return {{}, std::move(layer)};
}

}  // namespace delray::composite::internal
