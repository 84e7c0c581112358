// Joins nodes, skins, animations and what hangs on nodes. What no animation moves keeps the
// transform that it was placed with.
#include "scenes/gltf/gltf_motion.h"

#include <stdexcept>
#include <string>
#include <utility>

#include "scenes/gltf/gltf_animation.h"
#include "scenes/pose.h"

namespace delray::scenes::internal {
namespace {

void check_joints(const GltfDocument& document, const DeformedMesh& deformed, const Skin& skin) {
  for (std::size_t i = 0; i < deformed.deformation.joints.size(); ++i) {
    if (deformed.deformation.joints[i] < skin.joints.size()) continue;
    document.root()["skins"].fail("joint " + std::to_string(deformed.deformation.joints[i]) +
                                  " of a vertex is not one of " +
                                  std::to_string(skin.joints.size()));
  }
}

bool moves(const DeformedMesh& deformed, const Animations& table,
           std::span<const std::uint8_t> moving) {
  for (const Animation& animation : table.animations) {
    for (const AnimationChannel& channel : animation.channels) {
      if (channel.path == AnimationChannel::Path::weights && channel.node == deformed.node)
        return true;
    }
  }
  if (deformed.skin == kNone) return false;
  for (const std::uint32_t joint : table.skins[deformed.skin].joints)
    if (moving[joint] != 0) return true;
  return false;
}

}  // namespace

GltfMotion::GltfMotion(const GltfDocument& document)
    : document_(document),
      active_(has_motion(document)),
      numbers_(document.root()["nodes"].size(), kNone) {}

std::uint32_t GltfMotion::add(std::uint32_t of_document, std::uint32_t parent,
                              const AnimatedNode& node) {
  if (!active_) return kNone;
  numbers_[of_document] = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back(node);
  nodes_.back().parent = parent;
  return numbers_[of_document];
}

void GltfMotion::bend(Scene& scene) {
  if (!active_) return;
  Animations& table = scene.animations;
  table.nodes = std::move(nodes_);
  table.skins = read_skins(document_, numbers_);
  table.animations = read_animations(document_, numbers_, table.nodes);
  moves_ = moving_nodes(table);
  for (DeformedMesh& deformed : meshes_) {
    if (deformed.skin != kNone) check_joints(document_, deformed, table.skins[deformed.skin]);
    deformed.moves = moves(deformed, table, moves_);
  }
  table.meshes = std::move(meshes_);
  pose_at_rest(document_.source, scene);
}

void GltfMotion::finish(std::span<const glm::dvec3> centres, Scene& scene) {
  if (!active_) return;
  Animations& table = scene.animations;
  for (DeformedMesh& deformed : table.meshes) {
    deformed.origin = centres[deformed.mesh];
    deformed.posed_by.reset();
  }
  for (std::uint32_t i = 0; i < instances_.size(); ++i) {
    const std::uint32_t node = instances_[i];
    if (node != kNone && moves_[node] != 0)
      table.instances.push_back({i, node, centres[scene.instances[i].mesh]});
  }
  for (const Follower& light : lights_)
    if (moves_[light.node] != 0) table.lights.push_back(light);
  for (const Follower& camera : cameras_)
    if (moves_[camera.node] != 0) table.cameras.push_back(camera);
  pose_at_rest(document_.source, scene);
}

void pose_at_rest(const Source& source, Scene& scene) {
  try {
    pose(scene, {});
  } catch (const std::range_error& error) {
    source.fail("", error.what());
  }
}

}  // namespace delray::scenes::internal
