#include "composite/internal/exchange.h"

#include <bit>
#include <utility>

namespace delray::composite::internal {

void send(comm::Communicator& communicator, Layer& layer, PixelRange range, int to,
          int samples_per_pixel) {
  for_each_message(range, samples_per_pixel,
                   [&](PixelRange piece) { communicator.send(to, kTagCompose, layer.cut(piece)); });
}

void merge(comm::Communicator& communicator, Layer& layer, PixelRange range, int from,
           int samples_per_pixel) {
  const Side side = from < communicator.rank() ? Side::lower : Side::higher;
  for_each_message(range, samples_per_pixel, [&](PixelRange piece) {
    const comm::Buffer pixels = communicator.receive(from, kTagCompose);
    communicator.work(comm::Work::pixels_composited, layer.merge(piece, pixels, side));
  });
}

PixelRange exchange(comm::Communicator& communicator, Layer& layer, PixelRange range,
                    const Group& group, int samples_per_pixel) {
  const int me = group.member_of(communicator.rank());
  const auto piece = [&](int i) { return piece_of(range, i, group.count, samples_per_pixel); };
  for_each_outwards(me, group.count, [&](int member) {
    send(communicator, layer, piece(member), group.rank_of(member), samples_per_pixel);
  });
  for_each_outwards(me, group.count, [&](int member) {
    merge(communicator, layer, piece(me), group.rank_of(member), samples_per_pixel);
  });
  return piece(me);
}

PixelRange swap(comm::Communicator& members, Layer& layer, PixelRange range, int samples_per_pixel,
                int& round) {
  assert(std::has_single_bit(static_cast<unsigned>(members.size())));
  const int me = members.rank();
  for (int distance = 1; distance < members.size(); distance *= 2) {
    members.mark(comm::Phase::compose, round++);
    const int kept = me & distance ? 1 : 0;
    send(members, layer, half_of(range, 1 - kept, samples_per_pixel), me ^ distance,
         samples_per_pixel);
    range = half_of(range, kept, samples_per_pixel);
    merge(members, layer, range, me ^ distance, samples_per_pixel);
  }
  return range;
}

PixelRange swapped_piece(PixelRange range, int member, int members, int samples_per_pixel) {
  for (int distance = 1; distance < members; distance *= 2) {
    range = half_of(range, member & distance ? 1 : 0, samples_per_pixel);
  }
  return range;
}

Part part_of(PixelRange range, std::unique_ptr<Layer> layer) {
  if (range.size() == 0) return {{}, std::move(layer)};
  return {{range}, std::move(layer)};
}

}  // namespace delray::composite::internal
