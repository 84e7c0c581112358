// Traces a frame over a distributed scene. Integrators advance as far as their rays are decided by
// what is resident; other rays are intersected with one cluster after the other, here or on other
// ranks, as the router says, and return to their own rank with what they found. The end is detected
// by counting messages (comm/termination.h).
#include "raytrace/distributed/distributed_tracer.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <utility>

#include "comm/collectives.h"
#include "parallel/arena.h"
#include "parallel/parallel_for.h"
#include "raytrace/distributed/distributions.h"
#include "raytrace/distributed/tile_owners.h"
#include "raytrace/scene/flush_to_zero.h"

namespace delray::raytrace {
namespace {

constexpr comm::Tag kTagControl = 201;  // RayMessenger::kTag is of rays

// Tasks in the making on a rank: enough that some are ready while the others' rays travel, and
// that many rays wait for a cluster which is fetched, so that it comes less often.
constexpr std::size_t kMostPixelTasks = 384;

// Tasks that are advanced at a time where rays travel: enough that those that wait for one cluster
// fill packets.
constexpr std::size_t kReadyAtOnce = 32;
// That each thread advances at a time: enough that all threads are busy most of the time, and few,
// as others wait for answers meanwhile.
constexpr std::size_t kReadyForThread = 8;

// A rank looks whether messages have come at least so often while it waits.
constexpr auto kMoment = std::chrono::microseconds(100);

// Tiles that are passed on in one message: few, as their rank may have nothing else to do.
constexpr std::size_t kTilesAtOnce = 16;

// Rays that threads intersect with resident clusters at a time.
constexpr std::size_t kRaysAtOnce = 1024;

bool is_decided(const RayMessage&) { return false; }
bool is_decided(const ShadowMessage& shadow) { return shadow.return_address.occluded != 0; }

std::unique_ptr<RayRouter> make_router(const Distribution& distribution,
                                       const RoutingContext& context) {
  return distribution.decide != nullptr ? make_cluster_router(distribution, context)
                                        : make_ring_router(context);
}

}  // namespace

DistributedTracer::DistributedTracer(comm::Communicator& communicator, SharedScene& scene,
                                     const Distribution& distribution, const TiledFrame& frame,
                                     std::span<const std::int32_t> plan)
    : communicator_(communicator),
      scene_(scene),
      frame_(frame),
      last_sample_(frame.options.part.first_sample + samples_of(frame.options)),
      ready_at_once_(kReadyAtOnce),
      passes_tiles_on_(scene.file() == nullptr &&
                       !(distribution.fetches && scene.has_room_for_all())),
      plans_tiles_(distribution.plans_tiles && passes_tiles_on_ && communicator.size() > 1),
      plan_(plan),
      kernels_{scene.has_instances()},
      termination_(communicator, kTagControl),
      messenger_(communicator, termination_) {
  const auto ranks = static_cast<std::size_t>(communicator.size());
  const std::size_t threads = static_cast<std::size_t>(parallel::arena_threads());
  if (distribution.decide == nullptr) scene_.learn_owners(communicator);
  scene_.begin_frame(distribution.chooses);
  if (scene_.elsewhere().empty()) {
    passes_tiles_on_ = false;
    ready_at_once_ = threads == 1 ? 1 : kReadyForThread * threads;
  }
  waiting_.to_intersect.resize(ranks);
  waiting_.to_answer.resize(ranks);
  tiles_to_send_.resize(ranks);
  router_ = make_router(distribution, {scene_, messenger_, waiting_, counts_});
}

int DistributedTracer::rank_of_tile(std::uint32_t tile) const {
  const int rank = communicator_.rank();
  if (!plan_.empty() && plan_[tile] != kNoPlan) return plan_[tile];
  return owner_of_tile(frame_, scene_, rank, tile);
}

void DistributedTracer::add(std::uint32_t tile) {
  if (passes_tiles_on_) {
    // At once, and its own later: the others wait for what it passes on.
    const int owner = rank_of_tile(tile);
    if (owner == communicator_.rank()) {
      waiting_tiles_.push_back(tile);
      return;
    }
    std::vector<std::uint32_t>& tiles = tiles_to_send_[static_cast<std::size_t>(owner)];
    tiles.push_back(tile);
    if (tiles.size() >= kTilesAtOnce) send_all(false);
    return;
  }
  start(tile);
  if (ready_.size() >= ready_at_once_) serve();
  while (in_flight_ > kMostPixelTasks) {
    if (!serve()) wait_a_moment();
  }
}

// As many as there is room for. Returns whether any.
bool DistributedTracer::start_waiting_tiles() {
  bool any = false;
  for (; !waiting_tiles_.empty() && in_flight_ <= kMostPixelTasks; any = true) {
    const std::uint32_t next = waiting_tiles_.front();
    waiting_tiles_.pop_front();
    start(next);
  }
  return any;
}

void DistributedTracer::start(std::uint32_t number) {
  TilePixels pixels = start_tile(frame_, number);
  const std::vector<Task> tasks = tasks_of(frame_, pixels.rect, frame_.integrators.side());
  if (tasks.empty()) {
    end_tile(std::move(pixels));
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
    pixel_task.tile = &tile;
    pixel_task.task = task;
    pixel_task.started = false;
    ++tile.pixel_tasks;
    ++in_flight_;
    ready_.push_back(index);
  }
}

bool DistributedTracer::serve() {
  receive_all();
  bool any = start_waiting_tiles();
  any = advance_pixel_tasks() || any;
  any = intersect_waiting() || any;
  const std::uint64_t before = messenger_.sent();
  router_->take_turn(!any);
  send_all(!any);
  return any || messenger_.sent() != before || !waiting_.arrived.empty();
}

void DistributedTracer::wait_a_moment() {
  communicator_.probe(comm::kAnyRank, RayMessenger::kTag, comm::Deadline::in(kMoment));
}

void DistributedTracer::finish() {
  send_all(true);  // the last tiles that are passed on, before own ones are begun
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
  scene_.note_travel(travelled_ / 2, travel_seconds_);
  // Who begins something else must not be heard by those who are not done.
  comm::barrier(communicator_);
}

void DistributedTracer::receive_all() {
  while (const auto envelope =
             communicator_.probe(comm::kAnyRank, RayMessenger::kTag, comm::Deadline::now()))
    receive(*envelope);
}

// Rays that came from others, and answers: each ray counts here and there.
void DistributedTracer::note_travel(std::uint64_t rays, double start) {
  travelled_ += rays;
  travel_seconds_ += thread_seconds() - start;
}

void DistributedTracer::receive(const comm::Envelope& envelope) {
  const comm::Buffer message = communicator_.receive(envelope.source, RayMessenger::kTag);
  termination_.count_received();
  const MessageHeader header = header_of(message);
  messenger_.hear_load(envelope.source, header.load);
  const double start = thread_seconds();
  switch (header.kind) {
    case MessageKind::intersect: {
      RayQueue queue = unpack_rays(message, header);
      if (!queue.empty()) waiting_.at_resident.push_back(std::move(queue));
      note_travel(header.rays + header.shadows, start);
      break;
    }
    case MessageKind::answer: {
      const RayQueue queue = unpack_rays(message, header);
      for (const RayMessage& ray : queue.rays) end_ray(ray);
      for (const ShadowMessage& shadow : queue.shadows) end_ray(shadow);
      note_travel(header.rays + header.shadows, start);
      break;
    }
    case MessageKind::tiles:
      for (const std::uint32_t tile : unpack_tiles(message, frame_.tiles.grid().count()))
        waiting_tiles_.push_back(tile);
      break;
    default:
      router_->receive(
          envelope.source, header,
          {message.data() + sizeof(MessageHeader), message.size() - sizeof(MessageHeader)});
  }
}

bool DistributedTracer::advance_pixel_tasks() {
  if (ready_.empty()) return false;
  const std::size_t most = kReadyForThread * static_cast<std::size_t>(parallel::arena_threads());
  const auto first = ready_.end() - static_cast<std::ptrdiff_t>(std::min(most, ready_.size()));
  const std::vector<std::uint32_t> ready(first, ready_.end());
  ready_.erase(first, ready_.end());
  std::vector<Advanced> advanced(ready.size());
  parallel::parallel_for(0, ready.size(), 1,
                         [&](std::size_t i) { advanced[i] = advance(ready[i]); });
  std::uint64_t tests = 0;
  for (std::size_t i = 0; i < ready.size(); ++i) {
    PixelTask& pixel_task = pixel_tasks_[ready[i]];
    tests += advanced[i].tests;
    busy_ += advanced[i].busy;
    pixel_task.tile->pixels.busy += advanced[i].busy;
    pixel_task.tile->pixels.rays += advanced[i].rays;
    pixel_task.open = advanced[i].travelling.size();
    if (advanced[i].done) {
      end_task(ready[i]);
    } else {
      route_all(std::move(advanced[i].travelling));
    }
  }
  counts_.tests += tests;
  communicator_.work(comm::Work::rays, tests);
  return true;
}

// Until it is done or some rays have to travel. It takes an integrator when it begins and gives it
// back when it is done, so that tasks of which no ray travels have one after the other the same,
// which is in the caches.
DistributedTracer::Advanced DistributedTracer::advance(std::uint32_t index) {
  const FlushToZero flush;
  const double start = thread_seconds();
  PixelTask& pixel_task = pixel_tasks_[index];
  if (pixel_task.integrator == nullptr) pixel_task.integrator = frame_.integrators.take();
  WavefrontIntegrator& integrator = *pixel_task.integrator;
  const HomeScene home{scene_.resident().local(scene_.shader()), frame_.context.shader, kernels_,
                       scene_.elsewhere(), *router_};
  ReturnAddress address;
  address.rank = communicator_.rank();
  address.pixel_task = index;
  Advanced advanced;
  while (!advanced.done && advanced.travelling.empty()) {
    if (std::exchange(pixel_task.started, true))
      integrator.advance();
    else
      integrator.start(pixel_task.task);
    if (!integrator.done()) {
      advanced.tests += intersect_at_home(home, address, integrator.batch(), advanced.travelling);
      continue;
    }
    add_samples(frame_, integrator.samples(), pixel_task.task, pixel_task.tile->pixels);
    advanced.rays += integrator.rays();
    advanced.rays.surplus += surplus_of(frame_, pixel_task.tile->pixels.rect, pixel_task.task);
    pixel_task.started = false;
    advanced.done = ++pixel_task.task.first_sample == last_sample_;
  }
  if (advanced.done) frame_.integrators.give(std::move(pixel_task.integrator));
  advanced.busy = thread_seconds() - start;
  return advanced;
}

void DistributedTracer::end_task(std::uint32_t index) {
  free_.push_back(index);
  --in_flight_;
  Tile* const tile = std::exchange(pixel_tasks_[index].tile, nullptr);
  if (--tile->pixel_tasks > 0) return;
  if (plans_tiles_) {
    const double for_answer = answers_ > 0 ? waiting_seconds_ / static_cast<double>(answers_) : 0.0;
    const std::uint32_t number = tile->pixels.tile;
    planned_.push_back({number, owner_of_tile(frame_, scene_, communicator_.rank(), number),
                        tile->pixels.busy + for_answer * static_cast<double>(tile->answers),
                        communicator_.rank()});
  }
  end_tile(std::move(tile->pixels));
  std::erase_if(open_tiles_, [tile](const auto& open) { return open.get() == tile; });
}

void DistributedTracer::end_tile(TilePixels&& pixels) {
  done_.push_back(std::move(pixels));
  if (frame_.options.progress != nullptr) frame_.options.progress->advance();
}

template <class Message>
void DistributedTracer::choose_next(Message& message) const {
  TravellingRay& ray = message.ray;
  ray.way.next = kMiss;
  if (is_decided(message)) return;
  router_->choose_next({ray.origin, glm::vec3(1.0F) / ray.direction, ray.near, far_of(message)},
                       ray.way);
}

template <class Message>
void DistributedTracer::route(Message&& message) {
  const std::uint32_t next = message.ray.way.next;
  const int rank = communicator_.rank(), home = message.return_address.rank;
  if (next == RayRouter::kOnward) {
    const auto hops = static_cast<std::size_t>(message.ray.way.hops);
    const std::size_t to = (static_cast<std::size_t>(home) + hops) % waiting_.to_intersect.size();
    waiting_.to_intersect[to].push(std::forward<Message>(message));
  } else if (next != kMiss) {
    waiting_.by_cluster[next].push(std::move(message));
  } else if (home == rank) {
    end_ray(message);
  } else {
    waiting_.to_answer[static_cast<std::size_t>(home)].push(std::move(message));
  }
}

void DistributedTracer::route_all(RayQueue&& queue) {
  for (RayMessage& ray : queue.rays) route(std::move(ray));
  for (ShadowMessage& shadow : queue.shadows) route(std::move(shadow));
}

template <class Message>
void DistributedTracer::end_ray(const Message& message) {
  const std::uint32_t index = message.return_address.pixel_task;
  PixelTask& pixel_task = pixel_tasks_[index];
  deliver(message, pixel_task.integrator->batch());
  ++pixel_task.tile->answers;
  ++answers_;
  if (--pixel_task.open == 0) ready_.push_back(index);
}

bool DistributedTracer::intersect_waiting() {
  std::vector<RayQueue> queues;
  std::vector<std::shared_ptr<const ClusterScene>> held;  // null: the resident scene
  std::vector<std::uint32_t> numbers;                     // of clusters that are not resident
  const auto take = [&](std::shared_ptr<const ClusterScene> clusters, RayQueue&& queue) {
    held.push_back(std::move(clusters));
    queues.push_back(std::move(queue));
  };
  auto& by_cluster = waiting_.by_cluster;
  for (auto& [number, clusters] : std::exchange(waiting_.arrived, {})) {
    const auto at = by_cluster.find(number);
    if (at == by_cluster.end()) continue;
    numbers.push_back(number);
    take(clusters, std::move(at->second));
    by_cluster.erase(at);
  }
  for (auto at = by_cluster.begin(); at != by_cluster.end();) {
    std::shared_ptr<const ClusterScene> clusters = scene_.find(at->first);
    if (clusters == nullptr) {
      ++at;
      continue;
    }
    numbers.push_back(at->first);
    take(std::move(clusters), std::move(at->second));
    at = by_cluster.erase(at);
  }
  std::uint64_t tests = 0;
  for (std::size_t i = 0; i < queues.size(); ++i) {
    tests += queues[i].size();
    scene_.note_wanted(numbers[i], queues[i].size());
  }
  scene_.note_tests(tests);
  for (RayQueue& queue : std::exchange(waiting_.at_resident, {})) {
    tests += queue.size();
    take(nullptr, std::move(queue));
  }
  if (queues.empty()) return false;

  std::vector<ClusterBatch> batches;
  for (std::size_t i = 0; i < queues.size(); ++i) {
    const ClusterScene* clusters = held[i] != nullptr ? held[i].get() : &scene_.resident();
    const std::span<RayMessage> rays = queues[i].rays;
    const std::span<ShadowMessage> shadows = queues[i].shadows;
    for (std::size_t k = 0; k < rays.size(); k += kRaysAtOnce)
      batches.push_back({clusters, rays.subspan(k, std::min(kRaysAtOnce, rays.size() - k)), {}});
    for (std::size_t k = 0; k < shadows.size(); k += kRaysAtOnce)
      batches.push_back(
          {clusters, {}, shadows.subspan(k, std::min(kRaysAtOnce, shadows.size() - k))});
  }
  parallel::parallel_for(0, batches.size(), 1, [&](std::size_t i) { intersect(batches[i]); });
  for (const ClusterBatch& batch : batches) {
    busy_ += batch.busy;
    (batch.clusters == &scene_.resident() ? travel_seconds_ : waiting_seconds_) += batch.busy;
  }
  for (RayQueue& queue : queues) route_all(std::move(queue));
  counts_.tests += tests;
  communicator_.work(comm::Work::rays, tests);
  return true;
}

void DistributedTracer::intersect(ClusterBatch& batch) {
  const FlushToZero flush;
  const double start = thread_seconds();
  intersect_clusters(*batch.clusters, scene_.shader(), kernels_, batch.rays, batch.shadows);
  const bool all = batch.clusters == &scene_.resident();
  const auto go_on = [&](auto& message) {
    if (all) {
      message.ray.way.note(communicator_.rank());
    } else {
      message.ray.way.note_met(message.ray.way.next);
    }
    choose_next(message);
  };
  for (RayMessage& ray : batch.rays) go_on(ray);
  for (ShadowMessage& shadow : batch.shadows) go_on(shadow);
  batch.busy = thread_seconds() - start;
}

void DistributedTracer::send_all(bool idle) {
  for (int rank = 0; rank < communicator_.size(); ++rank) {
    std::vector<std::uint32_t>& tiles = tiles_to_send_[static_cast<std::size_t>(rank)];
    if (tiles.size() >= kTilesAtOnce || (idle && !tiles.empty())) {
      messenger_.send(rank, pack_tiles(tiles));
      tiles.clear();
    }
    const auto send_batch = [&](MessageKind kind, RayQueue& out) {
      const std::size_t count = out.size();
      if (count == 0 || (!idle && count < kBatchRays)) return;
      (kind == MessageKind::intersect ? counts_.rays_sent : counts_.answers_sent) += count;
      const double start = thread_seconds();
      messenger_.send(rank, pack(kind, out.rays, out.shadows));
      note_travel(0, start);
      out.clear();
    };
    send_batch(MessageKind::intersect, waiting_.to_intersect[static_cast<std::size_t>(rank)]);
    send_batch(MessageKind::answer, waiting_.to_answer[static_cast<std::size_t>(rank)]);
  }
}

}  // namespace delray::raytrace
