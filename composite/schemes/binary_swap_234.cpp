// 2-3-4 binary swap (Nonaka, Ono and Fujita 2018) of n ranks and A pixels.
//
// Ranks form p / 2 groups of two, three or four neighbours, where p is the largest power of two up
// to n. All of a group send one half of the image to its first rank, the other to its second; those
// two then swap with their likes of other groups. floor(log2 n) rounds. A rank merges up to three
// halves in the first; third and fourth ranks own nothing.
//
// Degenerate: n = 1 has no round, n = 2 and 3 the first alone.
#include <bit>

#include "composite/schemes/exchange.h"
#include "composite/schemes/schemes.h"
#include "composite/schemes/sub_communicator.h"

namespace delray::composite::internal {

OwnedPixels binary_swap_234(comm::Communicator& communicator, std::unique_ptr<Layer> layer,
                            const ComposeOptions& options) {
  const PixelRange all{0, layer->pixels()};
  const int rank = communicator.rank(), size = communicator.size();
  if (size == 1) return part_of(all, std::move(layer));
  const int groups = static_cast<int>(std::bit_floor(static_cast<unsigned>(size))) / 2;
  const auto first_of = [&](int group) {
    return static_cast<int>(static_cast<std::int64_t>(group) * size / groups);
  };
  int group = static_cast<int>(static_cast<std::int64_t>(rank) * groups / size);
  if (rank >= first_of(group + 1)) ++group;
  const int first = first_of(group), count = first_of(group + 1) - first, me = rank - first;

  int round = 0;
  communicator.mark(comm::Phase::compose, round++);
  const auto half = [&](int i) { return half_of(all, i, options.samples_per_pixel); };
  for (const int owner : {0, 1}) {
    if (owner != me)
      send(communicator, *layer, half(owner), first + owner, options.samples_per_pixel);
  }
  if (me > 1) return {{}, std::move(layer)};
  for_each_outwards(me, count, [&](int member) {
    merge(communicator, *layer, half(me), first + member, options.samples_per_pixel);
  });

  std::vector<int> ranks;
  for (int i = 0; i < groups; ++i) ranks.push_back(first_of(i) + me);
  SubCommunicator members(communicator, std::move(ranks));
  const PixelRange mine = swap(members, *layer, half(me), options.samples_per_pixel, round);
  return part_of(mine, std::move(layer));
}

}  // namespace delray::composite::internal
