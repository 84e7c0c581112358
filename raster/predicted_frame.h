// How long a simulated frame takes over a network, and where its busiest rank's time goes.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "comm/network.h"
#include "raster/simulated_frames.h"

namespace delray::raster {

// What a rank spends time on. estimate: bounding groups and sorting by tile. prepare: lists, images
// and all else between. redistribute: cutting the screen, primitives that travel. compose: pixels
// that are merged. waiting: for other ranks, before its part of the picture is done. gather: from
// then until rank 0 has the whole of it.
enum class Part : std::uint8_t {
  transform,
  estimate,
  rasterize,
  shade,
  prepare,
  redistribute,
  compose,
  waiting,
  gather,
};
inline constexpr int kParts = static_cast<int>(Part::gather) + 1;
const char* name(Part part);

// The time of a frame over a network, and where that of its busiest rank goes.
struct PredictedFrame {
  double seconds = 0;                  // until rank 0 has the picture
  int busiest = 0;                     // the rank that works longest before the gather
  std::array<double, kParts> parts{};  // of its time, indexed by Part; their sum is `seconds`
  double operator[](Part part) const { return parts[static_cast<std::size_t>(part)]; }
};

// Replays the frame over the network. O(log ranks) per event.
PredictedFrame predict(const SimulatedFrame& frame, const comm::Network& network);

// Seconds of drawing and what prepares it, by what is counted of a rank: for each frame,
// for each primitive that it has before any travel, for each triangle of the clusters that it looks
// at, for each that it rasterizes, and for each sample that it shades.
struct DrawingPrices {
  std::array<double, 5> seconds{};
};

// Fitted to all ranks of the frames by least squares of relative errors, no price below 0. Frames
// are of one strategy and one kind (at rest, turning). `primitives`: of the scene.
DrawingPrices fit_prices(std::span<const SimulatedFrame> frames, std::uint64_t primitives);

// What the prices foretell of a rank, one of `ranks`.
double drawing_seconds(const DrawingPrices& prices, const RankStatistics& rank, int ranks,
                       std::uint64_t primitives);

// Has ranks take for drawing what the prices say of their counts, but no longer than they took:
// thousands of ranks that take turns find nothing in the caches, and take longer than each would on
// a core of its own.
void apply_prices(const DrawingPrices& prices, std::uint64_t primitives, SimulatedFrame& frame);

}  // namespace delray::raster
