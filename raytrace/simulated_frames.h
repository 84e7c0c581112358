// Frames of the ray tracer on the simulated machine: ranks that take turns on one thread, each in
// its own time, over a network.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "comm/network.h"
#include "raytrace/render.h"

namespace delray::raytrace {

// What a rank spends time on. trace: all of the processor's but what messages take. gather: from
// the end of the rank's tiles until rank 0 has the picture.
enum class FramePart : std::uint8_t { trace, messages, waiting, gather };
inline constexpr int kFrameParts = static_cast<int>(FramePart::gather) + 1;
const char* name(FramePart part);

// The time of a frame, and where that of its busiest rank goes.
struct SimulatedFrame {
  double seconds = 0;                       // until rank 0 has the picture
  int busiest = 0;                          // the rank that works longest before the gather
  std::array<double, kFrameParts> parts{};  // of its time, indexed by FramePart; their sum
  std::uint64_t bytes = 0, messages = 0, rays_sent = 0;  // of all ranks
  std::uint64_t clusters = 0;                            // of all ranks
  std::uint64_t tree_bytes = 0, geometry_bytes = 0;      // of the rank with most
  double test_imbalance = 1;  // most over mean of the rays that ranks intersected
};

// One camera's frame, a few times by the same ranks.
struct RepeatedFrame {
  const scenes::Scene& scene;
  const Tracer& tracer;  // of the scene
  const scenes::Camera& camera;
  const RenderOptions& options;
  int frames = 1;
  ShareOptions share = {};  // of distributions, but for what these say themselves
};

// Every rank's processor time is measured, and its messages take what the network says: what comes
// first there is what would. Schedules and distributions that go by what comes first differ from
// run to run, as they do on a real machine. Not the picture.
//
// REQUIRES: ranks, frames >= 1. Throws as Renderer::render does.
std::vector<SimulatedFrame> simulate_frames(const RepeatedFrame& repeated,
                                            const Distribution& distribution, int ranks,
                                            const comm::Network& network);

}  // namespace delray::raytrace
