// Hands triangles and instances to Embree and has it build its structures.
//
// Degenerate: vertices that end at a page are copied, as Embree reads past the last one.
#include <algorithm>
#include <cstddef>

#include "raytrace/scene/embree_filters.h"
#include "raytrace/scene/embree_objects.h"

namespace delray::raytrace {
namespace {

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

// Embree loads 16 bytes of the last vertex, of which 12 are ours. The 4 that follow are never used
// and are readable except where a page ends.
bool last_vertex_is_readable(const glm::vec3* positions, std::size_t size, std::size_t capacity) {
  constexpr std::uintptr_t kSmallestPage = 4096;
  return capacity > size || reinterpret_cast<std::uintptr_t>(positions + size) % kSmallestPage != 0;
}

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

}  // namespace

EmbreeScene::EmbreeScene(std::span<const GeometryInstance> instances, const BuildOptions& options,
                         const EmbreeDevice& common, std::span<const GeometryNumbers> numbers)
    : state_(
          new State{common, common.state_->device.get(), common.state_->widest_packet, numbers}) {
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

}  // namespace delray::raytrace
