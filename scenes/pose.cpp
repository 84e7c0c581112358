// Poses a scene: channels give nodes their transforms and weights, nodes are multiplied parents
// first, and what hangs on them follows. What comes out as it was is not told as changed.
#include "scenes/pose.h"

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>
#include <span>
#include <stdexcept>
#include <string>

#include "scenes/animation/deform.h"
#include "scenes/animation/followers.h"
#include "scenes/animation/interpolate.h"

namespace delray::scenes {
namespace {

constexpr double kLargest = 1e18;

// The nodes of a scene at a time.
struct PosedNodes {
  std::vector<glm::dmat4> worlds;
  std::vector<std::vector<double>> weights;  // of nodes that have some
};

// Sets what the animation's channels say of the nodes.
void apply(const Animation& animation, double seconds, std::vector<AnimatedNode>& nodes,
           PosedNodes& posed) {
  using Path = AnimationChannel::Path;
  std::vector<double> value;
  for (const AnimationChannel& channel : animation.channels) {
    value.resize(channel.width);
    internal::interpolate(channel, seconds, value);
    AnimatedNode& node = nodes[channel.node];
    switch (channel.path) {
      case Path::translation:
        node.translation = {value[0], value[1], value[2]};
        break;
      case Path::rotation:
        node.rotation = {value[0], value[1], value[2], value[3]};
        break;
      case Path::scale:
        node.scale = {value[0], value[1], value[2]};
        break;
      case Path::weights:
        posed.weights[channel.node] = value;
        break;
    }
  }
}

PosedNodes posed_nodes(const Animations& table, const Pose& pose) {
  PosedNodes posed;
  std::vector<AnimatedNode> nodes = table.nodes;
  posed.weights.resize(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i)
    posed.weights[i].assign(nodes[i].weights.begin(), nodes[i].weights.end());
  if (pose.animation != kNone) apply(table.animations[pose.animation], pose.seconds, nodes, posed);
  for (const AnimatedNode& node : nodes) {
    const glm::dmat4 local = internal::transform_of(node);
    posed.worlds.push_back(node.parent == kNone ? local : posed.worlds[node.parent] * local);
  }
  return posed;
}

bool place(const glm::mat4x3& transform, std::uint32_t instance, Scene& scene) {
  glm::mat4x3& old = scene.instances[instance].transform;
  if (old == transform) return false;
  for (int k = 0; k < 4; ++k) {
    const glm::vec3 size = glm::abs(transform[k]);
    if (!(std::max({size.x, size.y, size.z}) <= static_cast<float>(kLargest))) {
      throw std::range_error("the transform of instance " + std::to_string(instance) +
                             " is not finite or larger than 1e18");
    }
  }
  old = transform;
  return true;
}

void bend(DeformedMesh& deformed, const PosedNodes& posed, Scene& scene, Movement& movement) {
  std::vector<double> weights = posed.weights[deformed.node];
  weights.resize(deformed.deformation.targets.size(), 0.0);
  std::vector<glm::dmat4> joints;
  if (deformed.skin != kNone) {
    const Skin& skin = scene.animations.skins[deformed.skin];
    for (std::size_t j = 0; j < skin.joints.size(); ++j)
      joints.push_back(posed.worlds[skin.joints[j]] * skin.to_joint[j]);
  }
  if (deformed.posed_by && deformed.posed_by->weights == weights &&
      deformed.posed_by->joints == joints) {
    return;
  }
  Mesh& mesh = scene.meshes[deformed.mesh];
  deformed.posed_by.reset();
  if (!internal::deform(deformed, weights, joints, mesh)) {
    throw std::range_error("a coordinate of mesh " + std::to_string(deformed.mesh) +
                           (mesh.name.empty() ? "" : " (" + mesh.name + ")") +
                           " is not finite or larger than 1e18");
  }
  deformed.posed_by = {std::move(weights), std::move(joints)};
  movement.meshes.push_back(deformed.mesh);
}

}  // namespace

Movement pose(Scene& scene, const Pose& pose) {
  Movement movement;
  if (scene.animations.empty()) return movement;
  assert(pose.animation == kNone || pose.animation < scene.animations.animations.size());
  const PosedNodes posed = posed_nodes(scene.animations, pose);
  for (const Follower& f : scene.animations.instances) {
    if (place(internal::placed_at(posed.worlds[f.node], f.centre, scene.origin), f.number, scene))
      movement.instances.push_back(f.number);
  }
  for (DeformedMesh& deformed : scene.animations.meshes) bend(deformed, posed, scene, movement);
  for (const Follower& f : scene.animations.lights) {
    glm::dmat4 world = posed.worlds[f.node];
    world[3] -= glm::dvec4(scene.origin, 0.0);
    movement.lights |= internal::follow(world, scene.lights[f.number]);
  }
  for (const Follower& f : scene.animations.cameras) {
    glm::dmat4 world = posed.worlds[f.node];
    world[3] -= glm::dvec4(scene.origin, 0.0);
    movement.cameras |= internal::follow(world, scene.cameras[f.number]);
  }
  return movement;
}

std::vector<MeshMotion> mesh_motions(const Scene& scene) {
  // Meshes that were added since stand still.
  std::vector<MeshMotion> motions = scene.animations.motions;
  motions.resize(scene.meshes.size(), MeshMotion::still);
  if (!scene.animations.motions.empty()) return motions;
  for (const Follower& follower : scene.animations.instances)
    motions[scene.instances[follower.number].mesh] = MeshMotion::rigid;
  for (const DeformedMesh& deformed : scene.animations.meshes)
    if (deformed.moves) motions[deformed.mesh] = MeshMotion::deforming;
  return motions;
}

std::optional<std::uint32_t> find_animation(const Scene& scene, std::string_view name) {
  const std::vector<Animation>& all = scene.animations.animations;
  for (std::uint32_t i = 0; i < all.size(); ++i)
    if (all[i].name == name) return i;
  std::uint32_t number = 0;
  const char* const end = name.data() + name.size();
  const auto [at, error] = std::from_chars(name.data(), end, number);
  if (error == std::errc() && at == end && number < all.size()) return number;
  return std::nullopt;
}

}  // namespace delray::scenes
