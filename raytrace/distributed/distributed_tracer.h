// One rank's part of a frame over a distributed scene: integrators that wait for the results of
// their rays, rays that wait for clusters, and messages about both.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "comm/communicator.h"
#include "comm/termination.h"
#include "raytrace/distributed/intersect_cluster.h"
#include "raytrace/distributed/ray_message.h"
#include "raytrace/distributed/ring_loads.h"
#include "raytrace/distribution.h"
#include "raytrace/integrators/sample_tile.h"

namespace delray::raytrace {

// Counted.
struct RoutingCounts {
  std::uint64_t rays_sent = 0;         // to another rank, answers not among them
  std::uint64_t answers_sent = 0;      // to the rank that asked
  std::uint64_t tests = 0;             // rays against clusters
  std::uint64_t clusters_fetched = 0;  // from another rank
  std::uint64_t cluster_bytes = 0;     // of those
  std::uint64_t clusters_moved = 0;    // given to a neighbour, ring
};

// Used by the rank's own thread; integrators and clusters run in parallel in its arena.
//
// A rank works at what it has: integrators whose rays are intersected, and rays at clusters that
// are at hand. Rays at others are put aside, and the distribution says what becomes of them. It
// serves the others in all of its calls, and never waits for one message only, so no two ranks wait
// for each other. That all is done everywhere is found out by four counters (comm/termination.h).
class DistributedTracer {
 public:
  DistributedTracer(comm::Communicator& communicator, SharedScene& scene,
                    const Distribution& distribution, const TiledFrame& frame);

  // Adds a tile, and works until there is room for another.
  void add(std::uint32_t tile);
  // Works off what is there and came, without waiting. Whether there was anything.
  bool serve();
  // Waits a moment for messages of other ranks.
  void wait_a_moment();
  // Returns when all tiles of all ranks are done.
  void finish();

  std::vector<TilePixels>& tiles() { return done_; }
  const RoutingCounts& counts() const { return counts_; }
  double busy() const { return busy_; }

 private:
  struct Tile {
    TilePixels pixels;
    int pixel_tasks = 0;
  };
  // A task of a tile, sample after sample.
  struct PixelTask {
    std::unique_ptr<WavefrontIntegrator> integrator;
    Tile* tile = nullptr;
    Task task;
    std::size_t open = 0;  // rays that are not answered yet
    bool started = false;
  };

  void receive_all();
  void receive(const comm::Envelope& envelope);
  bool advance_pixel_tasks();
  bool intersect_clusters();
  void decide_waiting(bool idle);
  void send_all(bool idle);

  template <class T>
  void choose_next(T& ray, std::vector<ClusterHit>& cluster_hits) const;
  template <class T>
  void route(T&& ray);
  void deliver(const RayMessage& ray);
  void deliver(const ShadowMessage& shadow);
  void make_messages(std::uint32_t pixel_task, std::vector<RayMessage>& rays,
                     std::vector<ShadowMessage>& shadows);
  void end_sample(std::uint32_t pixel_task);
  void send(int to, comm::Buffer&& message);
  void balance_load();

  comm::Communicator& communicator_;
  SharedScene& scene_;
  const Distribution& distribution_;
  const TiledFrame& frame_;
  int last_sample_;  // one past it
  Kernels kernels_;
  comm::Termination termination_;
  bool ring_;

  std::vector<PixelTask> pixel_tasks_;
  std::vector<std::uint32_t> free_, ready_;  // numbers of pixel_tasks
  std::size_t in_flight_ = 0;
  std::vector<std::unique_ptr<Tile>> open_tiles_;
  std::vector<TilePixels> done_;

  std::unordered_map<std::uint32_t, RayQueue> waiting_;  // by cluster
  std::unordered_set<std::uint32_t> fetching_;           // clusters that were asked for
  std::vector<std::pair<std::uint32_t, std::shared_ptr<const Cluster>>> arrived_;
  std::vector<RayQueue> to_intersect_, to_answer_;  // by rank
  RoutingCounts counts_;
  double busy_ = 0.0;
  std::uint64_t termination_sent_ = 0;  // messages, as told to termination_

  // Ring: what was taken over, in order, and how loaded this rank and the next are.
  std::vector<std::uint32_t> taken_over_;
  RingLoads loads_;
};

}  // namespace delray::raytrace
