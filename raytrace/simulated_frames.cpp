// Direct execution (Covington et al. 1988) of the renderer's own code; events of a rank tell where
// its virtual time goes.
//
// Degenerate: a single rank sends nothing, and its frame is all tracing but for the copies of the
// end.
#include "raytrace/simulated_frames.h"

#include <algorithm>
#include <optional>

#include "comm/charged.h"
#include "comm/collectives.h"
#include "comm/recording.h"
#include "comm/simulated.h"
#include "parallel/arena.h"

namespace delray::raytrace {
namespace {

// A rank's virtual time in a frame.
struct RankTime {
  double begin = 0, gather = 0, end = 0;  // when the frame, its gather, and both end
  double work = 0, messages = 0;          // seconds before the gather
  std::uint64_t bytes_sent = 0, messages_sent = 0, rays_sent = 0;
  std::uint64_t tests = 0, clusters = 0, tree_bytes = 0, geometry_bytes = 0;
};

void add(const comm::Event& event, int self, const comm::Network& network, RankTime& time) {
  using Kind = comm::Event::Kind;
  if (event.kind == Kind::mark) {
    if (event.phase == comm::Phase::gather) time.gather = event.end;
    return;
  }
  const bool is_message = event.kind != Kind::work && event.peer != self;
  if (is_message && event.kind == Kind::send) {
    time.bytes_sent += event.amount;
    ++time.messages_sent;
  }
  if (event.phase == comm::Phase::gather) return;
  if (event.kind == Kind::work) time.work += event.end - event.begin;
  if (is_message) {
    const double handling =
        network.overhead + network.copy_seconds_per_byte * static_cast<double>(event.amount);
    time.messages += std::min(handling, event.end - event.begin);
  }
}

void take_counts(const RankStatistics& from, RankTime& rank) {
  rank.rays_sent = from.rays_sent;
  rank.tests = from.tests;
  rank.clusters = from.clusters;
  rank.tree_bytes = from.tree_bytes;
  rank.geometry_bytes = from.geometry_bytes;
}

SimulatedFrame summary_of(const std::vector<RankTime>& ranks) {
  SimulatedFrame frame;
  double begin = ranks[0].begin;
  std::vector<double> tests;
  for (std::size_t k = 0; k < ranks.size(); ++k) {
    const RankTime& rank = ranks[k];
    const RankTime& busiest = ranks[static_cast<std::size_t>(frame.busiest)];
    begin = std::min(begin, rank.begin);
    if (rank.work + rank.messages > busiest.work + busiest.messages)
      frame.busiest = static_cast<int>(k);
    frame.bytes += rank.bytes_sent;
    frame.messages += rank.messages_sent;
    frame.rays_sent += rank.rays_sent;
    frame.clusters += rank.clusters;
    frame.tree_bytes = std::max(frame.tree_bytes, rank.tree_bytes);
    frame.geometry_bytes = std::max(frame.geometry_bytes, rank.geometry_bytes);
    tests.push_back(static_cast<double>(rank.tests));
  }
  frame.test_imbalance = loadbalance::imbalance(tests);
  const RankTime& rank = ranks[static_cast<std::size_t>(frame.busiest)];
  frame.seconds = ranks[0].end - begin;
  frame.parts = {rank.work, rank.messages, rank.gather - begin - rank.work - rank.messages,
                 ranks[0].end - rank.gather};
  return frame;
}

}  // namespace

const char* name(FramePart part) {
  constexpr std::array<const char*, kFrameParts> kNames = {"trace", "messages", "waiting",
                                                           "gather"};
  return kNames[static_cast<std::size_t>(part)];
}

std::vector<SimulatedFrame> simulate_frames(const RepeatedFrame& repeated,
                                            const Distribution& distribution, int ranks,
                                            const comm::Network& network) {
  const auto frames = static_cast<std::size_t>(repeated.frames);
  std::vector<std::vector<RankTime>> times(frames,
                                           std::vector<RankTime>(static_cast<std::size_t>(ranks)));
  comm::SimulationOptions simulation;
  simulation.stack_bytes = std::size_t{8} << 20;  // renderers expect a thread's
  parallel::Arena(1).execute([&] {
    comm::run_simulated(
        ranks, network, 1,
        [&](comm::Communicator& communicator) {
          const int self = communicator.rank();
          std::optional<SharedScene> shared;
          if (!distribution.replicated)
            shared.emplace(SharedScene::make(communicator, repeated.scene, repeated.tracer.shader,
                                             share_options(distribution, repeated.share)));
          Renderer renderer = shared ? Renderer(*shared, distribution) : Renderer(repeated.tracer);
          for (std::vector<RankTime>& frame : times) {
            RankTime& time = frame[static_cast<std::size_t>(self)];
            std::vector<comm::Event> events;
            comm::Recording recording(communicator, events);
            comm::barrier(communicator);
            time.begin = communicator.seconds();
            Result result;
            {
              comm::Charged charged(recording);
              result = renderer.render(charged, repeated.camera, repeated.options);
              charged.mark(comm::Phase::other, 0);  // what was done since the last message
            }
            time.end = communicator.seconds();
            for (const comm::Event& event : events) add(event, self, network, time);
            if (self == 0) {
              for (std::size_t k = 0; k < result.statistics.ranks.size(); ++k)
                take_counts(result.statistics.ranks[k], frame[k]);
              renderer.recycle(std::move(result.image));
            }
          }
        },
        simulation);
  });
  std::vector<SimulatedFrame> result;
  for (const std::vector<RankTime>& frame : times) result.push_back(summary_of(frame));
  return result;
}

}  // namespace delray::raytrace
