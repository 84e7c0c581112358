// Pixels on their way from the ranks that made them to those that show them.
#pragma once

#include <cstddef>
#include <span>

#include "comm/communicator.h"
#include "loadbalance/partition.h"

namespace delray::loadbalance {

// The pixels of a rectangle of the frame in somebody's memory, row by row, `stride` pixels from one
// row to the next.
template <class Byte, class Float>
struct BasicPixels {
  geometry::Rect rect;
  Byte* colour = nullptr;
  Float* depth = nullptr;
  std::size_t stride = 0;
};
using Pixels = BasicPixels<const std::byte, const float>;
using PixelsToSet = BasicPixels<std::byte, float>;

// Sets what this rank shows by what all ranks have: `mine` are disjoint over all ranks, `displays`,
// the same on all of them, say whose each part of the frame is, and `shown` is the memory of those
// that are this rank's, in that order. A colour has `colour_bytes` bytes. A rank sends at most one
// message to each other: a pixel and its depth travel once, and 20 bytes for each part of a
// rectangle that does. Pixels of displays that nobody has stay as they are. Collective.
void deliver(comm::Communicator& communicator, std::span<const Pixels> mine,
             std::size_t colour_bytes, std::span<const Region> displays,
             std::span<const PixelsToSet> shown);

}  // namespace delray::loadbalance
