// Embree's own objects, of version 3 or 4: for the sources that build and trace, and nobody else.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#if __has_include(<embree3/rtcore.h>)
#include <embree3/rtcore.h>
#else
#include <embree4/rtcore.h>
#endif

#include "raytrace/scene/embree_scene.h"

namespace delray::raytrace {

struct DeviceDeleter {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct SceneDeleter {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using Device = std::unique_ptr<RTCDeviceTy, DeviceDeleter>;
using Tree = std::unique_ptr<RTCSceneTy, SceneDeleter>;

// Throws what EmbreeScene throws if the device has failed.
void check(RTCDevice device, const char* doing);

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
  std::span<const GeometryNumbers> numbers;
  std::uint64_t memory = 0;
  std::vector<Tree> meshes = {};  // element i: of mesh i where it is shared, else null
  Tree top = {};
  std::vector<std::unique_ptr<std::vector<glm::vec3>>> copies =
      {};  // of positions that were unreadable
  std::vector<std::shared_ptr<const std::vector<std::uint64_t>>> opaque = {};  // of geometries
};

}  // namespace delray::raytrace
