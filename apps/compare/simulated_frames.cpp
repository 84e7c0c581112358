// Runs the ranks of the rasterizer by turns on one thread, records their messages with the
// processor time between them, and replays the record over a network.
#include "apps/compare/simulated_frames.h"

#include <algorithm>

#include "comm/charged.h"
#include "comm/collectives.h"
#include "comm/recording.h"
#include "comm/replay.h"
#include "comm/simulated.h"
#include "parallel/arena.h"

namespace delray::apps {

SimulatedFrames simulate_frames(const Prepared& prepared, const raster::RenderOptions& options,
                                int ranks, int repeats, parallel::Progress* progress) {
  SimulatedFrames result;
  comm::SimulationOptions simulation;
  simulation.stack_bytes = std::size_t{8} << 20;  // renderers expect a thread's
  parallel::Arena(1).execute([&] {
    comm::run_simulated(
        ranks, {}, 1,
        [&](comm::Communicator& communicator) {
          raster::Renderer renderer(prepared.scene, prepared.shader);
          const bool root = communicator.rank() == 0;
          for (int repeat = 0; repeat <= repeats; ++repeat) {
            raster::RenderOptions used = options;
            used.report_partition = repeat == 0;  // not for free
            std::vector<comm::Event> events;
            comm::Recording recording(communicator, events);
            comm::barrier(communicator);
            raster::Result frame;
            {
              comm::Charged charged(recording);
              frame = renderer.render(charged, prepared.camera, used, progress);
              charged.mark(comm::Phase::other, 0);  // what was done since the last message
            }
            comm::Ledger ledger = comm::gather_ledger(communicator, events);
            if (root) {
              SimulatedFrame& simulated = repeat == 0 ? result.first : result.next.emplace_back();
              simulated = {std::move(frame.statistics), std::move(ledger)};
            }
            if (root && repeat == repeats)
              result.picture = std::get<image::Image8>(std::move(frame.picture));
            else
              renderer.recycle(std::move(frame.picture));
          }
        },
        simulation);
  });
  return result;
}

double seconds_over(const SimulatedFrame& frame, const comm::Network& network) {
  const std::vector<double> ends = comm::replay(frame.ledger, network);
  return *std::max_element(ends.begin(), ends.end());
}

Spread seconds_over(std::span<const SimulatedFrame> frames, const comm::Network& network) {
  std::vector<double> seconds;
  for (const SimulatedFrame& frame : frames) seconds.push_back(seconds_over(frame, network));
  return spread_of(std::move(seconds));
}

}  // namespace delray::apps
