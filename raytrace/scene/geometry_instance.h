// Instances of a scene as the ray tracer sees them.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <vector>

#include "scenes/scene.h"
#include "shading/shader.h"

namespace delray::raytrace {

// One instance of the scene; element i is instance i of the scene. A mesh that is placed often, or
// moves as a whole, stays as it is and is reached through a transform at every ray; one that is
// placed once is moved to the world beforehand, which costs its positions once more and saves the
// transform.
struct GeometryInstance {
  const scenes::Mesh* mesh = nullptr;
  const glm::vec3* positions = nullptr;  // of the mesh's vertices: its own, or moved to the world
  std::uint32_t mesh_number = 0;
  std::uint32_t material = 0;
  bool instanced = false;    // positions are the mesh's own, `to_world` brings them to the world
  bool deforming = false;    // positions change from pose to pose
  bool identity = true;      // normals and tangents need no transform
  bool see_through = false;  // masked, blended or transmitting: shadow rays do not end there
  bool layered = false;      // masked or blended: no ray need end there
  std::shared_ptr<const std::vector<std::uint64_t>> opaque;  // opaque_triangles(); null: none
  int texture_sets = 0;                                      // that the material looks at
  float orientation = 1.0F;                                  // -1 if the transform mirrors
  glm::mat4x3 to_world{1.0F};                                // the instance's transform
  glm::mat3 normal_to_world{1.0F};
  float transform_scale = 0.0F;  // largest length that to_world adds rounding errors of, 0 if none
  std::vector<glm::vec3> moved;  // backing store of `positions`, one spare element at the end
};

// `share_meshes` false moves every instance to the world, however often its mesh is placed. Refers
// to the scene, which has to outlive it. Instances of meshes that do not exist get a null mesh.
std::vector<GeometryInstance> make_instances(const scenes::Scene& scene,
                                             const shading::Shader& shader, bool share_meshes);

// Makes an instance anew what make_instances made of it, after its transform or its vertices have
// changed. O(vertices) unless it is instanced. REQUIRES: the mesh has as many vertices as before.
void follow(const scenes::Scene& scene, std::uint32_t number, GeometryInstance& instance);

// The largest magnitude of a coordinate.
inline float largest_magnitude(const glm::vec3& v) {
  return std::max(std::max(std::abs(v.x), std::abs(v.y)), std::abs(v.z));
}

// Triangles that can never be hit: corners in one line or point, not finite, or beyond 1e18.
// Counted over instances. Parallel; O(triangles).
std::uint64_t count_degenerate(std::span<const GeometryInstance> instances);

}  // namespace delray::raytrace
