// Ring distribution (Kim et al. 1996): a ray visits rank after rank in the order of the ring,
// passes over those that have nothing in its way, and returns to its own with the nearest hit.
// Clusters move to the next rank where that is less loaded.
//
// A cluster moves once a frame, at most, and only if it was resident when the frame began: rays of
// that frame meet it there still, wherever it goes meanwhile, so that none is missed. Before the
// next one all ranks learn where it is. Degenerate: alone there is nobody to go round.
#include <algorithm>
#include <cstddef>

#include "raytrace/distributed/ray_router.h"
#include "raytrace/distributed/ring_loads.h"

namespace delray::raytrace {
namespace {

constexpr ClusterHit kBegin{-1.0F, 0};  // before any other

// Moves tell in the next frame only: a rank gives away its clusters in so many frames at least, or
// loads would swing.
constexpr std::size_t kFrames = 8;

class RingRouter final : public RayRouter {
 public:
  explicit RingRouter(const RoutingContext& context)
      : context_(context), most_given_((context.scene.owned().size() + kFrames - 1) / kFrames) {
    if (context.scene.owned().size() == 1) most_given_ = 0;
  }

  Progression start() const override { return {}; }

  // To the next rank of the ring that has a cluster in its way, up to its nearest hit so far.
  void choose_next(const Line& line, Progression& way) const override {
    way.next = kMiss;
    const auto ranks = static_cast<std::uint32_t>(context_.messenger.ranks());
    const auto rank = static_cast<std::uint32_t>(context_.messenger.rank());
    const std::uint32_t home = (rank + ranks - way.hops) % ranks;
    std::uint32_t hops = ranks;
    ClusterHit hit = kBegin;
    while (hops > way.hops + 1) {
      hit = context_.scene.elsewhere().next(line, hit);
      if (hit.cluster == kNoCluster) break;
      const auto owner = static_cast<std::uint32_t>(context_.scene.owner(hit.cluster));
      const std::uint32_t hops_there = (owner + ranks - home) % ranks;
      if (hops_there > way.hops) hops = std::min(hops, hops_there);
    }
    if (hops == ranks) return;
    way.hops = hops;
    way.next = kOnward;
  }

  void receive(int, const MessageHeader& header, std::span<const std::byte> content) override {
    if (header.kind == MessageKind::load) return loads_.hear(header.load);
    context_.scene.take_over(header.cluster, unpack_cluster(content));
  }

  void take_turn(bool) override {
    const int ranks = context_.messenger.ranks();
    if (ranks == 1) return;
    const std::uint64_t load = context_.counts.tests;
    if (loads_.tell(load)) {
      MessageHeader header;
      header.kind = MessageKind::load;
      header.load = load;
      context_.messenger.send((context_.messenger.rank() + ranks - 1) % ranks,
                              with_header(header, {}));
    }
    if (loads_.should_give(load) && given_ < most_given_) give(load);
  }

 private:
  // Gives a cluster to the next rank, whose next frame begins with it.
  void give(std::uint64_t load) {
    for (const auto& [number, cluster] : context_.scene.owned()) {
      if (!context_.scene.is_resident(number)) continue;
      MessageHeader header;
      header.kind = MessageKind::move;
      header.cluster = number;
      comm::Buffer message = with_header(header, pack(cluster->data()));
      context_.scene.give_away(number);
      context_.messenger.send((context_.messenger.rank() + 1) % context_.messenger.ranks(),
                              std::move(message));
      ++context_.counts.clusters_moved;
      loads_.gave(load);
      ++given_;
      return;
    }
  }

  RoutingContext context_;
  std::size_t given_ = 0, most_given_;  // in this frame
  RingLoads loads_;                     // of this rank and the next
};

}  // namespace

std::unique_ptr<RayRouter> make_ring_router(const RoutingContext& context) {
  return std::make_unique<RingRouter>(context);
}

}  // namespace delray::raytrace
