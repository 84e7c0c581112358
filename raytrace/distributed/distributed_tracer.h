// One rank's part of a frame over a distributed scene: integrators that wait for the results of
// their rays, rays that wait for clusters, and messages about both.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include "comm/communicator.h"
#include "comm/termination.h"
#include "raytrace/distributed/batch_rays.h"
#include "raytrace/distributed/ray_router.h"
#include "raytrace/distributed/tile_plan.h"
#include "raytrace/integrators/sample_tile.h"

namespace delray::raytrace {

// Used by the rank's own thread; integrators and clusters run in parallel in its arena.
//
// A rank works at what it has: integrators whose rays are intersected, and rays at clusters that
// are at hand. What becomes of other rays the router says. The rank serves the others in all of its
// calls, and never waits for one message only, so no two ranks wait for each other. That all is
// done everywhere is found out by four counters (comm/termination.h).
class DistributedTracer {
 public:
  // `plan`: the ranks of tiles, as plan_tiles() returns them.
  DistributedTracer(comm::Communicator& communicator, SharedScene& scene,
                    const Distribution& distribution, const TiledFrame& frame,
                    std::span<const std::int32_t> plan = {});

  // Adds a tile: notes it here, or passes it on to the rank that has what it shows. Where tiles
  // stay on the ranks that they were given to, works at it until there is room for another.
  void add(std::uint32_t tile);
  // Works off what is there and came, without waiting. Whether there was anything.
  bool serve();
  // Waits a moment for messages of other ranks.
  void wait_a_moment();
  // Returns when all tiles of all ranks are done.
  void finish();

  std::vector<TilePixels>& tiles() { return done_; }
  const RoutingCounts& counts() const { return counts_; }
  // Of those tiles, where the distribution plans them.
  std::vector<PlannedTile> take_planned() { return std::move(planned_); }
  double busy() const { return busy_; }

 private:
  struct Tile {
    TilePixels pixels;
    int pixel_tasks = 0;
    std::uint64_t answers = 0;
  };
  // A task of a tile, sample after sample.
  struct PixelTask {
    std::unique_ptr<WavefrontIntegrator> integrator;  // from its beginning to its end
    Tile* tile = nullptr;
    Task task;
    std::size_t open = 0;  // rays that are not answered yet
    bool started = false;  // its present sample
  };
  // What became of a pixel task until it was done or had to wait.
  struct Advanced {
    bool done = false;
    RayQueue travelling;
    RayCounts rays;
    std::uint64_t tests = 0;
    double busy = 0.0;
  };
  // Rays to be intersected with clusters.
  struct ClusterBatch {
    const ClusterScene* clusters = nullptr;
    std::span<RayMessage> rays;
    std::span<ShadowMessage> shadows;
    double busy = 0.0;
  };

  int rank_of_tile(std::uint32_t tile) const;
  void start(std::uint32_t tile);
  bool start_waiting_tiles();
  void receive_all();
  void receive(const comm::Envelope& envelope);
  void note_travel(std::uint64_t rays, double start);
  bool advance_pixel_tasks();
  Advanced advance(std::uint32_t pixel_task);
  void end_task(std::uint32_t pixel_task);
  void end_tile(TilePixels&& pixels);
  bool intersect_waiting();
  void intersect(ClusterBatch& batch);
  void send_all(bool idle);

  template <class Message>
  void choose_next(Message& message) const;
  template <class Message>
  void route(Message&& message);
  void route_all(RayQueue&& queue);
  template <class Message>
  void end_ray(const Message& message);

  comm::Communicator& communicator_;
  SharedScene& scene_;
  const TiledFrame& frame_;
  int last_sample_;            // one past it
  std::size_t ready_at_once_;  // tasks that are waited for before any is advanced
  bool passes_tiles_on_;       // to ranks that have what they show
  bool plans_tiles_;           // for the next frame
  std::span<const std::int32_t> plan_;
  Kernels kernels_;
  comm::Termination termination_;
  RayMessenger messenger_;

  std::vector<PixelTask> pixel_tasks_;
  std::vector<std::uint32_t> free_, ready_;  // numbers of pixel_tasks
  std::size_t in_flight_ = 0;
  std::vector<std::unique_ptr<Tile>> open_tiles_;
  std::deque<std::uint32_t> waiting_tiles_;                // of this rank, which it has not started
  std::vector<std::vector<std::uint32_t>> tiles_to_send_;  // by rank
  std::vector<TilePixels> done_;
  std::vector<PlannedTile> planned_;

  WaitingRays waiting_;
  RoutingCounts counts_;
  double busy_ = 0.0;
  double waiting_seconds_ = 0.0;  // of processor time, for rays that waited
  std::uint64_t answers_ = 0;     // to those of this rank
  std::uint64_t travelled_ = 0;   // rays and answers that came
  double travel_seconds_ = 0.0;   // of processor time that they took, and what was sent
  std::unique_ptr<RayRouter> router_;
};

}  // namespace delray::raytrace
