// Embree's own objects, of version 3 or 4: for the sources that build and trace, and nobody else.
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <string>
#include <unordered_map>
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
    std::shared_ptr<const std::vector<std::uint64_t>> opaque = {};
    Splats splats = {};  // instead of triangles
  };
  // A piece of a mesh that is reached through transforms; the whole one where a scene is no part.
  struct Piece {
    Triangles triangles = {};
    std::uint32_t uses = 0;  // by instances; 0: the geometry is free
  };
  // All its pieces that are there: one tree.
  struct Mesh {
    std::deque<Piece> pieces = {};  // element i: geometry i of the tree; they stay where they are
    std::unordered_map<const scenes::Mesh*, std::uint32_t> numbers = {};  // of pieces
    std::vector<std::uint32_t> free = {};                                 // pieces
    std::vector<std::uint32_t> instances = {};                            // that place a piece
    Tree tree = {};
  };
  struct Instance {
    Triangles triangles = {};  // where it has a mesh of its own
    const scenes::Mesh* piece = nullptr;
    std::uint32_t mesh = kMiss;
    glm::mat4x3 to_world{1.0F};
    bool attached = false;
    bool leads = false;  // Embree's instance has its number
  };
  std::vector<std::unique_ptr<Mesh>> meshes = {};  // element i: of mesh i where it is shared
  std::vector<Instance> instances = {};            // element i: of instance i
  // Element i: which of our instances each geometry of Embree's instance i is. Of scenes that are
  // parts, else empty: instance i itself.
  std::vector<std::vector<std::uint32_t>> joined = {};
  Tree top = {};

  // Which of our instances geometry `geometry` of Embree's instance is.
  std::uint32_t instance_of(std::uint32_t instance, std::uint32_t geometry) const {
    return joined.empty() ? instance : joined[instance][geometry];
  }
};

}  // namespace delray::raytrace
