// Routes rays cluster by cluster, in the order in which they enter them: a ray waits for a cluster
// of another rank until the distribution sends it there or fetches the cluster.
//
// A rank that a ray comes to intersects it with all that it has, so that no ray need go to a rank
// twice. Degenerate: a ray remembers a few ranks only, and may go to one again that it has
// forgotten; it learns nothing there.
#include <algorithm>
#include <cstddef>
#include <unordered_set>

#include "parallel/parallel_for.h"
#include "raytrace/clusters/compress_cluster.h"
#include "raytrace/distributed/ray_router.h"

namespace delray::raytrace {
namespace {

constexpr std::size_t kMostRead = 32;  // clusters at a time: some megabytes, work for all threads

class ClusterRouter final : public RayRouter {
 public:
  ClusterRouter(const Distribution& distribution, const RoutingContext& context)
      : distribution_(distribution), context_(context) {}

  Progression start() const override {
    Progression way;
    way.note(context_.messenger.rank());
    return way;
  }

  void choose_next(const Line& line, Progression& way) const override {
    way.next = kMiss;
    const SharedScene& scene = context_.scene;
    const bool from_file = scene.file() != nullptr;  // where no ray needs to go to another rank
    if (!from_file && way.has_been_everywhere(context_.messenger.ranks())) return;
    for (;;) {
      const ClusterHit hit = scene.elsewhere().next(line, way.last);
      if (hit.cluster == kNoCluster) return;
      way.last = hit;
      if (way.has_met(hit.cluster)) continue;
      if (!from_file && way.has_been_at(scene.owner(hit.cluster))) continue;
      way.next = hit.cluster;
      return;
    }
  }

  void receive(int from, const MessageHeader& header, std::span<const std::byte> content) override {
    if (header.kind == MessageKind::fetch) {
      MessageHeader answer;
      answer.kind = MessageKind::cluster;
      answer.cluster = header.cluster;
      const ClusterData& data = context_.scene.owned().at(header.cluster)->data();
      context_.messenger.send(
          from, with_header(answer, context_.scene.compresses() ? compress(data) : pack(data)));
      return;
    }
    fetching_.erase(header.cluster);
    ++context_.counts.clusters_fetched;
    context_.counts.cluster_bytes += content.size();
    context_.waiting.arrived.emplace_back(
        header.cluster,
        context_.scene.put(header.cluster, context_.scene.compresses() ? decompress_cluster(content)
                                                                       : unpack_cluster(content)));
  }

  void take_turn(bool idle) override {
    if (distribution_.tells_loads) context_.messenger.set_load(own_load());
    send_or_fetch(idle);
    read_from_file();
  }

 private:
  std::uint64_t own_load() const {
    std::uint64_t rays = 0;
    for (const RayQueue& queue : context_.waiting.at_resident) rays += queue.size();
    for (const auto& [cluster, queue] : context_.waiting.by_cluster) rays += queue.size();
    return rays;
  }

  void send_or_fetch(bool idle) {
    auto& by_cluster = context_.waiting.by_cluster;
    for (auto at = by_cluster.begin(); at != by_cluster.end();) {
      const std::uint32_t cluster = at->first;
      // What is at hand by now waits for the next turn.
      if (fetching_.contains(cluster) || context_.scene.find(cluster) != nullptr) {
        ++at;
        continue;
      }
      switch (distribution_.decide(waiting_list(cluster, at->second, idle))) {
        case RoutingDecision::wait:
          ++at;
          break;
        case RoutingDecision::fetch_cluster:
          if (context_.scene.file() != nullptr)
            to_read_.push_back(cluster);
          else
            fetch(cluster);
          ++at;
          break;
        case RoutingDecision::send_rays: {
          context_.scene.note_wanted(cluster, at->second.size());
          const auto owner = static_cast<std::size_t>(context_.scene.owner(cluster));
          context_.waiting.to_intersect[owner].append(std::move(at->second));
          at = by_cluster.erase(at);
          break;
        }
      }
    }
  }

  // Some at a time, by all threads; others are decided about again.
  void read_from_file() {
    SharedScene& scene = context_.scene;
    const std::size_t count = std::min(to_read_.size(), kMostRead);
    std::vector<ClusterData> read(count);
    parallel::parallel_for(0, count, 1, [&](std::size_t i) {
      read[i] = scene.file()->read(to_read_[i], scene.shader());
    });
    for (std::size_t i = 0; i < count; ++i) {
      ++context_.counts.clusters_fetched;
      context_.counts.cluster_bytes += scene.file()->bytes_in_file(to_read_[i]);
      context_.waiting.arrived.emplace_back(to_read_[i],
                                            scene.put(to_read_[i], std::move(read[i])));
    }
    to_read_.clear();
  }

  WaitingList waiting_list(std::uint32_t cluster, const RayQueue& waiting, bool idle) const {
    WaitingList list;
    list.cluster = cluster;
    list.rays = waiting.size();
    list.ray_bytes = waiting.rays.size() * sizeof(RayMessage) +
                     waiting.shadows.size() * offsetof(ShadowMessage, layers);
    const SharedScene& scene = context_.scene;
    list.cluster_bytes = scene.packed_bytes(cluster);
    list.wanted = scene.wanted(cluster) + static_cast<double>(waiting.size());
    list.ray_seconds = scene.travel_costs().ray;
    list.cluster_seconds =
        scene.travel_costs().cluster_byte * static_cast<double>(list.cluster_bytes);
    list.has_room = scene.has_room_for(cluster);
    if (distribution_.tells_loads) {
      list.own_load = context_.messenger.load();
      list.owner_load = context_.messenger.load_of(scene.owner(cluster));
      list.least_load = context_.messenger.least_load();
    }
    list.idle = idle;
    return list;
  }

  void fetch(std::uint32_t cluster) {
    MessageHeader header;
    header.kind = MessageKind::fetch;
    header.cluster = cluster;
    context_.messenger.send(context_.scene.owner(cluster), with_header(header, {}));
    context_.scene.expect(cluster);
    fetching_.insert(cluster);
  }

  const Distribution& distribution_;
  RoutingContext context_;
  std::unordered_set<std::uint32_t> fetching_;  // clusters that were asked for
  std::vector<std::uint32_t> to_read_;          // likewise, of a file
};

}  // namespace

std::unique_ptr<RayRouter> make_cluster_router(const Distribution& distribution,
                                               const RoutingContext& context) {
  return std::make_unique<ClusterRouter>(distribution, context);
}

}  // namespace delray::raytrace
