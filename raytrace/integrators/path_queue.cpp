// Packs rays that go on into groups of sixteen, so that vectors are full however many paths have
// ended. Rays that were not turned aside fill groups of their own, which stay coherent. Cost: a
// copy of some lanes for each group of vertices.
#include "raytrace/integrators/path_queue.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "raytrace/integrators/enqueue.h"

namespace delray::raytrace {
namespace {

using shading::LaneMask;

template <class Group>
void activate(Group& group, int from, int to) {
  std::fill(group.active.ray + from, group.active.ray + to, -1);
}

}  // namespace

void PathQueue::clear() {
  enqueued_.clear();
  enqueued_lights_.clear();
  filling_ = straight_ = {};
  used_lights_ = kPacketRays;
}

void PathQueue::begin() {
  clear();
  for (std::uint32_t block = 0; block < next_.rays.size(); ++block) {
    PathLanes& lanes = enqueued_.add();
    lanes.whole = true;
    lanes.block = block;
  }
}

void PathQueue::begin_generation() {
  std::swap(enqueued_, intersected_);
  std::swap(enqueued_lights_, intersected_lights_);
  clear();
}

void PathQueue::make_room(Filling& filling) {
  if (filling.used < kPacketRays) return;
  filling = {next_.rays.size(), 0};
  clear_rays(next_.rays.add());
  PathLanes& lanes = enqueued_.add();
  lanes.whole = false;
  std::fill_n(lanes.triangle, kPacketRays, kMiss);
}

void PathQueue::go_behind(const RayGroup& group, const PathLanes& lanes, int i, const Hit& hit) {
  // The camera's rays have not been turned aside.
  Filling& filling = lanes.bounce[i] == 0 ? straight_ : filling_;
  make_room(filling);
  const int lane = filling.used++;
  RayGroup& next = next_.rays[filling.group];
  PathLanes& to = enqueued_[filling.group];
  next.coherent = lanes.bounce[i] == 0;
  set_ray(next, lane, origin_of(group.packet, i), direction_of(group.packet, i), group.view.get(i),
          next_up(hit.distance));
  next.width[lane] = group.width[i];
  next.spread[lane] = group.spread[i];
  to.throughput.set(lane, lanes.throughput.get(i));
  to.pdf[lane] = lanes.pdf[i];
  to.pixel[lane] = lanes.pixel[i];
  to.bounce[lane] = lanes.bounce[i];
  to.vertex[lane] = lanes.vertex[i] + 1;
  to.instance[lane] = hit.instance;
  to.triangle[lane] = hit.triangle;
  ++(lanes.bounce[i] == 0 ? counts_.primary : counts_.secondary);
}

void PathQueue::enqueue(const ScatteredRays& rays) {
  make_room(filling_);
  const int used = filling_.used, all = used + rays.count;
  const std::size_t first = filling_.group;
  filling_.used = all;
  std::array<float*, 18> second{};
  if (all > kPacketRays) {
    make_room(filling_);
    filling_.used = all - kPacketRays;
    second = path_fields(next_.rays.back(), enqueued_.back());
    activate(next_.rays.back(), 0, filling_.used);
  }
  append_lanes(rays, used, path_fields(next_.rays[first], enqueued_[first]),
               all > kPacketRays ? &second : nullptr);
  activate(next_.rays[first], used, std::min(all, kPacketRays));
  counts_.secondary += static_cast<std::uint64_t>(rays.count);
}

void PathQueue::add_shadows() {
  clear_rays(next_.shadows.add());
  enqueued_lights_.add();
}

void PathQueue::enqueue(const LightRays& rays, LaneMask lit, const LightSamples& lights) {
  if (used_lights_ == kPacketRays) {
    add_shadows();
    used_lights_ = 0;
  }
  const int used = used_lights_, all = used + rays.count;
  const std::size_t first = next_.shadows.size() - 1;
  used_lights_ = all;
  std::array<float*, 11> second{};
  if (all > kPacketRays) {
    add_shadows();
    used_lights_ = all - kPacketRays;
    second = light_fields(next_.shadows.back(), enqueued_lights_.back());
    activate(next_.shadows.back(), 0, used_lights_);
  }
  append_lanes(rays, used, light_fields(next_.shadows[first], enqueued_lights_[first]),
               all > kPacketRays ? &second : nullptr);
  activate(next_.shadows[first], used, std::min(all, kPacketRays));
  // Scattered rays find other lights behind glass.
  int lane = used;
  for (LaneMask rest = lit; rest != 0; rest &= rest - 1, ++lane) {
    if (lights.pdf[std::countr_zero(rest)] > 0.0F) continue;
    next_.shadows[first + static_cast<std::size_t>(lane / kPacketRays)].through_glass |=
        1U << (lane % kPacketRays);
  }
  counts_.shadow += static_cast<std::uint64_t>(rays.count);
}

}  // namespace delray::raytrace
