// Has the simulated machine draw a first frame, frames at rest, and frames of a turntable, and
// replays what it recorded over a network.
#include "apps/compare/simulated_frames.h"

#include <algorithm>

#include "comm/replay.h"
#include "scenes/camera_path.h"

namespace delray::apps {
namespace {

constexpr int kAround = 60;  // frames of a turntable: six degrees each

}  // namespace

SimulatedFrames simulate_frames(const Prepared& prepared, const raster::RenderOptions& options,
                                int ranks, const FrameCounts& counts,
                                parallel::Progress* progress) {
  const auto at_rest = static_cast<std::size_t>(counts.at_rest);
  std::vector<scenes::Camera> cameras(1 + at_rest, prepared.camera);
  const std::vector<scenes::Camera> around = scenes::turntable(prepared.camera, kAround);
  for (int i = 1; i <= counts.turning; ++i)
    cameras.push_back(around[static_cast<std::size_t>(i % kAround)]);
  raster::SimulatedFrames simulated = raster::simulate_frames(
      {prepared.scene, prepared.shader, cameras, at_rest}, options, ranks, progress);
  SimulatedFrames result;
  auto frame = std::make_move_iterator(simulated.frames.begin());
  result.first = *frame++;
  result.next.assign(frame, frame + counts.at_rest);
  result.turning.assign(frame + counts.at_rest, std::make_move_iterator(simulated.frames.end()));
  result.picture = std::get<image::Image8>(std::move(simulated.picture));
  result.resident_bytes = simulated.resident_bytes;
  return result;
}

double seconds_over(const raster::SimulatedFrame& frame, const comm::Network& network) {
  const std::vector<double> ends = comm::replay(frame.ledger, network);
  return *std::max_element(ends.begin(), ends.end());
}

Spread seconds_over(std::span<const raster::SimulatedFrame> frames, const comm::Network& network) {
  std::vector<double> seconds;
  for (const raster::SimulatedFrame& frame : frames)
    seconds.push_back(seconds_over(frame, network));
  return spread_of(std::move(seconds));
}

}  // namespace delray::apps
