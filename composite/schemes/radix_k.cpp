// Radix-k (Peterka, Goodell, Ross, Shen and Thakur 2009): rounds of direct-send in groups of k
// ranks.
//
// Ranks are numbers in mixed radix: in each round those that differ in one digit exchange pieces of
// the range that all of them hold. Numbers of ranks with large factors leave some over, who send
// their pieces to a block of neighbours and own nothing. A member sends A (1 - 1/m) pixels and
// composites as much, of m members, and A / P for each extra rank of its block of P.
//
// Degenerate: of a power of two, radices of 2 give binary swap; one radix of n gives direct-send.
#include "composite/schemes/exchange.h"
#include "composite/schemes/radices.h"
#include "composite/schemes/schemes.h"
#include "composite/schemes/sub_communicator.h"

namespace delray::composite::internal {
namespace {

// The piece that a member of a block holds when its block is one group.
PixelRange piece_in_block(const Radices& radices, PixelRange range, int member,
                          int samples_per_pixel) {
  for (int round = 0; round < radices.joined_rounds; ++round) {
    const int k = radices.radices[static_cast<std::size_t>(round)];
    range = piece_of(range, member % k, k, samples_per_pixel);
    member /= k;
  }
  return range;
}

}  // namespace

OwnedPixels radix_k(comm::Communicator& communicator, std::unique_ptr<Layer> layer,
                    const ComposeOptions& options) {
  const int samples = options.samples_per_pixel;
  const Radices radices = choose_radices(communicator.size(), options.radices);
  const RadixPlace place = place_of(radices, communicator.rank());
  PixelRange range{0, layer->pixels()};
  if (place.member < 0) {
    communicator.mark(comm::Phase::compose, radices.joined_rounds - 1);
    for (int i = 0; i < radices.block(); ++i) {
      send(communicator, *layer, piece_in_block(radices, range, i, samples), place.first_rank + i,
           samples);
    }
    return {{}, std::move(layer)};
  }
  std::vector<int> ranks;
  for (int i = 0; i < radices.members; ++i) ranks.push_back(rank_of(radices, i));
  SubCommunicator members(communicator, std::move(ranks));
  const int me = members.rank();
  // SubCommunicator that differ only in the digits of earlier rounds are neighbours; `stride` of
  // them have been merged and hold the range's pieces.
  int stride = 1;
  for (int round = 0; round < static_cast<int>(radices.radices.size()); ++round) {
    const int k = radices.radices[static_cast<std::size_t>(round)];
    const Group group{me / (stride * k) * (stride * k) + me % stride, stride, k};
    communicator.mark(comm::Phase::compose, round);
    range = exchange(members, *layer, range, group, samples);
    stride *= k;
    if (round + 1 != radices.joined_rounds) continue;
    for (int i = 0; i < place.extra; ++i) {
      merge(communicator, *layer, range, place.first_rank + stride + i, samples);
    }
  }
  return part_of(range, std::move(layer));
}

}  // namespace delray::composite::internal
