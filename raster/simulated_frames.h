// Frames of the rasterizer on the simulated machine: ranks that take turns on one thread of this
// process, each in its own time. What a rank does is measured as if it had a core of its own, and
// its messages are recorded, to be replayed over any network (predicted_frame.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "comm/ledger.h"
#include "raster/render.h"

namespace delray::raster {

// Frames of a scene, one after the other by the same renderers.
struct FrameSequence {
  const scenes::Scene& scene;
  std::shared_ptr<const shading::Shader> shader;
  std::span<const scenes::Camera> cameras;  // of frame i
  std::size_t shown = 0;                    // the frame whose picture is kept
};

// A frame that was drawn, and all that its ranks did and sent.
struct SimulatedFrame {
  Statistics statistics;
  comm::Ledger ledger;
  // By rank: seconds of processor time in the ledger's phases of drawing.
  std::vector<double> drawing = {};
};

// Whether ranks draw in this phase, or prepare it: what depends on the shares that they have.
bool is_drawing(comm::Phase phase);

// Frames of one run.
struct SimulatedFrames {
  std::vector<SimulatedFrame> frames;  // of camera i; the partition is reported for the first
  Picture picture;                     // of size 0 where ranks only count (RenderOptions)
  std::uint64_t resident_bytes = 0;    // of the process, with all that renderers remember
};

// Runs the strategy's own code by so many ranks. Every rank keeps what a renderer keeps from frame
// to frame: with sort-last an image of the frame, unless ranks only count.
//
// REQUIRES: ranks >= 1; there are cameras; sequence.shown < sequence.cameras.size(). Throws as
// Renderer::render does.
SimulatedFrames simulate_frames(const FrameSequence& sequence, const RenderOptions& options,
                                int ranks, parallel::Progress* progress);

}  // namespace delray::raster
