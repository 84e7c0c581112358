// A scene made ready for tracing: what every rank that traces holds.
#pragma once

#include <cstdint>
#include <vector>

#include "raytrace/sampling/light_table.h"
#include "raytrace/scene/embree_scene.h"
#include "raytrace/scene/geometry_instance.h"
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
};

// Whether geometry of so many bytes is more than a cache holds that is near.
bool is_large(std::uint64_t bytes);

// Parallel in the caller's arena. Throws what EmbreeScene throws.
Tracer make_tracer(const scenes::Scene& scene, const BuildOptions& options = {});
// With the scene's shader, which may have taken its texels (shading::take_shader).
Tracer make_tracer(const scenes::Scene& scene, shading::Shader shader, const BuildOptions& options);

}  // namespace delray::raytrace
