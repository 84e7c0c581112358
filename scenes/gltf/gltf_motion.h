// From nodes as they are placed to all that moves in a scene.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "scenes/gltf/gltf_document.h"
#include "scenes/scene.h"

namespace delray::scenes::internal {

// Collects what hangs on nodes while they are placed, parents first, and makes the scene's
// animations of it. Does nothing for documents in which nothing moves.
class GltfMotion {
 public:
  explicit GltfMotion(const GltfDocument& document);

  bool active() const { return active_; }
  // A node of the document and its parent's number in the table (kNone: none). Returns its own.
  std::uint32_t add(std::uint32_t of_document, std::uint32_t parent, const AnimatedNode& node);
  // The scene's last mesh, instance, light or camera hangs on the node.
  void add_deformed(DeformedMesh&& deformed) { meshes_.push_back(std::move(deformed)); }
  // As many as there are instances. `skinned`: the instance does not follow it.
  void add_instance(std::uint32_t node, bool skinned) {
    instances_.push_back(skinned ? kNone : node);
  }
  void add_light(std::uint32_t node, std::uint32_t light) { lights_.push_back({light, node}); }
  void add_camera(std::uint32_t node, std::uint32_t camera) { cameras_.push_back({camera, node}); }
  std::vector<float>& weights_of(std::uint32_t node) { return nodes_[node].weights; }

  // Reads skins and animations, and bends meshes as they are at rest, so that their vertices may be
  // looked at. Fails on joints that a skin does not have.
  void bend(Scene& scene);
  // Once the scene has its origin, and its meshes are relative to `centres`: what follows nodes.
  void finish(std::span<const glm::dvec3> centres, Scene& scene);

 private:
  const GltfDocument& document_;
  bool active_;
  std::vector<AnimatedNode> nodes_;
  std::vector<std::uint32_t> numbers_;  // by node of the document
  std::vector<DeformedMesh> meshes_;
  std::vector<std::uint32_t> instances_;  // nodes, or kNone
  std::vector<Follower> lights_, cameras_;
  std::vector<std::uint8_t> moves_;  // by node
};

// Puts the scene at rest; a coordinate that is too large for that is bad input.
void pose_at_rest(const Source& source, Scene& scene);

}  // namespace delray::scenes::internal
