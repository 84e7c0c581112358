// Hands triangles and instances to Embree, 3 or 4, and traces single rays and packets of the
// machine's own width.
//
// A ray that hits an edge is traced again with a filter that keeps the least hit by distance,
// instance and triangle, so that the tree does not decide. A filter of shadow rays collects what
// they pass through.
//
// Degenerate: vertices that end at a page are copied, as Embree reads past the last one; a shadow
// ray through too many layers is occluded.
#include "raytrace/scene/embree_scene.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <new>
#include <stdexcept>
#include <tuple>
#include <vector>

#if __has_include(<embree3/rtcore.h>)
#include <embree3/rtcore.h>
#else
#include <embree4/rtcore.h>
#endif

#include "raytrace/scene/edges.h"
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

// Embree 4 passes flags and filters beside the context, Embree 3 within it.
#if RTC_VERSION_MAJOR >= 4
using Context = RTCRayQueryContext;
constexpr int kFilterOfQuery = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;
#else
using Context = RTCIntersectContext;
constexpr int kFilterOfQuery = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;
#endif

// The least of the hits that a ray was asked about.
struct Nearest {
  Hit hit;
  float normal_x, normal_y, normal_z;
  bool instanced;
};

// What filters find of the query that they belong to; element i is of the ray with id i.
struct Query {
  Context context;
  SeeThrough* passed = nullptr;
  Nearest* nearest = nullptr;
};

void start(Query& query, bool coherent) {
#if RTC_VERSION_MAJOR >= 4
  rtcInitRayQueryContext(&query.context);
  (void)coherent;
#else
  rtcInitIntersectContext(&query.context);
  if (coherent) query.context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
#endif
}

Hit hit_of(const RTCFilterFunctionNArguments* arguments, unsigned i) {
  const unsigned n = arguments->N;
  const unsigned instance = RTCHitN_instID(arguments->hit, n, i, 0);
  return {RTCRayN_tfar(arguments->ray, n, i),
          instance != kMiss ? instance : RTCHitN_geomID(arguments->hit, n, i),
          RTCHitN_primID(arguments->hit, n, i), RTCHitN_u(arguments->hit, n, i),
          RTCHitN_v(arguments->hit, n, i)};
}

// Refuses every hit, so that Embree reports all, whatever their order, and keeps the least.
void find_least(const RTCFilterFunctionNArguments* arguments) {
  const auto* query = reinterpret_cast<const Query*>(arguments->context);
  const unsigned n = arguments->N;
  for (unsigned i = 0; i < n; ++i) {
    if (arguments->valid[i] == 0) continue;
    arguments->valid[i] = 0;
    const Hit hit = hit_of(arguments, i);
    Nearest& least = query->nearest[RTCRayN_id(arguments->ray, n, i)];
    if (std::tie(hit.distance, hit.instance, hit.triangle) >=
        std::tie(least.hit.distance, least.hit.instance, least.hit.triangle))
      continue;
    least = {hit, RTCHitN_Ng_x(arguments->hit, n, i), RTCHitN_Ng_y(arguments->hit, n, i),
             RTCHitN_Ng_z(arguments->hit, n, i), RTCHitN_instID(arguments->hit, n, i, 0) != kMiss};
  }
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

// Notes a hit and lets the ray go on, unless the triangle is opaque. Embree may report one hit
// several times.
void note_and_pass(const RTCFilterFunctionNArguments* arguments) {
  auto* query = reinterpret_cast<Query*>(arguments->context);
  const auto* opaque = static_cast<const std::uint64_t*>(arguments->geometryUserPtr);
  const unsigned n = arguments->N;
  for (unsigned i = 0; i < n; ++i) {
    if (arguments->valid[i] == 0) continue;
    const unsigned triangle = RTCHitN_primID(arguments->hit, n, i);
    if (opaque != nullptr && (opaque[triangle / 64] >> (triangle % 64) & 1) != 0) continue;
    const Hit hit = hit_of(arguments, i);
    SeeThrough& passed = query->passed[RTCRayN_id(arguments->ray, n, i)];
    bool known = false;
    for (int j = 0; j < passed.count; ++j) {
      known = known ||
              (passed.hits[j].instance == hit.instance && passed.hits[j].triangle == hit.triangle);
    }
    if (!known) {
      if (passed.count == SeeThrough::kMost) continue;  // stays valid: ends the ray
      passed.hits[passed.count++] = hit;
    }
    arguments->valid[i] = 0;
  }
}

RTCBuildQuality quality(BuildOptions::Quality quality) {
  switch (quality) {
    case BuildOptions::Quality::low:
      return RTC_BUILD_QUALITY_LOW;
    case BuildOptions::Quality::high:
      return RTC_BUILD_QUALITY_HIGH;
    case BuildOptions::Quality::medium:
      break;
  }
  return RTC_BUILD_QUALITY_MEDIUM;
}

bool count_memory(void* total, ssize_t bytes, bool /*after*/) {
  static_cast<std::atomic<std::int64_t>*>(total)->fetch_add(bytes, std::memory_order_relaxed);
  return true;
}

struct DeviceDeleter {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct SceneDeleter {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using Device = std::unique_ptr<RTCDeviceTy, DeviceDeleter>;
using Tree = std::unique_ptr<RTCSceneTy, SceneDeleter>;

void check(RTCDevice device, const char* doing) {
  const RTCError error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_NONE) return;
  if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
  throw std::runtime_error(std::string("Embree failed with error ") +
                           std::to_string(static_cast<int>(error)) + " while " + doing);
}

// Embree loads 16 bytes of the last vertex, of which 12 are ours. The 4 that follow are never used
// and are readable except where a page ends.
bool last_vertex_is_readable(const glm::vec3* positions, std::size_t size, std::size_t capacity) {
  constexpr std::uintptr_t kSmallestPage = 4096;
  return capacity > size || reinterpret_cast<std::uintptr_t>(positions + size) % kSmallestPage != 0;
}

}  // namespace

struct EmbreeDevice::State {
  std::atomic<std::int64_t> memory{0};
  Device device;
  std::string isa;
  int widest_packet = 4;  // that Embree traces as it is, in rays
};

struct EmbreeScene::State {
  EmbreeDevice common;
  RTCDevice device;  // the same
  int widest_packet;
  std::uint64_t memory = 0;
  std::vector<Tree> meshes = {};  // element i: of mesh i where it is shared, else null
  Tree top = {};
  std::vector<std::unique_ptr<std::vector<glm::vec3>>> copies =
      {};  // of positions that were unreadable
  std::vector<std::shared_ptr<const std::vector<std::uint64_t>>> opaque = {};  // of geometries
};

namespace {

Tree new_tree(RTCDevice device, const BuildOptions& options) {
  Tree tree(rtcNewScene(device));
  check(device, "making a scene");
  rtcSetSceneBuildQuality(tree.get(), quality(options.quality));
  const int robust = options.robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE;
  rtcSetSceneFlags(tree.get(), static_cast<RTCSceneFlags>(robust | kFilterOfQuery));
  return tree;
}

void commit(RTCDevice device, RTCScene tree) {
  // Joining keeps the work in the arena of the caller; Embree would use an arena of its own.
  if (rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_JOIN_COMMIT_SUPPORTED) != 0) {
    rtcJoinCommitScene(tree);
  } else {
    rtcCommitScene(tree);
  }
  check(device, "building the acceleration structure");
}

void attach_triangles(EmbreeScene::State& state, RTCScene tree, unsigned number,
                      const GeometryInstance& instance, const BuildOptions& options) {
  RTCDevice device = state.device;
  const scenes::Mesh& mesh = *instance.mesh;
  const glm::vec3* positions = instance.positions;
  const bool moved = !instance.moved.empty();
  if (!last_vertex_is_readable(positions, mesh.positions.size(),
                               moved ? mesh.positions.size() + 1 : mesh.positions.capacity())) {
    auto copy = std::make_unique<std::vector<glm::vec3>>();
    copy->reserve(mesh.positions.size() + 1);
    copy->assign(positions, positions + mesh.positions.size());
    positions = copy->data();
    state.copies.push_back(std::move(copy));
  }
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, positions, 0,
                             sizeof(glm::vec3), mesh.positions.size());
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                             mesh.triangles.data(), 0, sizeof(glm::uvec3), mesh.triangles.size());
  rtcSetGeometryBuildQuality(geometry, quality(options.quality));
  if (instance.see_through) rtcSetGeometryOccludedFilterFunction(geometry, note_and_pass);
  if (instance.opaque) {
    state.opaque.push_back(instance.opaque);
    rtcSetGeometryUserData(geometry, const_cast<std::uint64_t*>(instance.opaque->data()));
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(tree, geometry, number);
  rtcReleaseGeometry(geometry);
  check(device, "adding triangles");
}

void attach_instance(EmbreeScene::State& state, unsigned number, const GeometryInstance& instance,
                     const BuildOptions& options) {
  RTCDevice device = state.device;
  Tree& mesh = state.meshes[instance.mesh_number];
  if (!mesh) {
    mesh = new_tree(device, options);
    attach_triangles(state, mesh.get(), 0, instance, options);
    commit(device, mesh.get());
  }
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(geometry, mesh.get());
  rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, &instance.to_world);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(state.top.get(), geometry, number);
  rtcReleaseGeometry(geometry);
  check(device, "adding an instance");
}

int widest_packet(RTCDevice device) {
  if (rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED) != 0) return 16;
  if (rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) != 0) return 8;
  return 4;
}

std::string isa_in_use(int widest_packet) {
#if defined(__x86_64__)
  if (widest_packet == 16) return "avx512";
  if (widest_packet == 8) return __builtin_cpu_supports("avx2") != 0 ? "avx2" : "avx";
  return __builtin_cpu_supports("sse4.2") != 0 ? "sse4.2" : "sse2";
#else
  (void)widest_packet;
  return "neon";
#endif
}

// What Embree 4 takes as arguments of a query, and Embree 3 as its context.
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
void find_hits(RTCScene tree, Ray& ray, Nearest* nearest = nullptr) {
  Query query;
  start(query, false);
  query.nearest = nearest;
  auto* embree_ray = reinterpret_cast<RTCRayHit*>(&ray);
#if RTC_VERSION_MAJOR >= 4
  RTCIntersectArguments arguments = intersect_arguments(query, false);
  rtcIntersect1(tree, embree_ray, &arguments);
#else
  if (nearest != nullptr) query.context.filter = find_least;
  rtcIntersect1(tree, &query.context, embree_ray);
#endif
}

void find_hits(const EmbreeScene::State& scene, const ActiveRays& active, RayPacket& packet,
               bool coherent, Nearest* nearest = nullptr) {
  Query query;
  start(query, coherent);
  query.nearest = nearest;
#if RTC_VERSION_MAJOR >= 4
  RTCIntersectArguments argument = intersect_arguments(query, coherent);
#else
  if (nearest != nullptr) query.context.filter = find_least;
  Context& argument = query.context;
#endif
  trace(scene, active, packet, argument, rtcIntersect16, rtcIntersect8, rtcIntersect4);
}

// Decides between triangles that rays hit at the same distance.
[[gnu::noinline, gnu::cold]] void break_ties(const EmbreeScene::State& scene,
                                             const ActiveRays& edges, RayPacket& packet,
                                             bool coherent) {
  RayPacket again = packet;
  Nearest nearest[kPacketRays];
  for (int i = 0; i < kPacketRays; ++i) {
    again.far[i] = a_little_further(packet.far[i]);
    again.id[i] = static_cast<std::uint32_t>(i);
    nearest[i] = {};
    nearest[i].hit.distance = std::numeric_limits<float>::infinity();
  }
  find_hits(scene, edges, again, coherent, nearest);
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

}  // namespace

EmbreeDevice::EmbreeDevice(const BuildOptions& options) : state_(std::make_shared<State>()) {
  // No "threads=": with oneTBB that would limit every arena of the process.
  std::string configuration = "set_affinity=0";
  if (!options.isa.empty()) configuration += ",isa=" + options.isa;
  state_->device.reset(rtcNewDevice(configuration.c_str()));
  if (!state_->device) check(nullptr, "starting");
  RTCDevice device = state_->device.get();
  rtcSetDeviceMemoryMonitorFunction(device, count_memory, &state_->memory);
  state_->widest_packet = widest_packet(device);
  state_->isa = isa_in_use(state_->widest_packet);
}

std::uint64_t EmbreeDevice::memory() const {
  return static_cast<std::uint64_t>(state_->memory.load(std::memory_order_relaxed));
}

std::string EmbreeDevice::version() const {
  const auto part = [&](RTCDeviceProperty property) {
    return std::to_string(rtcGetDeviceProperty(state_->device.get(), property));
  };
  return part(RTC_DEVICE_PROPERTY_VERSION_MAJOR) + "." + part(RTC_DEVICE_PROPERTY_VERSION_MINOR) +
         "." + part(RTC_DEVICE_PROPERTY_VERSION_PATCH);
}

std::string EmbreeDevice::isa() const { return state_->isa; }

EmbreeScene::EmbreeScene(std::span<const GeometryInstance> instances, const BuildOptions& options,
                         const EmbreeDevice& common)
    : state_(new State{common, common.state_->device.get(), common.state_->widest_packet}) {
  RTCDevice device = state_->device;
  const std::uint64_t before = common.memory();

  std::size_t meshes = 0;
  for (const GeometryInstance& p : instances)
    meshes = std::max<std::size_t>(meshes, p.mesh_number + 1);
  state_->meshes.resize(meshes);
  state_->top = new_tree(device, options);
  for (std::size_t i = 0; i < instances.size(); ++i) {
    const GeometryInstance& instance = instances[i];
    if (instance.mesh == nullptr || instance.mesh->triangles.empty()) continue;
    has_see_through_ = has_see_through_ || instance.see_through;
    has_instances_ = has_instances_ || instance.instanced;
    if (instance.instanced) {
      attach_instance(*state_, static_cast<unsigned>(i), instance, options);
    } else {
      attach_triangles(*state_, state_->top.get(), static_cast<unsigned>(i), instance, options);
    }
  }
  commit(device, state_->top.get());
  state_->memory = common.memory() - before;
}

EmbreeScene::~EmbreeScene() = default;
EmbreeScene::EmbreeScene(EmbreeScene&&) noexcept = default;
EmbreeScene& EmbreeScene::operator=(EmbreeScene&&) noexcept = default;

void EmbreeScene::intersect(Ray& ray) const {
  find_hits(state_->top.get(), ray);
  if (ray.triangle == kMiss || !is_on_edge(ray.u, ray.v)) return;
  Ray again = ray;
  again.far = a_little_further(ray.far);
  again.id = 0;
  Nearest least{};
  least.hit.distance = std::numeric_limits<float>::infinity();
  find_hits(state_->top.get(), again, &least);
  if (least.hit.triangle == kMiss) return;
  ray.far = least.hit.distance;
  ray.normal_x = least.normal_x, ray.normal_y = least.normal_y, ray.normal_z = least.normal_z;
  ray.u = least.hit.u, ray.v = least.hit.v;
  ray.triangle = least.hit.triangle;
  ray.instance = least.instanced ? least.hit.instance : kMiss;
  ray.geometry = least.instanced ? 0 : least.hit.instance;
}

void EmbreeScene::intersect(const ActiveRays& active, RayPacket& packet, bool coherent) const {
  find_hits(*state_, active, packet, coherent);
  ActiveRays edges;
  if (find_edges(active, packet, edges)) break_ties(*state_, edges, packet, coherent);
}

bool EmbreeScene::occluded(Ray& ray, SeeThrough& passed) const {
  Query query;
  start(query, false);
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
  start(query, coherent);
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

std::uint64_t EmbreeScene::memory() const { return state_->memory; }

geometry::Box3 EmbreeScene::bounds() const {
  RTCBounds box;
  rtcGetSceneBounds(state_->top.get(), &box);
  return {{box.lower_x, box.lower_y, box.lower_z}, {box.upper_x, box.upper_y, box.upper_z}};
}

const EmbreeDevice& EmbreeScene::device() const { return state_->common; }

}  // namespace delray::raytrace
