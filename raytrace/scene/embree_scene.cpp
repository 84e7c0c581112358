// Traces single rays and packets of the machine's own width by Embree, 3 or 4.
//
// A ray that hits an edge is traced again with a filter that keeps the least hit by distance,
// instance and triangle, so that the tree does not decide. A filter of shadow rays collects what
// they pass through.
#include "raytrace/scene/embree_scene.h"

#include <cstddef>
#include <cstdint>
#include <limits>

#include "raytrace/scene/edges.h"
#include "raytrace/scene/embree_filters.h"
#include "raytrace/scene/embree_objects.h"
#include "raytrace/scene/packet_parts.h"

namespace delray::raytrace {
namespace {

static_assert(sizeof(Ray) >= sizeof(RTCRayHit) && alignof(Ray) >= alignof(RTCRayHit) &&
              offsetof(Ray, far) == offsetof(RTCRay, tfar) &&
              offsetof(Ray, normal_x) == offsetof(RTCRayHit, hit) &&
              offsetof(Ray, instance) == offsetof(RTCRayHit, hit.instID));
static_assert(sizeof(RayPacket) >= sizeof(RTCRayHit16) &&
              offsetof(RayPacket, far) == offsetof(RTCRay16, tfar) &&
              offsetof(RayPacket, normal_x) == offsetof(RTCRayHit16, hit) &&
              offsetof(RayPacket, instance) == offsetof(RTCRayHit16, hit.instID));
static_assert(sizeof(ShadowPacket) == sizeof(RTCRay16) &&
              offsetof(ShadowPacket, far) == offsetof(RTCRay16, tfar));
static_assert(kMiss == RTC_INVALID_GEOMETRY_ID);

geometry::Box3 bounds_of(RTCScene tree) {
  RTCBounds box;
  rtcGetSceneBounds(tree, &box);
  return {{box.lower_x, box.lower_y, box.lower_z}, {box.upper_x, box.upper_y, box.upper_z}};
}

void start(Query& query, const EmbreeScene::State& scene, bool coherent) {
  query.scene = &scene;
#if RTC_VERSION_MAJOR >= 4
  rtcInitRayQueryContext(&query.context);
  (void)coherent;
#else
  rtcInitIntersectContext(&query.context);
  if (coherent) query.context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
#endif
}

#if RTC_VERSION_MAJOR >= 4
RTCIntersectArguments intersect_arguments(Query& query, bool coherent) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &query.context;
  int flags = coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
  if (query.nearest != nullptr) {
    arguments.filter = find_least;
    flags |= RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
  }
  arguments.flags = static_cast<RTCRayQueryFlags>(flags);
  return arguments;
}
RTCOccludedArguments occluded_arguments(Query& query, bool coherent) {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.context = &query.context;
  if (coherent) arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  return arguments;
}
#endif

// A query's parameters: Embree 4 takes them as arguments, and Embree 3 as its context.
#if RTC_VERSION_MAJOR >= 4
template <typename Rays, typename Argument>
void call(void (*function)(const int*, RTCScene, Rays*, Argument*), const int* active,
          RTCScene tree, Argument& argument, void* rays) {
  function(active, tree, static_cast<Rays*>(rays), &argument);
}
#else
template <typename Rays>
void call(void (*function)(const int*, RTCScene, Context*, Rays*), const int* active, RTCScene tree,
          Context& argument, void* rays) {
  function(active, tree, &argument, static_cast<Rays*>(rays));
}
#endif

// By Embree's function for its widest packets, of those for 16, 8 and 4 rays: where it has to cut
// packets itself, Embree 3 takes all rays for active.
template <typename Packet, typename Argument, typename Of16, typename Of8, typename Of4>
void trace(const EmbreeScene::State& scene, const ActiveRays& active, Packet& packet,
           Argument& argument, Of16* of16, Of8* of8, Of4* of4) {
  RTCScene tree = scene.top.get();
  switch (scene.widest_packet) {
    case 16:
      return call(of16, active.ray, tree, argument, &packet);
    case 8:
      return for_each_part<8>(active, packet, [&](const std::int32_t* some, void* part) {
        call(of8, some, tree, argument, part);
      });
    default:
      return for_each_part<4>(active, packet, [&](const std::int32_t* some, void* part) {
        call(of4, some, tree, argument, part);
      });
  }
}

// With `nearest` hits are found there instead of in the ray or packet.
void find_hits(const EmbreeScene::State& scene, Ray& ray, Nearest* nearest = nullptr) {
  Query query;
  start(query, scene, false);
  query.nearest = nearest;
  RTCScene tree = scene.top.get();
  auto* embree_ray = reinterpret_cast<RTCRayHit*>(&ray);
#if RTC_VERSION_MAJOR >= 4
  RTCIntersectArguments arguments = intersect_arguments(query, false);
  rtcIntersect1(tree, embree_ray, &arguments);
#else
  if (nearest != nullptr) query.context.filter = find_least;
  rtcIntersect1(tree, &query.context, embree_ray);
#endif
  if (nearest != nullptr || scene.joined.empty()) return;
  if (ray.triangle != kMiss && ray.instance != kMiss)
    ray.instance = scene.instance_of(ray.instance, ray.geometry);
}

void find_hits(const EmbreeScene::State& scene, const ActiveRays& active, RayPacket& packet,
               bool coherent, Nearest* nearest = nullptr) {
  Query query;
  start(query, scene, coherent);
  query.nearest = nearest;
#if RTC_VERSION_MAJOR >= 4
  RTCIntersectArguments argument = intersect_arguments(query, coherent);
#else
  if (nearest != nullptr) query.context.filter = find_least;
  Context& argument = query.context;
#endif
  trace(scene, active, packet, argument, rtcIntersect16, rtcIntersect8, rtcIntersect4);
  if (nearest != nullptr || scene.joined.empty()) return;
  for (int i = 0; i < kPacketRays; ++i) {
    if (active.ray[i] == 0 || packet.triangle[i] == kMiss || packet.instance[i] == kMiss) continue;
    packet.instance[i] = scene.instance_of(packet.instance[i], packet.geometry[i]);
  }
}

// Where a ray that has its nearest hit at a distance is traced again for others at the same one:
// nothing is before that. Spheres and cylinders are entered before they are left: with those, from
// where it was.
float a_little_before(float near, float distance, bool has_splats) {
  return has_splats ? near : std::max(near, distance - std::abs(distance) * 1e-5F);
}

// Decides between triangles that rays hit at the same distance.
[[gnu::noinline, gnu::cold]] void break_ties(const EmbreeScene::State& scene,
                                             const ActiveRays& edges, RayPacket& packet,
                                             bool has_splats) {
  RayPacket again = packet;
  Nearest nearest[kPacketRays];
  for (int i = 0; i < kPacketRays; ++i) {
    if (edges.ray[i] == 0) continue;
    again.near[i] = a_little_before(packet.near[i], packet.far[i], has_splats);
    again.far[i] = a_little_further(packet.far[i]);
    again.id[i] = static_cast<std::uint32_t>(i);
    nearest[i] = {};
    nearest[i].hit.distance = std::numeric_limits<float>::infinity();
  }
  find_hits(scene, edges, again, false, nearest);
  for (int i = 0; i < kPacketRays; ++i) {
    const Nearest& least = nearest[i];
    if (edges.ray[i] == 0 || least.hit.triangle == kMiss) continue;
    packet.far[i] = least.hit.distance;
    packet.normal_x[i] = least.normal_x, packet.normal_y[i] = least.normal_y,
    packet.normal_z[i] = least.normal_z;
    packet.u[i] = least.hit.u, packet.v[i] = least.hit.v;
    packet.triangle[i] = least.hit.triangle;
    packet.instance[i] = least.instanced ? least.hit.instance : kMiss;
    packet.geometry[i] = least.instanced ? 0 : least.hit.instance;
  }
}

// Nothing for hits of triangles, of which u and v are the place already.
void keep_splat_place(const EmbreeScene::State& scene, std::uint32_t geometry, std::uint32_t number,
                      const SplatRay& ray, float& u, float& v) {
  const Splats& splats = scene.instances[geometry].triangles.splats;
  if (splats.kind != scenes::Shape::Kind::triangle) keep_place(splats, number, ray, u, v);
}

[[gnu::noinline]] void keep_splat_places(const EmbreeScene::State& scene, const ActiveRays& active,
                                         RayPacket& p) {
  for (int i = 0; i < kPacketRays; ++i) {
    if (active.ray[i] == 0 || p.triangle[i] == kMiss || p.instance[i] != kMiss) continue;
    keep_splat_place(scene, p.geometry[i], p.triangle[i],
                     {{p.origin_x[i], p.origin_y[i], p.origin_z[i]},
                      {p.direction_x[i], p.direction_y[i], p.direction_z[i]},
                      p.far[i],
                      {p.normal_x[i], p.normal_y[i], p.normal_z[i]}},
                     p.u[i], p.v[i]);
  }
}

// Decides between triangles that a ray hits at the same distance.
void break_tie(const EmbreeScene::State& scene, Ray& ray, bool has_splats) {
  Ray again = ray;
  again.near = a_little_before(ray.near, ray.far, has_splats);
  again.far = a_little_further(ray.far);
  again.id = 0;
  Nearest least{};
  least.hit.distance = std::numeric_limits<float>::infinity();
  find_hits(scene, again, &least);
  if (least.hit.triangle == kMiss) return;
  ray.far = least.hit.distance;
  ray.normal_x = least.normal_x, ray.normal_y = least.normal_y, ray.normal_z = least.normal_z;
  ray.u = least.hit.u, ray.v = least.hit.v;
  ray.triangle = least.hit.triangle;
  ray.instance = least.instanced ? least.hit.instance : kMiss;
  ray.geometry = least.instanced ? 0 : least.hit.instance;
}

}  // namespace

void EmbreeScene::intersect(Ray& ray) const {
  find_hits(*state_, ray);
  if (ray.triangle == kMiss) return;
  if (distance_from_edges(ray.u, ray.v) < kNearEdge) break_tie(*state_, ray, has_splats_);
  if (!has_splats_ || ray.instance != kMiss) return;
  keep_splat_place(*state_, ray.geometry, ray.triangle,
                   {{ray.origin_x, ray.origin_y, ray.origin_z},
                    {ray.direction_x, ray.direction_y, ray.direction_z},
                    ray.far,
                    {ray.normal_x, ray.normal_y, ray.normal_z}},
                   ray.u, ray.v);
}

void EmbreeScene::intersect(const ActiveRays& active, RayPacket& packet, bool coherent) const {
  find_hits(*state_, active, packet, coherent);
  ActiveRays edges;
  if (find_edges(active, packet, edges)) break_ties(*state_, edges, packet, has_splats_);
  if (has_splats_) keep_splat_places(*state_, active, packet);
}

bool EmbreeScene::occluded(Ray& ray, SeeThrough& passed) const {
  Query query;
  start(query, *state_, false);
  query.passed = &passed;
  passed.count = 0;
  ray.id = 0;
  auto* embree_ray = reinterpret_cast<RTCRay*>(&ray);
#if RTC_VERSION_MAJOR >= 4
  RTCOccludedArguments arguments = occluded_arguments(query, false);
  rtcOccluded1(state_->top.get(), embree_ray, &arguments);
#else
  rtcOccluded1(state_->top.get(), &query.context, embree_ray);
#endif
  return ray.far < 0.0F;
}

void EmbreeScene::occluded(const ActiveRays& active, ShadowPacket& packet,
                           std::span<SeeThrough, kPacketRays> passed, bool coherent) const {
  Query query;
  // Embree 3.13.5 with AVX-512 loops forever on coherent occlusion packets that meet an instance.
  coherent = coherent && !has_instances_;
  start(query, *state_, coherent);
  query.passed = passed.data();
  for (int i = 0; i < kPacketRays; ++i) {
    packet.id[i] = static_cast<std::uint32_t>(i);
    passed[i].count = 0;
  }
#if RTC_VERSION_MAJOR >= 4
  RTCOccludedArguments argument = occluded_arguments(query, coherent);
#else
  Context& argument = query.context;
#endif
  trace(*state_, active, packet, argument, rtcOccluded16, rtcOccluded8, rtcOccluded4);
}

bool EmbreeScene::is_robust() const { return state_->options.robust; }

std::uint64_t EmbreeScene::memory() const { return state_->memory; }

geometry::Box3 EmbreeScene::bounds() const { return bounds_of(state_->top.get()); }

geometry::Box3 EmbreeScene::local_bounds(std::uint32_t instance) const {
  const std::uint32_t mesh = state_->instances[instance].mesh;
  return mesh == kMiss ? geometry::Box3() : bounds_of(state_->meshes[mesh]->tree.get());
}

const EmbreeDevice& EmbreeScene::device() const { return state_->common; }

}  // namespace delray::raytrace
