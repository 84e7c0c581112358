// Runs the ranks by turns on one thread and records their messages with the processor time between
// them (direct execution: Covington et al. 1988).
//
// Degenerate: ranks that only count composite masks of images, so that there the layers tell how
// long they would take; all else is timed.
#include "raster/simulated_frames.h"

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "comm/charged.h"
#include "comm/collectives.h"
#include "comm/recording.h"
#include "comm/simulated.h"
#include "files/memory_budget.h"
#include "parallel/arena.h"

namespace delray::raster {
namespace {

constexpr comm::Phase kTold[] = {comm::Phase::compose, comm::Phase::gather};

std::vector<double> drawing_of(const comm::Ledger& ledger) {
  std::vector<double> seconds;
  for (const std::vector<comm::Event>& events : ledger.ranks) {
    double& sum = seconds.emplace_back(0);
    for (const comm::Event& event : events) {
      if (event.kind == comm::Event::Kind::work && is_drawing(event.phase))
        sum += static_cast<double>(event.amount) * 1e-9;
    }
  }
  return seconds;
}

// Gives what was composited its price, so that ledgers hold nothing but seconds.
void price_pixels(comm::Ledger& ledger, double seconds_per_pixel) {
  for (std::vector<comm::Event>& events : ledger.ranks) {
    for (comm::Event& event : events) {
      if (event.kind != comm::Event::Kind::work || event.work == comm::Work::seconds_e9) continue;
      const double amount = event.work == comm::Work::pixels_composited
                                ? static_cast<double>(event.amount) * seconds_per_pixel * 1e9
                                : 0;  // within what is timed
      event.amount = static_cast<std::uint64_t>(amount + 0.5);
      event.work = comm::Work::seconds_e9;
    }
  }
}

}  // namespace

bool is_drawing(comm::Phase phase) {
  return phase == comm::Phase::transform || phase == comm::Phase::rasterize ||
         phase == comm::Phase::other;
}

SimulatedFrames simulate_frames(const FrameSequence& sequence, const RenderOptions& options,
                                int ranks, parallel::Progress* progress) {
  SimulatedFrames result;
  comm::SimulationOptions simulation;
  simulation.stack_bytes = std::size_t{8} << 20;  // renderers expect a thread's
  const bool counts = options.count_only && options.strategy == "sort-last";
  const std::span<const comm::Phase> told =
      counts ? std::span(kTold) : std::span<const comm::Phase>();
  parallel::Arena(1).execute([&] {
    comm::run_simulated(
        ranks, {}, 1,
        [&](comm::Communicator& communicator) {
          Renderer renderer(sequence.scene, sequence.shader);
          const bool root = communicator.rank() == 0;
          for (std::size_t i = 0; i < sequence.cameras.size(); ++i) {
            RenderOptions used = options;
            used.report_partition = i == 0;  // not for free
            std::vector<comm::Event> events;
            comm::Recording recording(communicator, events);
            comm::barrier(communicator);
            Result frame;
            {
              comm::Charged charged(recording, told);
              frame = renderer.render(charged, sequence.cameras[i], used, progress);
              charged.mark(comm::Phase::other, 0);  // what was done since the last message
            }
            comm::Ledger ledger = comm::gather_ledger(communicator, events);
            if (root) {
              if (counts) price_pixels(ledger, options.count_only->merge_covered);
              std::vector<double> drawing = drawing_of(ledger);
              result.frames.push_back(
                  {std::move(frame.statistics), std::move(ledger), std::move(drawing)});
            }
            if (root && i == sequence.shown)
              result.picture = std::move(frame.picture);
            else
              renderer.recycle(std::move(frame.picture));
          }
          comm::barrier(communicator);
          if (root) result.resident_bytes = files::resident_set();
          comm::barrier(communicator);
        },
        simulation);
  });
#ifdef __GLIBC__
  // The next run may be of another strategy, whose blocks do not fit into the gaps.
  malloc_trim(0);
#endif
  return result;
}

}  // namespace delray::raster
