// Copies recorded rays into Embree's single rays, packets or streams and traces them. Threads take
// chunks of groups from a common counter; hits are thrown away, so that nothing but Embree and the
// copying is measured.
#include "bench/peers/embree.h"

#include <embree3/rtcore.h>
#include <pmmintrin.h>
#include <xmmintrin.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstring>
#include <stdexcept>
#include <string>
#include <thread>

namespace delray::bench {
namespace {

constexpr std::size_t kGroupsPerChunk = 256;
constexpr std::size_t kGroupsPerStream = 16;

// Rays `first` and following of a group, as many as a packet of Embree's has.
template <class Packet>
void fill(const RecordedGroup& group, int first, Packet& packet) {
  constexpr int kWidth = sizeof(packet.org_x) / sizeof(float);
  const auto copy = [&](const float* from, float* to) {
    std::memcpy(to, from + first, sizeof(packet.org_x));
  };
  copy(group.origin_x, packet.org_x);
  copy(group.origin_y, packet.org_y);
  copy(group.origin_z, packet.org_z);
  copy(group.near, packet.tnear);
  copy(group.direction_x, packet.dir_x);
  copy(group.direction_y, packet.dir_y);
  copy(group.direction_z, packet.dir_z);
  copy(group.far, packet.tfar);
  for (int i = 0; i < kWidth; ++i) {
    packet.time[i] = 0.0F;
    packet.mask[i] = 0xFFFFFFFFU;
    packet.id[i] = packet.flags[i] = 0;
  }
}

void fill(const RecordedGroup& group, int i, RTCRay& ray) {
  ray.org_x = group.origin_x[i];
  ray.org_y = group.origin_y[i];
  ray.org_z = group.origin_z[i];
  ray.tnear = group.near[i];
  ray.dir_x = group.direction_x[i];
  ray.dir_y = group.direction_y[i];
  ray.dir_z = group.direction_z[i];
  ray.time = 0.0F;
  ray.tfar = group.far[i];
  ray.mask = 0xFFFFFFFFU;
  ray.id = ray.flags = 0;
}

bool used(const RecordedGroup& group, int i) { return group.near[i] <= group.far[i]; }

template <class Packet, class Intersect, class Occluded>
void trace(const RecordedGroup& group, bool shadows, RTCScene scene, RTCIntersectContext* context,
           Intersect intersect, Occluded occluded) {
  constexpr int kWidth = sizeof(Packet::hit.geomID) / sizeof(unsigned);
  for (int first = 0; first < 16; first += kWidth) {
    alignas(64) int valid[kWidth];
    bool any = false;
    for (int i = 0; i < kWidth; ++i) {
      valid[i] = used(group, first + i) ? -1 : 0;
      any = any || valid[i] != 0;
    }
    if (!any) continue;
    Packet packet;
    fill(group, first, packet.ray);
    if (shadows) {
      occluded(valid, scene, context, &packet.ray);
      continue;
    }
    for (int i = 0; i < kWidth; ++i) {
      packet.hit.geomID[i] = packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    intersect(valid, scene, context, &packet);
  }
}

// Refuses hits of triangles that can be seen through.
void pass(const RTCFilterFunctionNArguments* arguments) {
  const auto* solid = static_cast<const std::uint64_t*>(arguments->geometryUserPtr);
  for (unsigned i = 0; i < arguments->N; ++i) {
    if (arguments->valid[i] == 0) continue;
    const unsigned triangle = RTCHitN_primID(arguments->hit, arguments->N, i);
    if (solid == nullptr || (solid[triangle / 64] >> (triangle % 64) & 1) == 0) {
      arguments->valid[i] = 0;
    }
  }
}

void check(RTCDevice device) {
  if (rtcGetDeviceError(device) != RTC_ERROR_NONE) throw std::runtime_error("Embree failed");
}

}  // namespace

const char* name_of(Loop loop) {
  switch (loop) {
    case Loop::single:
      return "single";
    case Loop::packet:
      return "packet";
    case Loop::coherent:
      return "coherent";
    case Loop::stream:
      return "stream";
  }
  return "";
}

struct BareEmbree::State {
  RTCDevice device = nullptr;
  RTCScene top = nullptr;
  std::vector<RTCScene> meshes;
  bool instances = false;
  int widest = 4;  // packet that Embree traces as it is

  void loop(std::span<const RecordedGroup> rays, bool shadows, Loop how) const;
};

void BareEmbree::State::loop(std::span<const RecordedGroup> rays, bool shadows, Loop how) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  if (how == Loop::coherent) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  if (how == Loop::stream) {
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    for (std::size_t g = 0; g < rays.size(); g += kGroupsPerStream) {
      alignas(64) RTCRayHit stream[kGroupsPerStream * 16];
      unsigned count = 0;
      for (std::size_t k = g; k < std::min(g + kGroupsPerStream, rays.size()); ++k) {
        for (int i = 0; i < 16; ++i) {
          if (!used(rays[k], i)) continue;
          fill(rays[k], i, stream[count].ray);
          stream[count].hit.geomID = stream[count].hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
          ++count;
        }
      }
      if (shadows) {
        rtcOccluded1M(top, &context, &stream[0].ray, count, sizeof(RTCRayHit));
      } else {
        rtcIntersect1M(top, &context, stream, count, sizeof(RTCRayHit));
      }
    }
    return;
  }
  for (const RecordedGroup& group : rays) {
    if (how == Loop::single) {
      for (int i = 0; i < 16; ++i) {
        if (!used(group, i)) continue;
        RTCRayHit ray;
        fill(group, i, ray.ray);
        if (shadows) {
          rtcOccluded1(top, &context, &ray.ray);
        } else {
          ray.hit.geomID = ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
          rtcIntersect1(top, &context, &ray);
        }
      }
      continue;
    }
    if (widest == 16) {
      trace<RTCRayHit16>(group, shadows, top, &context, rtcIntersect16, rtcOccluded16);
    } else if (widest == 8) {
      trace<RTCRayHit8>(group, shadows, top, &context, rtcIntersect8, rtcOccluded8);
    } else {
      trace<RTCRayHit4>(group, shadows, top, &context, rtcIntersect4, rtcOccluded4);
    }
  }
}

BareEmbree::BareEmbree(std::span<const raytrace::GeometryInstance> instances, bool same_answers,
                       const char* isa)
    : state_(std::make_unique<State>()) {
  std::string configuration = "set_affinity=0";
  if (*isa != '\0') configuration += std::string(",isa=") + isa;
  state_->device = rtcNewDevice(configuration.c_str());
  RTCDevice device = state_->device;
  if (rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) != 0) {
    state_->widest = 8;
  }
  if (rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED) != 0) {
    state_->widest = 16;
  }
  const auto new_scene = [&] {
    RTCScene scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, same_answers ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
    return scene;
  };
  const auto attach = [&](RTCScene scene, unsigned number, const raytrace::GeometryInstance& p) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    const std::size_t vertices = p.mesh->positions.size();
    void* to = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                       sizeof(glm::vec3), vertices);
    std::memcpy(to, p.positions, vertices * sizeof(glm::vec3));
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                               p.mesh->triangles.data(), 0, sizeof(glm::uvec3),
                               p.mesh->triangles.size());
    if (same_answers && p.see_through) {
      rtcSetGeometryOccludedFilterFunction(geometry, pass);
      if (p.opaque) {
        rtcSetGeometryUserData(geometry, const_cast<std::uint64_t*>(p.opaque->data()));
      }
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, number);
    rtcReleaseGeometry(geometry);
  };
  state_->top = new_scene();
  for (unsigned i = 0; i < instances.size(); ++i) {
    const raytrace::GeometryInstance& p = instances[i];
    if (p.mesh == nullptr || p.mesh->triangles.empty()) continue;
    if (!p.instanced) {
      attach(state_->top, i, p);
      continue;
    }
    state_->instances = true;
    if (state_->meshes.size() <= p.mesh_number) state_->meshes.resize(p.mesh_number + 1);
    RTCScene& mesh = state_->meshes[p.mesh_number];
    if (mesh == nullptr) {
      mesh = new_scene();
      attach(mesh, 0, p);
      rtcCommitScene(mesh);
    }
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, mesh);
    rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, &p.to_world);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(state_->top, geometry, i);
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(state_->top);
  check(device);
}

BareEmbree::~BareEmbree() {
  rtcReleaseScene(state_->top);
  for (RTCScene mesh : state_->meshes) {
    if (mesh != nullptr) rtcReleaseScene(mesh);
  }
  rtcReleaseDevice(state_->device);
}

bool BareEmbree::can(Loop loop, bool shadows) const {
  // Embree 3.13.5 with AVX-512 loops forever on coherent occlusion packets that meet an instance.
  return !(shadows && state_->instances && (loop == Loop::coherent || loop == Loop::stream));
}

double BareEmbree::seconds(std::span<const RecordedGroup> rays, bool shadows, Loop loop,
                           int threads) const {
  std::atomic<std::size_t> next{0};
  const std::size_t chunks = (rays.size() + kGroupsPerChunk - 1) / kGroupsPerChunk;
  const auto work = [&] {
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
    _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
    for (std::size_t c = next++; c < chunks; c = next++) {
      const std::size_t first = c * kGroupsPerChunk;
      state_->loop(rays.subspan(first, std::min(kGroupsPerChunk, rays.size() - first)), shadows,
                   loop);
    }
  };
  const auto start = std::chrono::steady_clock::now();
  std::vector<std::jthread> helpers;
  for (int i = 1; i < threads; ++i) helpers.emplace_back(work);
  const unsigned mode = _mm_getcsr();
  work();
  _mm_setcsr(mode);
  helpers.clear();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace delray::bench
