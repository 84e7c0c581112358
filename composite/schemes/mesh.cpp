// Compositing on a mesh of r x c ranks (Lee 1996), A pixels.
//
// Ranks of a column exchange strips of the image, then ranks of a row exchange regions of the
// strip. In round s a rank sends to the s-th after it in the ring, so that each has one message a
// round: r + c - 2 rounds, A (1 - 1/n) pixels for a rank to send and to composite. Pieces of higher
// ranks wait until those of lower ones are merged, for a rank merges neighbouring intervals of
// ranks only.
//
// Degenerate: the mesh has as many columns as the nearest divisor of n to the wish; of a prime, one
// or n.
#include <cmath>
#include <utility>
#include <vector>

#include "composite/schemes/exchange.h"
#include "composite/schemes/schemes.h"

namespace delray::composite::internal {
namespace {

// The divisor of `ranks` that is nearest to `wished`, the smaller of two.
int nearest_divisor(int ranks, double wished) {
  int best = 1;
  for (int i = 2; i <= ranks; ++i) {
    if (ranks % i == 0 && std::abs(i - wished) < std::abs(best - wished)) best = i;
  }
  return best;
}

// exchange() with one message a round, in a ring: in round s a rank sends to the s-th after it.
PixelRange exchange_in_rounds(comm::Communicator& communicator, Layer& layer, PixelRange range,
                              const Group& group, int samples_per_pixel, int& round) {
  const int me = group.member_of(communicator.rank()), count = group.count;
  const auto piece = [&](int i) { return piece_of(range, i, count, samples_per_pixel); };
  const PixelRange mine = piece(me);
  std::vector<std::vector<comm::Buffer>>
      later;  // of members count - 1 and down, to be merged from me + 1 up
  for (int step = 1; step < count; ++step) {
    communicator.mark(comm::Phase::compose, round++);
    const int to = (me + step) % count, from = (me - step + count) % count;
    send(communicator, layer, piece(to), group.rank_of(to), samples_per_pixel);
    if (from < me) {
      merge(communicator, layer, mine, group.rank_of(from), samples_per_pixel);
    } else {
      later.emplace_back();
      for_each_message(mine, samples_per_pixel, [&](PixelRange) {
        later.back().push_back(communicator.receive(group.rank_of(from), kTagCompose));
      });
    }
  }
  for (; !later.empty(); later.pop_back()) {
    std::size_t next = 0;
    for_each_message(mine, samples_per_pixel, [&](PixelRange range_of_message) {
      const comm::Buffer& pixels = later.back()[next++];
      communicator.work(comm::Work::pixels_composited,
                        layer.merge(range_of_message, pixels, Side::higher));
    });
  }
  return mine;
}

}  // namespace

OwnedPixels mesh(comm::Communicator& communicator, std::unique_ptr<Layer> layer,
                 const ComposeOptions& options) {
  const int rank = communicator.rank(), size = communicator.size();
  const int columns = nearest_divisor(
      size, options.radices.empty() ? std::sqrt(static_cast<double>(size)) : options.radices[0]);
  const int rows = size / columns;
  const PixelRange all{0, layer->pixels()};
  int round = 0;
  const Group column{rank / rows * rows, 1, rows}, row{rank % rows, rows, columns};
  const PixelRange strip =
      exchange_in_rounds(communicator, *layer, all, column, options.samples_per_pixel, round);
  const PixelRange region =
      exchange_in_rounds(communicator, *layer, strip, row, options.samples_per_pixel, round);
  return part_of(region, std::move(layer));
}

}  // namespace delray::composite::internal
