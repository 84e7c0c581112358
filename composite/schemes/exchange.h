// Building blocks of schemes: sending a range, merging one, and the direct exchange in a group.
#pragma once

#include <cassert>

#include "comm/communicator.h"
#include "composite/layer.h"
#include "composite/schemes/range.h"

namespace delray::composite::internal {

// A range travels in pieces of so many pixels or a few more, each a message: they stay in the cache
// from being cut until they are on their way, and the other end merges one while the next is cut.
// (Measured between two MPI processes: half the time of one message.)
inline constexpr std::uint64_t kPixelsOfMessage = std::uint64_t{1} << 16;

inline int messages_of(PixelRange range) {
  return range.size() == 0 ? 0 : static_cast<int>(range.size() / kPixelsOfMessage) + 1;
}
// The pixels of message i; none from messages_of(range) on, and before where there are fewer pixels
// than messages.
inline PixelRange message_of(PixelRange range, int i, int samples_per_pixel) {
  const int count = messages_of(range);
  return i < count ? piece_of(range, i, count, samples_per_pixel) : PixelRange{};
}

template <class F>
void for_each_message(PixelRange range, int samples_per_pixel, F&& f) {
  for (int i = 0; i < messages_of(range); ++i) {
    if (const PixelRange piece = message_of(range, i, samples_per_pixel); piece.size() > 0) {
      f(piece);
    }
  }
}

// An empty range is neither sent nor waited for.
void send(comm::Communicator& communicator, Layer& layer, PixelRange range, int to,
          int samples_per_pixel);
void merge(comm::Communicator& communicator, Layer& layer, PixelRange range, int from,
           int samples_per_pixel);

// Calls f(i) for all i of [0, count) but `me`, from `me` outwards: me - 1, me + 1, me - 2 ... A
// rank that merges in this order always has merged an interval of ranks.
template <class F>
void for_each_outwards(int me, int count, F&& f) {
  for (int distance = 1; distance < count; ++distance) {
    if (me - distance >= 0) f(me - distance);
    if (me + distance < count) f(me + distance);
  }
}

// Ranks first, first + stride, ...: each stands for an interval of ranks, one after the other.
struct Group {
  int first = 0, stride = 1, count = 1;
  int rank_of(int member) const { return first + member * stride; }
  int member_of(int rank) const {
    assert((rank - first) % stride == 0);
    return (rank - first) / stride;
  }
};

// Every member sends every other its piece of `range`, which all of them hold, and merges its own,
// which is returned. One round.
PixelRange exchange(comm::Communicator& communicator, Layer& layer, PixelRange range,
                    const Group& group, int samples_per_pixel);

// The group's range is in as many hands as there are members of a communicator, a power of two:
// binary swap. Marks the rounds from `round` on, which is left at the next; returns the piece of
// the range that this rank owns, which is swapped_piece of it.
PixelRange swap(comm::Communicator& members, Layer& layer, PixelRange range, int samples_per_pixel,
                int& round);
PixelRange swapped_piece(PixelRange range, int member, int members, int samples_per_pixel);

// A part that consists of one range, or of none if that is empty.
OwnedPixels part_of(PixelRange range, std::unique_ptr<Layer> layer);

}  // namespace delray::composite::internal
