#include "raytrace/distributed/ray_traffic.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <utility>

#include "comm/collectives.h"
#include "parallel/parallel_for.h"
#include "raytrace/distributed/distributions.h"
#include "raytrace/distributed/ray_messages.h"
#include "raytrace/scene/flush_to_zero.h"

namespace delray::raytrace {
namespace {

// Beside those of schedules, which are used meanwhile.
constexpr comm::Tag kTagTraffic = 200, kTagControl = 201;

constexpr std::uint32_t kOnward = kMiss - 1;  // Progression::next: to the next rank of the ring

// Walks in the making on a rank: enough that some are ready while the others' questions travel.
constexpr std::size_t kMostStrands = 96;

// A rank looks whether messages have come at least so often while it waits.
constexpr auto kMoment = std::chrono::microseconds(100);

bool is_decided(const TravellingRay&) { return false; }
bool is_decided(const TravellingShadow& shadow) { return shadow.occluded; }

}  // namespace

RayTraffic::RayTraffic(comm::Communicator& communicator, SharedScene& scene,
                       const Distribution& distribution, const TiledFrame& frame)
    : communicator_(communicator),
      scene_(scene),
      distribution_(distribution),
      frame_(frame),
      last_sample_(frame.options.part.first_sample + samples_of(frame.options)),
      kernels_{scene.has_instances()},
      termination_(communicator, kTagControl),
      ring_(distribution.meet == nullptr),
      to_meet_(static_cast<std::size_t>(communicator.size())),
      to_answer_(static_cast<std::size_t>(communicator.size())) {}

void RayTraffic::add(std::uint32_t number) {
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
      free_.push_back(static_cast<std::uint32_t>(strands_.size()));
      strands_.emplace_back();
    }
    const std::uint32_t index = free_.back();
    free_.pop_back();
    Strand& strand = strands_[index];
    strand.walk = frame_.walks.take();
    strand.tile = &tile;
    strand.task = task;
    strand.started = false;
    ++tile.strands;
    ++in_flight_;
    ready_.push_back(index);
  }
  while (in_flight_ > kMostStrands) {
    if (!serve()) wait_a_moment();
  }
}

bool RayTraffic::serve() {
  receive_all();
  bool any = work_at_walks();
  any = work_at_clusters() || any;
  const std::uint64_t before = termination_sent_;
  look_at_waiting(!any);
  if (ring_) even_out();
  send_all(!any);
  return any || termination_sent_ != before;
}

void RayTraffic::wait_a_moment() {
  communicator_.probe(comm::kAnyRank, kTagTraffic, comm::Deadline::in(kMoment));
}

void RayTraffic::finish() {
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

void RayTraffic::send(int to, comm::Buffer&& message) {
  communicator_.send(to, kTagTraffic, std::move(message));
  termination_.count_sent();
  ++termination_sent_;
}

void RayTraffic::receive_all() {
  while (const auto envelope =
             communicator_.probe(comm::kAnyRank, kTagTraffic, comm::Deadline::now()))
    receive(*envelope);
}

void RayTraffic::receive(const comm::Envelope& envelope) {
  const comm::Buffer message = communicator_.receive(envelope.source, kTagTraffic);
  termination_.count_received();
  const MessageHeader header = header_of(message);
  const std::span<const std::byte> content(message.data() + sizeof(MessageHeader),
                                           message.size() - sizeof(MessageHeader));
  switch (header.kind) {
    case MessageKind::meet: {
      std::vector<Crossing> crossings;
      const auto take_in = [&](auto&& ray) {
        if (ring_) choose_next(ray, crossings);
        route(std::move(ray));
      };
      Travellers travellers = unpack_travellers(message, header);
      for (TravellingRay& ray : travellers.rays) take_in(std::move(ray));
      for (TravellingShadow& shadow : travellers.shadows) take_in(std::move(shadow));
      break;
    }
    case MessageKind::answer: {
      const Travellers travellers = unpack_travellers(message, header);
      for (const TravellingRay& ray : travellers.rays) deliver(ray);
      for (const TravellingShadow& shadow : travellers.shadows) deliver(shadow);
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

bool RayTraffic::work_at_walks() {
  if (ready_.empty()) return false;
  const std::vector<std::uint32_t> ready = std::exchange(ready_, {});
  struct Asked {
    std::vector<TravellingRay> rays;
    std::vector<TravellingShadow> shadows;
    double busy = 0;
  };
  std::vector<Asked> asked(ready.size());
  parallel::parallel_for(0, ready.size(), 1, [&](std::size_t i) {
    const FlushToZero flush;
    const double start = thread_seconds();
    Strand& strand = strands_[ready[i]];
    if (strand.started)
      strand.walk->go_on();
    else
      strand.walk->start(strand.task);
    strand.started = true;
    if (!strand.walk->done()) ask(ready[i], asked[i].rays, asked[i].shadows);
    asked[i].busy = thread_seconds() - start;
  });
  for (std::size_t i = 0; i < ready.size(); ++i) {
    Strand& strand = strands_[ready[i]];
    busy_ += asked[i].busy;
    strand.tile->pixels.busy += asked[i].busy;
    if (strand.walk->done()) {
      end_sample(ready[i]);
      continue;
    }
    strand.open = asked[i].rays.size() + asked[i].shadows.size();
    for (TravellingRay& ray : asked[i].rays) route(std::move(ray));
    for (TravellingShadow& shadow : asked[i].shadows) route(std::move(shadow));
  }
  return true;
}

void RayTraffic::end_sample(std::uint32_t index) {
  Strand& strand = strands_[index];
  add_samples(frame_, *strand.walk, strand.task, strand.tile->pixels);
  strand.started = false;
  if (++strand.task.first_sample < last_sample_) {
    ready_.push_back(index);
    return;
  }
  frame_.walks.give(std::move(strand.walk));
  free_.push_back(index);
  --in_flight_;
  Tile* const tile = std::exchange(strand.tile, nullptr);
  if (--tile->strands > 0) return;
  done_.push_back(std::move(tile->pixels));
  std::erase_if(open_tiles_, [tile](const auto& open) { return open.get() == tile; });
}

void RayTraffic::ask(std::uint32_t index, std::vector<TravellingRay>& rays,
                     std::vector<TravellingShadow>& shadows) {
  Wave& wave = strands_[index].walk->wave();
  std::vector<Crossing> crossings;
  Asker asker;
  asker.rank = communicator_.rank();
  asker.strand = index;
  for (std::uint32_t g = 0; g < wave.rays.size(); ++g) {
    RayGroup& group = wave.rays[g];
    group.hits = 0;
    group.points.coloured = false;
    const RayPacket& p = group.packet;
    for (int i = 0; i < kPacketRays; ++i) {
      if (group.active.ray[i] == 0) continue;
      TravellingRay& ray = rays.emplace_back();
      ray.asker = asker;
      ray.asker.group = g;
      ray.asker.lane = static_cast<std::uint8_t>(i);
      ray.asker.coherent = group.coherent ? 1 : 0;
      ray.origin = {p.origin_x[i], p.origin_y[i], p.origin_z[i]};
      ray.near = p.near[i];
      ray.direction = {p.direction_x[i], p.direction_y[i], p.direction_z[i]};
      ray.far = p.far[i];
      ray.view = group.view.get(i);
      ray.width = group.width[i];
      ray.spread = group.spread[i];
      ray.way.stamp = taken_over_.size();
      choose_next(ray, crossings);
    }
  }
  for (std::uint32_t g = 0; g < wave.shadows.size(); ++g) {
    ShadowGroup& group = wave.shadows[g];
    group.lit = group.dimmed = 0;
    const ShadowPacket& p = group.packet;
    for (int i = 0; i < kPacketRays; ++i) {
      if (group.active.ray[i] == 0) continue;
      TravellingShadow& shadow = shadows.emplace_back();
      shadow.asker = asker;
      shadow.asker.group = g;
      shadow.asker.lane = static_cast<std::uint8_t>(i);
      shadow.asker.coherent = group.coherent ? 1 : 0;
      shadow.asker.through_glass = (group.through_glass >> i & 1) != 0 ? 1 : 0;
      shadow.origin = {p.origin_x[i], p.origin_y[i], p.origin_z[i]};
      shadow.near = p.near[i];
      shadow.direction = {p.direction_x[i], p.direction_y[i], p.direction_z[i]};
      shadow.far = p.far[i];
      shadow.way.stamp = taken_over_.size();
      choose_next(shadow, crossings);
    }
  }
}

template <class T>
void RayTraffic::choose_next(T& ray, std::vector<Crossing>& crossings) const {
  ray.way.next = kMiss;
  if (is_decided(ray)) return;
  scene_.tree().find(ray.origin, ray.direction, ray.near, ray.far, crossings);
  const bool is_back = ring_ && ray.way.hops == static_cast<std::uint32_t>(communicator_.size());
  // What came to this rank while the ray was under way may have been nowhere when it was there.
  const auto times_it_came = [&](const Crossing& crossing) {
    return std::count(taken_over_.begin() + static_cast<std::ptrdiff_t>(ray.way.stamp),
                      taken_over_.end(), crossing.cluster);
  };
  for (const Crossing& crossing : crossings) {
    if (!(ray.way.last < crossing)) continue;
    if (ring_ && !scene_.owns(crossing.cluster)) continue;
    if (is_back && times_it_came(crossing) == 0) continue;
    ray.way.last = crossing;
    ray.way.next = crossing.cluster;
    return;
  }
  if (!ring_) return;
  if (!is_back) {
    ray.way.next = kOnward;
    return;
  }
  // What has gone on since is behind the ray, which goes round once more then.
  const bool missed =
      std::any_of(crossings.begin(), crossings.end(), [&](const Crossing& crossing) {
        return times_it_came(crossing) > (scene_.owns(crossing.cluster) ? 1 : 0);
      });
  if (!missed) return;
  ray.way.hops = 0;
  ray.way.stamp = taken_over_.size();
  ray.way.last = {-1.0F, 0};
  choose_next(ray, crossings);
}

template <class T>
void RayTraffic::route(T&& ray) {
  constexpr bool kIsShadow = std::is_same_v<std::decay_t<T>, TravellingShadow>;
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
      append(to_meet_[static_cast<std::size_t>(next)]);
      return;
    }
    ray.way.next = kMiss;  // alone there is nobody to go round
  }
  if (ray.way.next != kMiss) {
    append(waiting_[ray.way.next]);
  } else if (ray.asker.rank == communicator_.rank()) {
    deliver(ray);
  } else {
    append(to_answer_[static_cast<std::size_t>(ray.asker.rank)]);
  }
}

void RayTraffic::deliver(const TravellingRay& ray) {
  Strand& strand = strands_[ray.asker.strand];
  RayGroup& group = strand.walk->wave().rays[ray.asker.group];
  const int i = ray.asker.lane;
  if (ray.placement != kMiss) {
    group.packet.far[i] = ray.far;
    group.packet.u[i] = ray.u;
    group.packet.v[i] = ray.v;
    group.packet.triangle[i] = ray.triangle;
    group.packet.geometry[i] = ray.placement;
    group.packet.instance[i] = kMiss;
    group.hits |= 1U << i;
    group.material[i] = ray.material;
    group.offset[i] = ray.offset;
    if (ray.asker.coloured != 0 && !group.points.coloured) {
      group.points.coloured = true;
      for (int k = 0; k < kPacketRays; ++k) {
        group.points.colour.set(k, glm::vec3(1.0F));
        group.points.colour_alpha[k] = 1.0F;
      }
    }
    shading::set_point(group.points, i, ray.point);
  }
  if (--strand.open == 0) ready_.push_back(ray.asker.strand);
}

void RayTraffic::deliver(const TravellingShadow& shadow) {
  Strand& strand = strands_[shadow.asker.strand];
  ShadowGroup& group = strand.walk->wave().shadows[shadow.asker.group];
  const int i = shadow.asker.lane;
  if (!shadow.occluded) {
    group.lit |= 1U << i;
    if (shadow.layers > 0) {
      Layer layers[SeeThrough::kMost];
      std::copy_n(shadow.layer, shadow.layers, layers);
      group.dimmed |= 1U << i;
      group.left.set(i, left_by({layers, shadow.layers}));
    }
  }
  if (--strand.open == 0) ready_.push_back(shadow.asker.strand);
}

bool RayTraffic::work_at_clusters() {
  struct Met {
    std::shared_ptr<const Cluster> cluster;
    Waiting waiting;
    double busy = 0;
  };
  std::vector<Met> met;
  // What has just come stays until its rays have met it, however little room there is.
  for (auto& [number, cluster] : arrived_) {
    const auto at = waiting_.find(number);
    if (at == waiting_.end()) continue;
    met.push_back({std::move(cluster), std::move(at->second)});
    waiting_.erase(at);
  }
  arrived_.clear();
  for (auto at = waiting_.begin(); at != waiting_.end();) {
    std::shared_ptr<const Cluster> cluster = scene_.find(at->first);
    if (cluster == nullptr) {
      ++at;
      continue;
    }
    met.push_back({std::move(cluster), std::move(at->second)});
    at = waiting_.erase(at);
  }
  if (met.empty()) return false;
  parallel::parallel_for(0, met.size(), 1, [&](std::size_t i) {
    const FlushToZero flush;
    const double start = thread_seconds();
    meet_cluster(*met[i].cluster, scene_.shader(), kernels_, met[i].waiting);
    std::vector<Crossing> crossings;
    for (TravellingRay& ray : met[i].waiting.rays) choose_next(ray, crossings);
    for (TravellingShadow& shadow : met[i].waiting.shadows) choose_next(shadow, crossings);
    met[i].busy = thread_seconds() - start;
  });
  std::uint64_t tests = 0;
  for (Met& each : met) {
    busy_ += each.busy;
    tests += each.waiting.size();
    for (TravellingRay& ray : each.waiting.rays) route(std::move(ray));
    for (TravellingShadow& shadow : each.waiting.shadows) route(std::move(shadow));
  }
  counts_.tests += tests;
  communicator_.work(comm::Work::rays, tests);
  return true;
}

void RayTraffic::look_at_waiting(bool hungry) {
  if (ring_) return;
  for (auto at = waiting_.begin(); at != waiting_.end();) {
    const std::uint32_t number = at->first;
    Waiting& waiting = at->second;
    // What is at hand by now waits for the next turn.
    if (fetching_.contains(number) || scene_.find(number) != nullptr) {
      ++at;
      continue;
    }
    WaitingList list;
    list.cluster = number;
    list.rays = waiting.size();
    list.ray_bytes = waiting.rays.size() * sizeof(TravellingRay) +
                     waiting.shadows.size() * offsetof(TravellingShadow, layer);
    list.cluster_bytes = scene_.packed_bytes(number);
    list.hungry = hungry;
    const auto owner = static_cast<std::size_t>(scene_.owner(number));
    switch (distribution_.meet(list)) {
      case Meeting::wait:
        ++at;
        break;
      case Meeting::fetch_cluster: {
        MessageHeader header;
        header.kind = MessageKind::fetch;
        header.cluster = number;
        send(static_cast<int>(owner), with_header(header, {}));
        fetching_.insert(number);
        ++at;
        break;
      }
      case Meeting::send_rays: {
        Outgoing& to = to_meet_[owner];
        to.rays.insert(to.rays.end(), waiting.rays.begin(), waiting.rays.end());
        to.shadows.insert(to.shadows.end(), waiting.shadows.begin(), waiting.shadows.end());
        at = waiting_.erase(at);
        break;
      }
    }
  }
}

void RayTraffic::send_all(bool hungry) {
  for (int rank = 0; rank < communicator_.size(); ++rank) {
    const auto send_batch = [&](MessageKind kind, Outgoing& out) {
      const std::size_t count = out.rays.size() + out.shadows.size();
      if (count == 0 || (!hungry && count < kBatchRays)) return false;
      (kind == MessageKind::meet ? counts_.rays_sent : counts_.answers_sent) += count;
      send(rank, pack(kind, out.rays, out.shadows));
      out.rays.clear();
      out.shadows.clear();
      return true;
    };
    send_batch(MessageKind::meet, to_meet_[static_cast<std::size_t>(rank)]);
    send_batch(MessageKind::answer, to_answer_[static_cast<std::size_t>(rank)]);
  }
}

void RayTraffic::even_out() {
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
