// How a scene moves: a hierarchy of nodes, key frames of their transforms, and meshes that bend
// (glTF's model; Parent 2012, chapters 3 and 5). scenes/pose.h puts a scene into a pose.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "scenes/none.h"

namespace delray::scenes {

// Key frames of one property of a node.
struct AnimationChannel {
  enum class Path : std::uint8_t {
    translation,
    rotation,  // a quaternion: x, y, z, w
    scale,
    weights  // of the node's morph targets
  } path = Path::translation;
  // step: the value of the last key. linear: between two keys, on the shortest arc for rotations
  // (Shoemake 1985). cubic_spline: Hermite's, by the tangents of the keys.
  enum class Interpolation : std::uint8_t {
    step,
    linear,
    cubic_spline
  } interpolation = Interpolation::linear;
  std::uint32_t node = 0;
  std::uint32_t width = 3;    // numbers of a value: 3, 4, or one for each morph target
  std::vector<float> times;   // seconds: at least one, >= 0, strictly ascending
  std::vector<float> values;  // `width` for each key; with cubic_spline in-tangent, value and
                              // out-tangent, `width` each
};

// Channels that move together.
struct Animation {
  std::string name;
  std::vector<AnimationChannel> channels;

  double duration() const {  // seconds, from 0 to the last key
    double last = 0;
    for (const AnimationChannel& channel : channels)
      last = std::max(last, double{channel.times.back()});
    return last;
  }
};

// A place that others may hang on. At rest it is where the file has it.
struct AnimatedNode {
  std::uint32_t parent = kNone;  // a lower number than the node's own
  std::string name;
  glm::dvec3 translation{0.0};
  glm::dvec4 rotation{0, 0, 0, 1};  // x, y, z, w
  glm::dvec3 scale{1.0};
  std::optional<glm::dmat4> matrix = {};  // instead of the three
  std::vector<float> weights = {};        // of its mesh's morph targets
};

// Displacements of a mesh's vertices: one for each, or none.
struct MorphTarget {
  std::vector<glm::vec3> positions, normals, tangents;
};

// How the vertices of a mesh follow weights and joints.
struct Deformation {
  std::vector<MorphTarget> targets;
  // So many joints for each vertex, numbers within the skin, with weights that sum up to 1. None:
  // there is no skin.
  std::uint32_t influences = 0;
  std::vector<std::uint16_t> joints;
  std::vector<float> weights;

  bool empty() const { return targets.empty() && influences == 0; }
};

// Joints that a mesh's vertices follow, from where they are bound.
struct Skin {
  std::vector<std::uint32_t> joints;  // nodes
  std::vector<glm::dmat4> to_joint;   // from the mesh to each joint, where it is bound
};

// A mesh whose vertices depend on the pose. It is placed once; with a skin its vertices are in the
// world, and its instance's transform is none.
struct DeformedMesh {
  std::uint32_t mesh = 0;
  std::uint32_t node = 0;  // that has the weights
  std::uint32_t skin = kNone;
  bool moves = false;  // in some animation
  Deformation deformation;
  // As they are without any weight or skin; element i is of vertex i.
  std::vector<glm::vec3> positions, normals;
  std::vector<glm::vec4> tangents;
  // Normals are not the file's, but are summed up over the triangles around a vertex in every pose.
  // Element i: the first vertex with the normal of vertex i. Empty: normals move as vertices do.
  std::vector<std::uint32_t> normal_groups;
  glm::dvec3 origin{0.0};  // subtracted from all positions
  // What has bent the mesh to what it is: weights of the targets, and transforms of the joints.
  struct By {
    std::vector<double> weights;
    std::vector<glm::dmat4> joints;
  };
  std::optional<By> posed_by = {};
};

// Something that follows a node.
struct Follower {
  std::uint32_t number = 0;  // of the instance, light or camera of the scene
  std::uint32_t node = 0;
  glm::dvec3 centre{0.0};  // of an instance: its mesh is relative to this
};

// How a mesh moves, in any animation.
enum class MeshMotion : std::uint8_t {
  still,     // neither it nor its instances change
  rigid,     // instances of it are moved, its vertices stay
  deforming  // its vertices change
};

// All that moves in a scene; nothing where there are no nodes.
struct Animations {
  std::vector<AnimatedNode> nodes;
  std::vector<Animation> animations;
  std::vector<Skin> skins;
  std::vector<DeformedMesh> meshes;
  std::vector<Follower> instances, lights, cameras;  // that some animation moves
  // By mesh, of a scene that was packed without its animations, so that rays meet it with the same
  // roundings; empty: as the members above say.
  std::vector<MeshMotion> motions;

  bool empty() const { return nodes.empty(); }
};

}  // namespace delray::scenes
