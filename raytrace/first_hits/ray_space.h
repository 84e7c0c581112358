// The space in which an instance's triangles meet rays: the world, or that of their mesh.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "geometry/box.h"
#include "raytrace/scene/embree_scene.h"
#include "raytrace/scene/geometry_instance.h"
#include "scenes/camera.h"

namespace delray::raytrace {

struct RaySpace {
  bool is_world = true;
  glm::mat4x3 to_local{1.0F};  // as Embree has it
  glm::vec3 origin{0.0F};      // of all rays, to the last bit as Embree computes it
  // Products with a point seen from `origin` are its view coordinates (scenes::View).
  glm::vec3 right{0.0F}, up{0.0F}, forward{0.0F};
  float forward_length = 1.0F;
  float longest = 1.0F;  // direction of a ray that goes through the window, here
  float volume = 1.0F;   // of what has volume 1 in the world, rounded down
  // How far rays here may be from those in the world, which are what boxes of instances are tested
  // with: an angle, and a length; both 0 in the world.
  float off_angle = 0.0F, off_length = 0.0F;
  geometry::Box3 box;  // of its triangles; not of the world
};

// The spaces of a scene: the world first, then each instance that is an Embree instance.
struct RaySpaces {
  std::span<const GeometryInstance> instances;
  std::vector<RaySpace> spaces;
  std::vector<std::uint32_t> numbers;  // by instance

  const RaySpace& of(std::uint32_t instance) const { return spaces[numbers[instance]]; }
};

// `longest`: of the directions in the world. `instances`: the tree's. Spaces whose transform has no
// inverse to speak of have forward_length 0: what is in them cannot be told beforehand.
RaySpaces ray_spaces(const EmbreeScene& tree, std::span<const GeometryInstance> instances,
                     const scenes::View& view, float longest);

}  // namespace delray::raytrace
