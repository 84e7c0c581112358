// How rays go on that the clusters at hand do not decide: the part of a distribution that the
// tracer knows nothing of.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "comm/communicator.h"
#include "comm/termination.h"
#include "raytrace/distributed/pack_messages.h"
#include "raytrace/distributed/ray_message.h"
#include "raytrace/distribution.h"

namespace delray::raytrace {

// Counted.
struct RoutingCounts {
  std::uint64_t rays_sent = 0;         // to another rank, answers not among them
  std::uint64_t answers_sent = 0;      // to the rank that asked
  std::uint64_t tests = 0;             // rays against clusters: all resident ones at once, or one
  std::uint64_t clusters_fetched = 0;  // from another rank
  std::uint64_t cluster_bytes = 0;     // of those
  std::uint64_t clusters_moved = 0;    // given to a neighbour, ring
};

// Messages about rays. Each counts for the detection of the end.
class RayMessenger {
 public:
  static constexpr comm::Tag kTag = 200;  // beside those of schedules, which are used meanwhile

  RayMessenger(comm::Communicator& communicator, comm::Termination& termination)
      : communicator_(communicator),
        termination_(termination),
        loads_(static_cast<std::size_t>(communicator.size())) {}
  // REQUIRES: a header is at the front.
  void send(int to, comm::Buffer&& message) {
    if (tells_load_) set_load_of(message, load());
    communicator_.send(to, kTag, std::move(message));
    termination_.count_sent();
    ++sent_;
  }
  std::uint64_t sent() const { return sent_; }
  // From now on every message says how many rays this rank has to intersect.
  void set_load(std::uint64_t rays) {
    tells_load_ = true;
    loads_[static_cast<std::size_t>(rank())] = rays;
  }
  void hear_load(int from, std::uint64_t rays) { loads_[static_cast<std::size_t>(from)] = rays; }
  std::uint64_t load() const { return load_of(rank()); }
  std::uint64_t load_of(int rank) const { return loads_[static_cast<std::size_t>(rank)]; }
  std::uint64_t least_load() const { return *std::min_element(loads_.begin(), loads_.end()); }
  int rank() const { return communicator_.rank(); }
  int ranks() const { return communicator_.size(); }

 private:
  comm::Communicator& communicator_;
  comm::Termination& termination_;
  std::uint64_t sent_ = 0;
  bool tells_load_ = false;
  std::vector<std::uint64_t> loads_;  // by rank, as it told last
};

// Rays on a rank, by what they wait for.
struct WaitingRays {
  std::vector<RayQueue> at_resident;                       // to be intersected with those clusters
  std::unordered_map<std::uint32_t, RayQueue> by_cluster;  // that are not resident
  std::vector<RayQueue> to_intersect, to_answer;           // by rank: to be sent
  // Clusters that have just come: they stay until their rays have been intersected, however little
  // room there is.
  std::vector<std::pair<std::uint32_t, std::shared_ptr<const ClusterScene>>> arrived;
};

// What routing works on. REQUIRES: all of it outlives the router.
struct RoutingContext {
  SharedScene& scene;
  RayMessenger& messenger;
  WaitingRays& waiting;
  RoutingCounts& counts;
};

class RayRouter {
 public:
  // Progression::next: to the rank of the ring that is Progression::hops behind the ray's own.
  static constexpr std::uint32_t kOnward = kMiss - 1;

  virtual ~RayRouter() = default;
  RayRouter() = default;
  RayRouter(const RayRouter&) = delete;
  RayRouter& operator=(const RayRouter&) = delete;

  // Any thread: the way of a ray that its own rank has intersected with its resident clusters.
  virtual Progression start() const = 0;
  // Any thread: sets way.next to the cluster that a ray has to be intersected with next, kOnward or
  // kMiss; way.last accordingly.
  virtual void choose_next(const Line& line, Progression& way) const = 0;
  // A message that is neither rays nor answers.
  virtual void receive(int from, const MessageHeader& header,
                       std::span<const std::byte> content) = 0;
  // Decides about rays whose clusters are not at hand, or about clusters. `idle`: there is nothing
  // else to do.
  virtual void take_turn(bool idle) = 0;
};

// To the owners of clusters, or clusters from there, as the distribution decides.
std::unique_ptr<RayRouter> make_cluster_router(const Distribution& distribution,
                                               const RoutingContext& context);
// From rank to rank.
std::unique_ptr<RayRouter> make_ring_router(const RoutingContext& context);

}  // namespace delray::raytrace
