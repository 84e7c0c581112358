// Points and segments: what Embree is given of them, and where rays hit them.
//
// Embree tells of such hits the distance and the normal alone; the place on the splat is kept in
// the hit's u and v instead, so that a hit says where it is without its ray, as those of triangles
// do.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "raytrace/scene/geometry_instance.h"
#include "raytrace/scene/intersection.h"
#include "raytrace/scene/ray.h"

namespace delray::raytrace {

// The instance's points, or the ends of its segments two by two, in the world, with the radius as
// w.
struct Splats {
  scenes::Shape::Kind kind = scenes::Shape::Kind::triangle;
  std::vector<glm::vec4> places = {};
  std::vector<glm::vec3> normals = {};        // of discs; none: they face the ray
  std::vector<std::uint32_t> segments = {};   // the first end of each
  std::vector<std::uint8_t> neighbours = {};  // of segments: none
};

// The radius in the world of an instance's splats. Those in pixels count as units.
float splat_radius(const GeometryInstance& instance, const scenes::Shape& shape);

// REQUIRES: the instance's mesh has no triangles; it is not
// instanced.
Splats make_splats(const GeometryInstance& instance);

// Where the ray hit: origin and direction in the world, as Embree has the rest.
struct SplatRay {
  glm::vec3 origin, direction;
  float distance;
  glm::vec3 normal;
};
// Sets the u and v of a hit of a splat, of which u is Embree's.
void keep_place(const Splats& splats, std::uint32_t number, const SplatRay& ray, float& u,
                float& v);

// As intersection(), of a splat.
Intersection splat_intersection(const GeometryInstance& instance, const Hit& hit,
                                const glm::vec3& direction);

}  // namespace delray::raytrace
