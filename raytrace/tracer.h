// A scene made ready for tracing: what every rank that traces holds.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "raytrace/sampling/light_table.h"
#include "raytrace/scene/embree_scene.h"
#include "raytrace/scene/geometry_instance.h"
#include "raytrace/scene/refit_cost.h"
#include "scenes/pose.h"
#include "scenes/scene.h"
#include "shading/shader.h"

namespace delray::raytrace {

// Refers to the scene it was made from, which has to outlive it. Ranks that are threads of one
// process may share one.
struct Tracer {
  shading::Shader shader;
  std::vector<GeometryInstance> instances;
  EmbreeScene embree;
  LightTable lights;
  std::uint64_t degenerate = 0;  // triangles that can never be hit
  double build_seconds = 0.0;
  bool large = false;       // its meshes do not fit into a cache that is near
  std::uint64_t bytes = 0;  // of geometry and acceleration structures
  double refit_limit = 1.4;
  std::unordered_map<std::uint32_t, RefitCost> refit_costs;  // by instance that bends
};

// What it took to have a tracer follow a scene that moved.
struct FollowCounts {
  std::uint32_t moved = 0;                // instances with another transform
  std::uint32_t refitted = 0, built = 0;  // structures of meshes that bent
  // Of the top level alone, where nothing bent; of structures that were refitted, and of those that
  // were built, each with the top level; of all, light tables and vertices included.
  double top_seconds = 0, refit_seconds = 0, build_seconds = 0, seconds = 0;
};

// Whether geometry of so many bytes is more than a cache holds that is near.
bool is_large(std::uint64_t bytes);

// Parallel in the caller's arena. Throws what EmbreeScene throws.
Tracer make_tracer(const scenes::Scene& scene, const BuildOptions& options = {});
// With the scene's shader, which may have taken its texels (shading::take_shader).
Tracer make_tracer(const scenes::Scene& scene, shading::Shader shader, const BuildOptions& options);

// Brings a tracer to the pose of its scene (Wald et al. 2003): what stands still is kept, of
// instances that moved only the top level is built, of meshes that bent the structure is refitted
// or, when a ray would cost more than refit_limit times as much as when it was built, built anew.
// Hits are those of a tracer that is made of the scene as it is. Parallel in the caller's arena.
// Throws what EmbreeScene throws. REQUIRES: `movement` is what has changed since the last call.
FollowCounts follow(Tracer& tracer, const scenes::Scene& scene, const scenes::Movement& movement);

}  // namespace delray::raytrace
