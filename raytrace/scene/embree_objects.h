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
#include "raytrace/scene/splat_hits.h"

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

// Builds the structure of a scene in the caller's arena. Throws as check.
void commit(RTCDevice device, RTCScene tree);

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
  BuildOptions options;
  std::span<const GeometryNumbers> numbers;
  std::uint64_t memory = 0;

  // Data of triangles that Embree refers to beside the mesh.
  struct Triangles {
    std::vector<glm::vec3> copy = {};  // of positions that were unreadable
    const glm::vec3* positions = nullptr;
    const glm::uvec3* corners = nullptr;
    std::shared_ptr<const std::vector<std::uint64_t>> opaque = {};
    Splats splats = {};  // instead of triangles
  };
  struct Mesh {
    Triangles triangles = {};
    Tree tree = {};
  };
  struct Instance {
    Triangles triangles = {};  // where it has a mesh of its own
    std::uint32_t mesh = 0;    // otherwise; kMiss: there is none
    glm::mat4x3 to_world{1.0F};
    bool attached = false;
  };
  std::vector<Mesh> meshes = {};         // element i: of mesh i where it is shared
  std::vector<Instance> instances = {};  // element i: of instance i
  Tree top = {};
};

}  // namespace delray::raytrace
