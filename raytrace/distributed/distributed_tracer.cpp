// Traces a frame over a distributed scene: advances integrators, intersects rays with the clusters
// at hand, and routes all others as the distribution decides. A ray visits the clusters on its way
// in the order of entry and returns to its own rank with the nearest hit. In the ring it visits
// rank after rank instead; a cluster that moved while the ray was under way sends the ray round
// once more. The end is detected by counting messages (comm/termination.h).
#include "raytrace/distributed/distributed_tracer.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <utility>

#include "comm/collectives.h"
#include "parallel/parallel_for.h"
#include "raytrace/distributed/distributions.h"
#include "raytrace/distributed/pack_messages.h"
#include "raytrace/scene/flush_to_zero.h"

namespace delray::raytrace {
namespace {

// Beside those of schedules, which are used meanwhile.
constexpr comm::Tag kTagRays = 200, kTagControl = 201;

constexpr std::uint32_t kOnward = kMiss - 1;  // Progression::next: to the next rank of the ring

// IntegratorPool in the making on a rank: enough that some are ready while the others' questions
// travel.
constexpr std::size_t kMostPixelTasks = 96;

// A rank looks whether messages have come at least so often while it waits.
constexpr auto kMoment = std::chrono::microseconds(100);

bool is_decided(const RayMessage&) { return false; }
bool is_decided(const ShadowMessage& shadow) { return shadow.occluded; }

}  // namespace

DistributedTracer::DistributedTracer(comm::Communicator& communicator, SharedScene& scene,
                                     const Distribution& distribution, const TiledFrame& frame)
    : communicator_(communicator),
      scene_(scene),
      distribution_(distribution),
      frame_(frame),
      last_sample_(frame.options.part.first_sample + samples_of(frame.options)),
      kernels_{scene.has_instances()},
      termination_(communicator, kTagControl),
      ring_(distribution.decide == nullptr),
      to_intersect_(static_cast<std::size_t>(communicator.size())),
      to_answer_(static_cast<std::size_t>(communicator.size())) {}

void DistributedTracer::add(std::uint32_t number) {
  TilePixels pixels = start_tile(frame_, number);
  const std::vector<Task> tasks = tasks_of(frame_, pixels.rect);
  if (tasks.empty()) {
    done_.push_back(std::move(pixels));
    return;
  }
  Tile& tile = *open_tiles_.emplace_back(std::make_unique<Tile>());
  tile.pixels = std::move(pixels);
  for (const Task& task : tasks) {
    if (free_.empty()) {
      free_.push_back(static_cast<std::uint32_t>(pixel_tasks_.size()));
      pixel_tasks_.emplace_back();
    }
    const std::uint32_t index = free_.back();
    free_.pop_back();
    PixelTask& pixel_task = pixel_tasks_[index];
    pixel_task.integrator = frame_.integrators.take();
    pixel_task.tile = &tile;
    pixel_task.task = task;
    pixel_task.started = false;
    ++tile.pixel_tasks;
    ++in_flight_;
    ready_.push_back(index);
  }
  while (in_flight_ > kMostPixelTasks) {
    if (!serve()) wait_a_moment();
  }
}

bool DistributedTracer::serve() {
  receive_all();
  bool any = advance_pixel_tasks();
  any = intersect_clusters() || any;
  const std::uint64_t before = termination_sent_;
  decide_waiting(!any);
  if (ring_) balance_load();
  send_all(!any);
  return any || termination_sent_ != before;
}

void DistributedTracer::wait_a_moment() {
  communicator_.probe(comm::kAnyRank, kTagRays, comm::Deadline::in(kMoment));
}

void DistributedTracer::finish() {
  while (!termination_.is_over()) {
    if (serve()) continue;
    termination_.idle();
    if (termination_.is_over()) break;
    if (const auto control =
            communicator_.probe(comm::kAnyRank, kTagControl, comm::Deadline::now()))
      termination_.handle(*control);
    else
      wait_a_moment();
  }
  // Who begins something else must not be heard by those who are not done.
  comm::barrier(communicator_);
}

void DistributedTracer::send(int to, comm::Buffer&& message) {
  communicator_.send(to, kTagRays, std::move(message));
  termination_.count_sent();
  ++termination_sent_;
}

void DistributedTracer::receive_all() {
  while (const auto envelope = communicator_.probe(comm::kAnyRank, kTagRays, comm::Deadline::now()))
    receive(*envelope);
}

void DistributedTracer::receive(const comm::Envelope& envelope) {
  const comm::Buffer message = communicator_.receive(envelope.source, kTagRays);
  termination_.count_received();
  const MessageHeader header = header_of(message);
  const std::span<const std::byte> content(message.data() + sizeof(MessageHeader),
                                           message.size() - sizeof(MessageHeader));
  switch (header.kind) {
    case MessageKind::intersect: {
      std::vector<ClusterHit> cluster_hits;
      const auto take_in = [&](auto&& ray) {
        if (ring_) choose_next(ray, cluster_hits);
        route(std::move(ray));
      };
      RayQueue queue = unpack_rays(message, header);
      for (RayMessage& ray : queue.rays) take_in(std::move(ray));
      for (ShadowMessage& shadow : queue.shadows) take_in(std::move(shadow));
      break;
    }
    case MessageKind::answer: {
      const RayQueue queue = unpack_rays(message, header);
      for (const RayMessage& ray : queue.rays) deliver(ray);
      for (const ShadowMessage& shadow : queue.shadows) deliver(shadow);
      break;
    }
    case MessageKind::fetch: {
      MessageHeader answer;
      answer.kind = MessageKind::cluster;
      answer.cluster = header.cluster;
      send(envelope.source,
           with_header(answer, raytrace::pack(scene_.find(header.cluster)->data())));
      break;
    }
    case MessageKind::cluster: {
      ++counts_.clusters_fetched;
      counts_.cluster_bytes += content.size();
      arrived_.emplace_back(header.cluster, scene_.put(header.cluster, unpack_cluster(content)));
      fetching_.erase(header.cluster);
      break;
    }
    case MessageKind::move:
      scene_.take_over(header.cluster, unpack_cluster(content));
      taken_over_.push_back(header.cluster);
      break;
    case MessageKind::load:
      loads_.hear(header.load);
      break;
  }
}

bool DistributedTracer::advance_pixel_tasks() {
  if (ready_.empty()) return false;
  const std::vector<std::uint32_t> ready = std::exchange(ready_, {});
  struct Asked {
    std::vector<RayMessage> rays;
    std::vector<ShadowMessage> shadows;
    double busy = 0;
  };
  std::vector<Asked> asked(ready.size());
  parallel::parallel_for(0, ready.size(), 1, [&](std::size_t i) {
    const FlushToZero flush;
    const double start = thread_seconds();
    PixelTask& pixel_task = pixel_tasks_[ready[i]];
    if (pixel_task.started)
      pixel_task.integrator->advance();
    else
      pixel_task.integrator->start(pixel_task.task);
    pixel_task.started = true;
    if (!pixel_task.integrator->done()) make_messages(ready[i], asked[i].rays, asked[i].shadows);
    asked[i].busy = thread_seconds() - start;
  });
  for (std::size_t i = 0; i < ready.size(); ++i) {
    PixelTask& pixel_task = pixel_tasks_[ready[i]];
    busy_ += asked[i].busy;
    pixel_task.tile->pixels.busy += asked[i].busy;
    if (pixel_task.integrator->done()) {
      end_sample(ready[i]);
      continue;
    }
    pixel_task.open = asked[i].rays.size() + asked[i].shadows.size();
    for (RayMessage& ray : asked[i].rays) route(std::move(ray));
    for (ShadowMessage& shadow : asked[i].shadows) route(std::move(shadow));
  }
  return true;
}

void DistributedTracer::end_sample(std::uint32_t index) {
  PixelTask& pixel_task = pixel_tasks_[index];
  add_samples(frame_, *pixel_task.integrator, pixel_task.task, pixel_task.tile->pixels);
  pixel_task.started = false;
  if (++pixel_task.task.first_sample < last_sample_) {
    ready_.push_back(index);
    return;
  }
  frame_.integrators.give(std::move(pixel_task.integrator));
  free_.push_back(index);
  --in_flight_;
  Tile* const tile = std::exchange(pixel_task.tile, nullptr);
  if (--tile->pixel_tasks > 0) return;
  done_.push_back(std::move(tile->pixels));
  std::erase_if(open_tiles_, [tile](const auto& open) { return open.get() == tile; });
}

void DistributedTracer::make_messages(std::uint32_t index, std::vector<RayMessage>& rays,
                                      std::vector<ShadowMessage>& shadows) {
  RayBatch& batch = pixel_tasks_[index].integrator->batch();
  std::vector<ClusterHit> cluster_hits;
  ReturnAddress return_address;
  return_address.rank = communicator_.rank();
  return_address.pixel_task = index;
  for (std::uint32_t g = 0; g < batch.rays.size(); ++g) {
    RayGroup& group = batch.rays[g];
    group.hits = 0;
    group.points.coloured = false;
    const RayPacket& p = group.packet;
    for (int i = 0; i < kPacketRays; ++i) {
      if (group.active.ray[i] == 0) continue;
      RayMessage& ray = rays.emplace_back();
      ray.return_address = return_address;
      ray.return_address.group = g;
      ray.return_address.lane = static_cast<std::uint8_t>(i);
      ray.return_address.coherent = group.coherent ? 1 : 0;
      ray.origin = {p.origin_x[i], p.origin_y[i], p.origin_z[i]};
      ray.near = p.near[i];
      ray.direction = {p.direction_x[i], p.direction_y[i], p.direction_z[i]};
      ray.far = p.far[i];
      ray.view = group.view.get(i);
      ray.width = group.width[i];
      ray.spread = group.spread[i];
      ray.way.stamp = taken_over_.size();
      choose_next(ray, cluster_hits);
    }
  }
  for (std::uint32_t g = 0; g < batch.shadows.size(); ++g) {
    ShadowGroup& group = batch.shadows[g];
    group.lit = group.attenuated = 0;
    const ShadowPacket& p = group.packet;
    for (int i = 0; i < kPacketRays; ++i) {
      if (group.active.ray[i] == 0) continue;
      ShadowMessage& shadow = shadows.emplace_back();
      shadow.return_address = return_address;
      shadow.return_address.group = g;
      shadow.return_address.lane = static_cast<std::uint8_t>(i);
      shadow.return_address.coherent = group.coherent ? 1 : 0;
      shadow.return_address.through_glass = (group.through_glass >> i & 1) != 0 ? 1 : 0;
      shadow.origin = {p.origin_x[i], p.origin_y[i], p.origin_z[i]};
      shadow.near = p.near[i];
      shadow.direction = {p.direction_x[i], p.direction_y[i], p.direction_z[i]};
      shadow.far = p.far[i];
      shadow.way.stamp = taken_over_.size();
      choose_next(shadow, cluster_hits);
    }
  }
}

template <class T>
void DistributedTracer::choose_next(T& ray, std::vector<ClusterHit>& cluster_hits) const {
  ray.way.next = kMiss;
  if (is_decided(ray)) return;
  scene_.tree().find(ray.origin, ray.direction, ray.near, ray.far, cluster_hits);
  const bool is_back = ring_ && ray.way.hops == static_cast<std::uint32_t>(communicator_.size());
  // What came to this rank while the ray was under way may have been nowhere when it was there.
  const auto times_it_came = [&](const ClusterHit& cluster_hit) {
    return std::count(taken_over_.begin() + static_cast<std::ptrdiff_t>(ray.way.stamp),
                      taken_over_.end(), cluster_hit.cluster);
  };
  for (const ClusterHit& cluster_hit : cluster_hits) {
    if (!(ray.way.last < cluster_hit)) continue;
    if (ring_ && !scene_.owns(cluster_hit.cluster)) continue;
    if (is_back && times_it_came(cluster_hit) == 0) continue;
    ray.way.last = cluster_hit;
    ray.way.next = cluster_hit.cluster;
    return;
  }
  if (!ring_) return;
  if (!is_back) {
    ray.way.next = kOnward;
    return;
  }
  // What has gone on since is behind the ray, which goes round once more then.
  const bool missed =
      std::any_of(cluster_hits.begin(), cluster_hits.end(), [&](const ClusterHit& cluster_hit) {
        return times_it_came(cluster_hit) > (scene_.owns(cluster_hit.cluster) ? 1 : 0);
      });
  if (!missed) return;
  ray.way.hops = 0;
  ray.way.stamp = taken_over_.size();
  ray.way.last = {-1.0F, 0};
  choose_next(ray, cluster_hits);
}

template <class T>
void DistributedTracer::route(T&& ray) {
  constexpr bool kIsShadow = std::is_same_v<std::decay_t<T>, ShadowMessage>;
  const auto append = [&](auto& to) {
    if constexpr (kIsShadow)
      to.shadows.push_back(std::forward<T>(ray));
    else
      to.rays.push_back(std::forward<T>(ray));
  };
  if (ray.way.next == kOnward) {
    ++ray.way.hops;
    ray.way.last = {-1.0F, 0};
    const int next = (communicator_.rank() + 1) % communicator_.size();
    if (next != communicator_.rank()) {
      append(to_intersect_[static_cast<std::size_t>(next)]);
      return;
    }
    ray.way.next = kMiss;  // alone there is nobody to go round
  }
  if (ray.way.next != kMiss) {
    append(waiting_[ray.way.next]);
  } else if (ray.return_address.rank == communicator_.rank()) {
    deliver(ray);
  } else {
    append(to_answer_[static_cast<std::size_t>(ray.return_address.rank)]);
  }
}

void DistributedTracer::deliver(const RayMessage& ray) {
  PixelTask& pixel_task = pixel_tasks_[ray.return_address.pixel_task];
  RayGroup& group = pixel_task.integrator->batch().rays[ray.return_address.group];
  const int i = ray.return_address.lane;
  if (ray.instance != kMiss) {
    group.packet.far[i] = ray.far;
    group.packet.u[i] = ray.u;
    group.packet.v[i] = ray.v;
    group.packet.triangle[i] = ray.triangle;
    group.packet.geometry[i] = ray.instance;
    group.packet.instance[i] = kMiss;
    group.hits |= 1U << i;
    group.material[i] = ray.material;
    group.offset[i] = ray.offset;
    if (ray.return_address.coloured != 0 && !group.points.coloured) {
      group.points.coloured = true;
      for (int k = 0; k < kPacketRays; ++k) {
        group.points.colour.set(k, glm::vec3(1.0F));
        group.points.colour_alpha[k] = 1.0F;
      }
    }
    shading::set_point(group.points, i, ray.point);
  }
  if (--pixel_task.open == 0) ready_.push_back(ray.return_address.pixel_task);
}

void DistributedTracer::deliver(const ShadowMessage& shadow) {
  PixelTask& pixel_task = pixel_tasks_[shadow.return_address.pixel_task];
  ShadowGroup& group = pixel_task.integrator->batch().shadows[shadow.return_address.group];
  const int i = shadow.return_address.lane;
  if (!shadow.occluded) {
    group.lit |= 1U << i;
    if (shadow.layers > 0) {
      Layer layers[SeeThrough::kMost];
      std::copy_n(shadow.layer, shadow.layers, layers);
      group.attenuated |= 1U << i;
      group.transmittance.set(i, transmittance_of({layers, shadow.layers}));
    }
  }
  if (--pixel_task.open == 0) ready_.push_back(shadow.return_address.pixel_task);
}

bool DistributedTracer::intersect_clusters() {
  struct ClusterBatch {
    std::shared_ptr<const Cluster> cluster;
    RayQueue waiting;
    double busy = 0;
  };
  std::vector<ClusterBatch> batches;
  // A cluster that has just come stays until its rays have been intersected, however little room
  // there is.
  for (auto& [number, cluster] : arrived_) {
    const auto at = waiting_.find(number);
    if (at == waiting_.end()) continue;
    batches.push_back({std::move(cluster), std::move(at->second)});
    waiting_.erase(at);
  }
  arrived_.clear();
  for (auto at = waiting_.begin(); at != waiting_.end();) {
    std::shared_ptr<const Cluster> cluster = scene_.find(at->first);
    if (cluster == nullptr) {
      ++at;
      continue;
    }
    batches.push_back({std::move(cluster), std::move(at->second)});
    at = waiting_.erase(at);
  }
  if (batches.empty()) return false;
  parallel::parallel_for(0, batches.size(), 1, [&](std::size_t i) {
    const FlushToZero flush;
    const double start = thread_seconds();
    intersect_cluster(*batches[i].cluster, scene_.shader(), kernels_, batches[i].waiting);
    std::vector<ClusterHit> cluster_hits;
    for (RayMessage& ray : batches[i].waiting.rays) choose_next(ray, cluster_hits);
    for (ShadowMessage& shadow : batches[i].waiting.shadows) choose_next(shadow, cluster_hits);
    batches[i].busy = thread_seconds() - start;
  });
  std::uint64_t tests = 0;
  for (ClusterBatch& each : batches) {
    busy_ += each.busy;
    tests += each.waiting.size();
    for (RayMessage& ray : each.waiting.rays) route(std::move(ray));
    for (ShadowMessage& shadow : each.waiting.shadows) route(std::move(shadow));
  }
  counts_.tests += tests;
  communicator_.work(comm::Work::rays, tests);
  return true;
}

void DistributedTracer::decide_waiting(bool idle) {
  if (ring_) return;
  for (auto at = waiting_.begin(); at != waiting_.end();) {
    const std::uint32_t number = at->first;
    RayQueue& waiting = at->second;
    // What is at hand by now waits for the next turn.
    if (fetching_.contains(number) || scene_.find(number) != nullptr) {
      ++at;
      continue;
    }
    WaitingList list;
    list.cluster = number;
    list.rays = waiting.size();
    list.ray_bytes = waiting.rays.size() * sizeof(RayMessage) +
                     waiting.shadows.size() * offsetof(ShadowMessage, layer);
    list.cluster_bytes = scene_.packed_bytes(number);
    list.idle = idle;
    const auto owner = static_cast<std::size_t>(scene_.owner(number));
    switch (distribution_.decide(list)) {
      case RoutingDecision::wait:
        ++at;
        break;
      case RoutingDecision::fetch_cluster: {
        MessageHeader header;
        header.kind = MessageKind::fetch;
        header.cluster = number;
        send(static_cast<int>(owner), with_header(header, {}));
        fetching_.insert(number);
        ++at;
        break;
      }
      case RoutingDecision::send_rays: {
        RayQueue& to = to_intersect_[owner];
        to.rays.insert(to.rays.end(), waiting.rays.begin(), waiting.rays.end());
        to.shadows.insert(to.shadows.end(), waiting.shadows.begin(), waiting.shadows.end());
        at = waiting_.erase(at);
        break;
      }
    }
  }
}

void DistributedTracer::send_all(bool idle) {
  for (int rank = 0; rank < communicator_.size(); ++rank) {
    const auto send_batch = [&](MessageKind kind, RayQueue& out) {
      const std::size_t count = out.rays.size() + out.shadows.size();
      if (count == 0 || (!idle && count < kBatchRays)) return false;
      (kind == MessageKind::intersect ? counts_.rays_sent : counts_.answers_sent) += count;
      send(rank, pack(kind, out.rays, out.shadows));
      out.rays.clear();
      out.shadows.clear();
      return true;
    };
    send_batch(MessageKind::intersect, to_intersect_[static_cast<std::size_t>(rank)]);
    send_batch(MessageKind::answer, to_answer_[static_cast<std::size_t>(rank)]);
  }
}

void DistributedTracer::balance_load() {
  const int ranks = communicator_.size();
  if (ranks == 1) return;
  const std::uint64_t load = counts_.tests;
  if (loads_.tell(load)) {
    MessageHeader header;
    header.kind = MessageKind::load;
    header.load = load;
    send((communicator_.rank() + ranks - 1) % ranks, with_header(header, {}));
  }
  if (!loads_.should_give(load) || scene_.owned().size() < 2) return;
  // One that no ray waits for. Rays that come later find it on the next rank: on the same way, in
  // the order of sending, it is there before them.
  for (const auto& [number, cluster] : scene_.owned()) {
    if (waiting_.contains(number)) continue;
    MessageHeader header;
    header.kind = MessageKind::move;
    header.cluster = number;
    const int next = (communicator_.rank() + 1) % ranks;
    comm::Buffer message = with_header(header, raytrace::pack(cluster->data()));
    scene_.give_away(number);
    send(next, std::move(message));
    ++counts_.clusters_moved;
    loads_.gave(load);
    return;
  }
}

}  // namespace delray::raytrace
