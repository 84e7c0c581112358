// Sends and merges ranges message by message; direct-send within a group; binary swap as a sequence
// of exchanges of two. Degenerate: empty ranges send nothing, and groups of one return their range.
#include "composite/schemes/exchange.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace delray::composite::internal {
namespace {

void merge_message(comm::Communicator& communicator, Layer& layer, PixelRange pixels, int from) {
  const Side side = from < communicator.rank() ? Side::lower : Side::higher;
  const comm::Buffer message = communicator.receive(from, kTagCompose);
  communicator.work(comm::Work::pixels_composited, layer.merge(pixels, message, side));
}

}  // namespace

void send(comm::Communicator& communicator, Layer& layer, PixelRange range, int to,
          int samples_per_pixel) {
  for_each_message(range, samples_per_pixel, [&](PixelRange piece) {
    communicator.send(to, kTagCompose, layer.encode(piece));
  });
}

void merge(comm::Communicator& communicator, Layer& layer, PixelRange range, int from,
           int samples_per_pixel) {
  for_each_message(range, samples_per_pixel,
                   [&](PixelRange piece) { merge_message(communicator, layer, piece, from); });
}

// A few messages are sent ahead of those that are merged, not all: what is on its way between ranks
// of one machine is then still in its caches when it is merged.
PixelRange exchange(comm::Communicator& communicator, Layer& layer, PixelRange range,
                    const Group& group, int samples_per_pixel) {
  constexpr int kMessagesAhead = 8;  // of one rank to all others
  const int me = group.member_of(communicator.rank());
  const auto piece = [&](int i) { return piece_of(range, i, group.count, samples_per_pixel); };
  const PixelRange mine = piece(me);
  int most = 0;
  for (int member = 0; member < group.count; ++member) {
    most = std::max(most, messages_of(piece(member)));
  }
  const int ahead = std::max(1, kMessagesAhead / std::max(1, group.count - 1));
  for (int i = 0; i < most + ahead; ++i) {
    for_each_outwards(me, group.count, [&](int member) {
      const PixelRange pixels = message_of(piece(member), i, samples_per_pixel);
      if (pixels.size() == 0) return;
      communicator.send(group.rank_of(member), kTagCompose, layer.encode(pixels));
    });
    const PixelRange pixels =
        i < ahead ? PixelRange{} : message_of(mine, i - ahead, samples_per_pixel);
    if (pixels.size() == 0) continue;
    for_each_outwards(me, group.count, [&](int member) {
      merge_message(communicator, layer, pixels, group.rank_of(member));
    });
  }
  return mine;
}

PixelRange swap(comm::Communicator& members, Layer& layer, PixelRange range, int samples_per_pixel,
                int& round) {
  assert(std::has_single_bit(static_cast<unsigned>(members.size())));
  const int me = members.rank();
  for (int distance = 1; distance < members.size(); distance *= 2) {
    members.mark(comm::Phase::compose, round++);
    const Group pair{me & ~distance, distance, 2};
    range = exchange(members, layer, range, pair, samples_per_pixel);
  }
  return range;
}

PixelRange swapped_piece(PixelRange range, int member, int members, int samples_per_pixel) {
  for (int distance = 1; distance < members; distance *= 2) {
    range = half_of(range, member & distance ? 1 : 0, samples_per_pixel);
  }
  return range;
}

OwnedPixels part_of(PixelRange range, std::unique_ptr<Layer> layer) {
  if (range.size() == 0) return {{}, std::move(layer)};
  return {{range}, std::move(layer)};
}

}  // namespace delray::composite::internal
