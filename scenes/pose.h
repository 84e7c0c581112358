// Scenes that move, at a moment.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "scenes/scene.h"

namespace delray::scenes {

// Where a scene's nodes are: at a time of an animation, or at rest.
struct Pose {
  std::uint32_t animation = kNone;  // kNone: at rest
  double seconds = 0;               // before the first and after the last key as there
};

// What a pose has changed.
struct Movement {
  std::vector<std::uint32_t> instances;  // whose transforms changed, ascending
  std::vector<std::uint32_t> meshes;     // whose vertices changed, ascending
  bool lights = false, cameras = false;

  bool empty() const { return instances.empty() && meshes.empty() && !lights && !cameras; }
};

// Brings instances, lights and cameras to where their nodes are, and bends meshes: morph targets
// first, then skins, then normals. In place: triangles, and numbers of everything, stay. What is
// the same as before is not told. Deterministic; parallel; O(nodes + keys that are looked for +
// vertices of meshes that bend).
//
// Throws std::range_error, naming the mesh or instance, where a coordinate is not finite or larger
// than 1e18; the scene is then partly posed.
//
// REQUIRES: the animation is kNone or one of the scene's.
Movement pose(Scene& scene, const Pose& pose);

// How renderers should hold each mesh, whatever animation is shown. O(meshes + instances).
std::vector<MeshMotion> mesh_motions(const Scene& scene);

// The number of the animation of this name or, where none has it, with this number; nothing
// otherwise.
std::optional<std::uint32_t> find_animation(const Scene& scene, std::string_view name);

}  // namespace delray::scenes
