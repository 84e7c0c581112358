// Hands triangles and instances to Embree and has it build its structures.
//
// Degenerate: vertices that end at a page are copied, as Embree reads past the last one.
#include <algorithm>
#include <cstddef>
#include <numeric>

#include "raytrace/scene/embree_filters.h"
#include "raytrace/scene/embree_objects.h"

namespace delray::raytrace {

void commit(RTCDevice device, RTCScene tree) {
  // Joining keeps the work in the arena of the caller; Embree would use an arena of its own.
  if (rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_JOIN_COMMIT_SUPPORTED) != 0) {
    rtcJoinCommitScene(tree);
  } else {
    rtcCommitScene(tree);
  }
  check(device, "building the acceleration structure");
}

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

Tree new_tree(RTCDevice device, const BuildOptions& options, bool changing) {
  Tree tree(rtcNewScene(device));
  check(device, "making a scene");
  // Of low quality is a tree over trees, one for each instance, which are built as those say.
  rtcSetSceneBuildQuality(tree.get(), changing ? RTC_BUILD_QUALITY_LOW : quality(options.quality));
  const int robust = options.robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE;
  const int dynamic = changing ? RTC_SCENE_FLAG_DYNAMIC : RTC_SCENE_FLAG_NONE;
  rtcSetSceneFlags(tree.get(), static_cast<RTCSceneFlags>(robust | dynamic | kFilterOfQuery));
  return tree;
}

// Has the geometry look at the instance's vertices where they are, or at a copy.
void share_vertices(RTCGeometry geometry, const GeometryInstance& instance,
                    EmbreeScene::State::Triangles& triangles) {
  const glm::vec3* positions = instance.positions;
  const std::size_t size = instance.mesh->positions.size();
  const bool moved = !instance.moved.empty();
  if (!last_vertex_is_readable(positions, size,
                               moved ? size + 1 : instance.mesh->positions.capacity())) {
    triangles.copy.reserve(size + 1);
    triangles.copy.assign(positions, positions + size);
    positions = triangles.copy.data();
  }
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, positions, 0,
                             sizeof(glm::vec3), size);
}

void attach_triangles(const EmbreeScene::State& state, RTCScene tree, unsigned number,
                      const GeometryInstance& instance, EmbreeScene::State::Triangles& triangles) {
  RTCDevice device = state.device;
  const scenes::Mesh& mesh = *instance.mesh;
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  share_vertices(geometry, instance, triangles);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                             mesh.triangles.data(), 0, sizeof(glm::uvec3), mesh.triangles.size());
  const bool refits = instance.deforming && state.options.changing;
  rtcSetGeometryBuildQuality(geometry,
                             refits ? RTC_BUILD_QUALITY_REFIT : quality(state.options.quality));
  if (instance.see_through) rtcSetGeometryOccludedFilterFunction(geometry, note_and_pass);
  if (instance.opaque) {
    triangles.opaque = instance.opaque;
    rtcSetGeometryUserData(geometry, const_cast<std::uint64_t*>(instance.opaque->data()));
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(tree, geometry, number);
  rtcReleaseGeometry(geometry);
  check(device, "adding triangles");
}

RTCGeometryType type_of(const Splats& splats) {
  switch (splats.kind) {
    case scenes::Shape::Kind::sphere:
      return RTC_GEOMETRY_TYPE_SPHERE_POINT;
    case scenes::Shape::Kind::line:
      return RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE;
    default:
      return splats.normals.empty() ? RTC_GEOMETRY_TYPE_DISC_POINT
                                    : RTC_GEOMETRY_TYPE_ORIENTED_DISC_POINT;
  }
}

void attach_splats(const EmbreeScene::State& state, RTCScene tree, unsigned number,
                   const GeometryInstance& instance, EmbreeScene::State::Triangles& triangles) {
  const auto share = [](RTCGeometry geometry, RTCBufferType type, RTCFormat format,
                        const auto& values) {
    rtcSetSharedGeometryBuffer(geometry, type, 0, format, values.data(), 0, sizeof(values[0]),
                               values.size());
  };
  Splats& splats = triangles.splats;
  splats = make_splats(instance);
  // Embree loads 16 bytes of 12.
  splats.normals.reserve(splats.normals.size() + 1);
  RTCGeometry geometry = rtcNewGeometry(state.device, type_of(splats));
  share(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, splats.places);
  if (!splats.normals.empty())
    share(geometry, RTC_BUFFER_TYPE_NORMAL, RTC_FORMAT_FLOAT3, splats.normals);
  if (!splats.segments.empty()) {
    share(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT, splats.segments);
    share(geometry, RTC_BUFFER_TYPE_FLAGS, RTC_FORMAT_UCHAR, splats.neighbours);
  }
  rtcSetGeometryBuildQuality(geometry, quality(state.options.quality));
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(tree, geometry, number);
  rtcReleaseGeometry(geometry);
  check(state.device, "adding points");
}

void add_piece(EmbreeScene::State& state, EmbreeScene::State::Instance& own,
               const GeometryInstance& instance) {
  EmbreeScene::State::Mesh& mesh = *state.meshes[instance.mesh_number];
  if (!mesh.tree) {
    const bool part_changes = state.options.changing && !state.numbers.empty();
    mesh.tree = new_tree(state.device, state.options, part_changes);
  }
  const auto [known, is_new] = mesh.numbers.try_emplace(instance.mesh, 0);
  if (is_new) {
    if (mesh.free.empty()) {
      mesh.free.push_back(static_cast<std::uint32_t>(mesh.pieces.size()));
      mesh.pieces.emplace_back();
    }
    known->second = mesh.free.back();
    mesh.free.pop_back();
    attach_triangles(state, mesh.tree.get(), known->second, instance,
                     mesh.pieces[known->second].triangles);
  }
  EmbreeScene::State::Piece& piece = mesh.pieces[known->second];
  ++piece.uses;
  own.piece = instance.mesh;
  own.mesh = instance.mesh_number;
  own.to_world = instance.to_world;
}

void remove_piece(EmbreeScene::State& state, const EmbreeScene::State::Instance& own) {
  EmbreeScene::State::Mesh& mesh = *state.meshes[own.mesh];
  const auto known = mesh.numbers.find(own.piece);
  EmbreeScene::State::Piece& piece = mesh.pieces[known->second];
  if (--piece.uses > 0) return;
  rtcDetachGeometry(mesh.tree.get(), known->second);
  piece = {};
  mesh.free.push_back(known->second);
  mesh.numbers.erase(known);
}

// Takes Embree's instances of a mesh away.
void part(EmbreeScene::State& state, const EmbreeScene::State::Mesh& mesh) {
  for (const std::uint32_t i : mesh.instances) {
    EmbreeScene::State::Instance& own = state.instances[i];
    if (own.leads) rtcDetachGeometry(state.top.get(), i);
    own.leads = false;
    if (!state.joined.empty()) state.joined[i].clear();
  }
}

// Makes an instance of Embree's of all that is the same one in the whole scene.
void join(EmbreeScene::State& state, EmbreeScene::State::Mesh& mesh) {
  commit(state.device, mesh.tree.get());
  const auto whole = [&](std::uint32_t i) {
    return state.numbers.empty() ? i : state.numbers[i].instance;
  };
  std::sort(mesh.instances.begin(), mesh.instances.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(whole(a), a) < std::pair(whole(b), b);
  });
  std::uint32_t leader = kMiss;
  for (const std::uint32_t i : mesh.instances) {
    EmbreeScene::State::Instance& own = state.instances[i];
    if (leader == kMiss || whole(i) != whole(leader)) {
      leader = i;
      own.leads = true;
      RTCGeometry geometry = rtcNewGeometry(state.device, RTC_GEOMETRY_TYPE_INSTANCE);
      rtcSetGeometryInstancedScene(geometry, mesh.tree.get());
      rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, &own.to_world);
      rtcCommitGeometry(geometry);
      rtcAttachGeometryByID(state.top.get(), geometry, i);
      rtcReleaseGeometry(geometry);
      if (!state.joined.empty()) state.joined[i].assign(mesh.pieces.size(), kMiss);
    }
    if (!state.joined.empty()) state.joined[leader][mesh.numbers.at(own.piece)] = i;
  }
  check(state.device, "adding an instance");
}

bool is_empty(const GeometryInstance& instance) {
  return instance.mesh == nullptr || instance.mesh->triangles.empty();
}

void attach(EmbreeScene::State& state, unsigned number, const GeometryInstance& instance) {
  EmbreeScene::State::Instance& own = state.instances[number];
  if (is_empty(instance) || own.attached) return;
  own.attached = true;
  if (instance.instanced) {
    add_piece(state, own, instance);
    state.meshes[own.mesh]->instances.push_back(number);
  } else if (!instance.mesh->has_triangles()) {
    attach_splats(state, state.top.get(), number, instance, own.triangles);
  } else {
    attach_triangles(state, state.top.get(), number, instance, own.triangles);
  }
}

void detach(EmbreeScene::State& state, unsigned number) {
  EmbreeScene::State::Instance& own = state.instances[number];
  if (!own.attached) return;
  if (own.mesh != kMiss) {
    remove_piece(state, own);
  } else {
    rtcDetachGeometry(state.top.get(), number);
  }
  own = {};
}

// The shared meshes that have or get one of these instances, in order.
std::vector<std::uint32_t> changed_meshes(EmbreeScene::State& state,
                                          std::span<const std::uint32_t> changed,
                                          std::span<const GeometryInstance> instances) {
  std::vector<std::uint32_t> meshes;
  for (const std::uint32_t i : changed) {
    if (state.instances[i].mesh != kMiss) meshes.push_back(state.instances[i].mesh);
    if (!is_empty(instances[i]) && instances[i].instanced)
      meshes.push_back(instances[i].mesh_number);
  }
  std::sort(meshes.begin(), meshes.end());
  meshes.erase(std::unique(meshes.begin(), meshes.end()), meshes.end());
  if (!meshes.empty() && meshes.back() >= state.meshes.size())
    state.meshes.resize(meshes.back() + std::size_t{1});
  for (const std::uint32_t mesh : meshes) {
    if (!state.meshes[mesh]) state.meshes[mesh] = std::make_unique<EmbreeScene::State::Mesh>();
  }
  return meshes;
}

}  // namespace

EmbreeScene::EmbreeScene(std::span<const GeometryInstance> instances, const BuildOptions& options,
                         const EmbreeDevice& common, std::span<const GeometryNumbers> numbers)
    : state_(new State{common, common.state_->device.get(), common.state_->widest_packet, options,
                       numbers}) {
  const std::uint64_t before = common.memory();
  state_->top = new_tree(state_->device, options, options.changing);
  std::vector<std::uint32_t> all(instances.size());
  std::iota(all.begin(), all.end(), 0U);
  change(all, instances, numbers);
  state_->memory = common.memory() - before;
}

void EmbreeScene::change(std::span<const std::uint32_t> changed,
                         std::span<const GeometryInstance> instances,
                         std::span<const GeometryNumbers> numbers) {
  State& state = *state_;
  const std::uint64_t before = state.common.memory();
  state.numbers = numbers;
  state.instances.resize(instances.size());
  if (!numbers.empty()) state.joined.resize(instances.size());
  const std::vector<std::uint32_t> meshes = changed_meshes(state, changed, instances);
  for (const std::uint32_t mesh : meshes) part(state, *state.meshes[mesh]);
  for (const std::uint32_t i : changed) detach(state, i);
  for (const std::uint32_t mesh : meshes)
    std::erase_if(state.meshes[mesh]->instances,
                  [&](std::uint32_t i) { return !state.instances[i].attached; });
  for (const std::uint32_t i : changed) attach(state, i, instances[i]);
  for (const std::uint32_t mesh : meshes) {
    if (state.meshes[mesh]->instances.empty()) {
      state.meshes[mesh] = nullptr;
    } else {
      join(state, *state.meshes[mesh]);
    }
  }
  commit(state.device, state.top.get());
  has_see_through_ = has_instances_ = has_splats_ = false;
  for (const GeometryInstance& instance : instances) {
    if (is_empty(instance)) continue;
    has_see_through_ = has_see_through_ || instance.see_through;
    has_instances_ = has_instances_ || instance.instanced;
    has_splats_ = has_splats_ || !instance.mesh->has_triangles();
  }
  state.memory += state.common.memory() - before;
}

void EmbreeScene::move(std::span<const std::uint32_t> moved, std::span<const std::uint32_t> bent,
                       bool rebuild, std::span<const GeometryInstance> instances) {
  State& state = *state_;
  const std::uint64_t before = state.common.memory();
  for (const std::uint32_t i : moved) {
    if (!state.instances[i].attached) continue;
    state.instances[i].to_world = instances[i].to_world;
    RTCGeometry geometry = rtcGetGeometry(state.top.get(), i);
    rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, &instances[i].to_world);
    rtcCommitGeometry(geometry);
  }
  for (const std::uint32_t i : bent) {
    State::Instance& own = state.instances[i];
    if (!own.attached) continue;
    RTCGeometry geometry = rtcGetGeometry(state.top.get(), i);
    share_vertices(geometry, instances[i], own.triangles);
    rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0);
    // Other triangles than before are never refitted.
    if (rebuild) rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0);
    rtcCommitGeometry(geometry);
  }
  check(state.device, "moving geometry");
  commit(state.device, state.top.get());
  state.memory += state.common.memory() - before;
}

EmbreeScene::~EmbreeScene() = default;
EmbreeScene::EmbreeScene(EmbreeScene&&) noexcept = default;
EmbreeScene& EmbreeScene::operator=(EmbreeScene&&) noexcept = default;

}  // namespace delray::raytrace
