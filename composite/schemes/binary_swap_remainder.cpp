// Binary swap (Ma, Painter, Hansen and Krogh 1994) where an odd rank joins the last pair (Moreland
// 2018; the 3-2 elimination of Rabenseifner and Traeff 2004).
//
// In each round partners exchange halves of the range that both hold. Where the number of ranks
// with the same range is odd, the last one sends a half to either of the pair before it, and is
// done. floor(log2 n) rounds; ranks that swap to the end send about as much as with a power of two.
//
// Degenerate: n = 1 has no round; a power of two has no odd ranks.
#include "composite/schemes/exchange.h"
#include "composite/schemes/schemes.h"

namespace delray::composite::internal {

OwnedPixels binary_swap_remainder(comm::Communicator& communicator, std::unique_ptr<Layer> layer,
                                  const ComposeOptions& options) {
  const int samples = options.samples_per_pixel;
  PixelRange range{0, layer->pixels()};
  // The ranks that hold the same range, in ascending order of the intervals they have merged; at
  // first all ranks. After a round member i / 2 of either half is what was member i.
  std::vector<int> ranks(static_cast<std::size_t>(communicator.size()));
  for (std::size_t i = 0; i < ranks.size(); ++i) ranks[i] = static_cast<int>(i);
  int me = communicator.rank(), round = 0;
  while (ranks.size() > 1) {
    communicator.mark(comm::Phase::compose, round++);
    const int size = static_cast<int>(ranks.size());
    const auto rank_of = [&](int member) { return ranks[static_cast<std::size_t>(member)]; };
    if (size % 2 == 1 && me == size - 1) {
      for (const int half : {0, 1}) {
        send(communicator, *layer, half_of(range, half, samples), rank_of(size - 3 + half),
             samples);
      }
      return {{}, std::move(layer)};
    }
    const int kept = me % 2;
    send(communicator, *layer, half_of(range, 1 - kept, samples), rank_of(me ^ 1), samples);
    range = half_of(range, kept, samples);
    merge(communicator, *layer, range, rank_of(me ^ 1), samples);
    if (size % 2 == 1 && me >= size - 3)
      merge(communicator, *layer, range, rank_of(size - 1), samples);
    for (int i = 0; i < size / 2; ++i) {
      ranks[static_cast<std::size_t>(i)] = rank_of(2 * i + kept);
    }
    ranks.resize(static_cast<std::size_t>(size / 2));
    me /= 2;
  }
  return part_of(range, std::move(layer));
}

}  // namespace delray::composite::internal
