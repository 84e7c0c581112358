// Interpolates what a mesh knows at a hit, and finds the offset of rays that leave it (after
// Waechter and Binder 2019) and the footprint of the ray's cone (Amanatides 1984).
//
// Degenerate: triangles whose area under- or overflows are measured with their longest edge for a
// unit; those without area get a fixed normal and no footprint.
#include "raytrace/scene/intersection.h"

#include <algorithm>
#include <cmath>

#include "raytrace/scene/splat_hits.h"

namespace delray::raytrace {
namespace {

glm::vec3 unit(const glm::vec3& v, const glm::vec3& otherwise) {
  const float squared = glm::dot(v, v);
  return squared > 0.0F ? v * (1.0F / std::sqrt(squared)) : otherwise;
}

template <class T>
T interpolate(const std::vector<T>& values, const glm::uvec3& corners, const Hit& hit) {
  return values[corners.x] * (1.0F - hit.u - hit.v) + values[corners.y] * hit.u +
         values[corners.z] * hit.v;
}

// How far uv moves where the cone's width moves over the triangle: the ratio of areas gives the
// scale, the slant of the surface stretches it.
shading::Footprint footprint(const std::vector<glm::vec2>& uvs, const glm::uvec3& corners,
                             float world_area, float cosine, float width) {
  const glm::vec2 a = uvs[corners.y] - uvs[corners.x];
  const glm::vec2 b = uvs[corners.z] - uvs[corners.x];
  const float uv_area = std::abs(a.x * b.y - a.y * b.x);
  if (!(world_area > 0.0F)) return {};
  const float step = width * std::sqrt(uv_area / world_area) / std::max(cosine, kSteepest);
  return {{step, 0.0F}, {0.0F, step}};
}

}  // namespace

Intersection intersection(const GeometryInstance& instance, const Hit& hit,
                          const glm::vec3& direction, const Cone& cone) {
  const scenes::Mesh& mesh = *instance.mesh;
  if (!mesh.has_triangles()) return splat_intersection(instance, hit, direction);
  const glm::uvec3 corners = mesh.triangles[hit.triangle];
  glm::vec3 a = instance.positions[corners.x];
  glm::vec3 b = instance.positions[corners.y];
  glm::vec3 c = instance.positions[corners.z];
  if (instance.instanced) {
    a = instance.to_world * glm::vec4(a, 1.0F);
    b = instance.to_world * glm::vec4(b, 1.0F);
    c = instance.to_world * glm::vec4(c, 1.0F);
  }
  const glm::vec3 ab = b - a, ac = c - a;
  Intersection result;
  shading::Point& point = result.point;
  point.position = a + ab * hit.u + ac * hit.v;
  result.offset =
      kOffset *
      (std::max(std::max(largest_magnitude(a), largest_magnitude(b)), largest_magnitude(c)) +
       std::max(largest_magnitude(ab), largest_magnitude(ac)) + instance.transform_scale);

  glm::vec3 cross = glm::cross(ab, ac);
  const float squared = glm::dot(cross, cross);
  float area = std::sqrt(squared), length = area;
  if (!(squared >= kLeastSquare && squared <= kMostSquare)) {
    const float size = std::max(largest_magnitude(ab), largest_magnitude(ac)), per = 1.0F / size;
    cross = glm::cross(ab * per, ac * per);
    length = std::sqrt(glm::dot(cross, cross));
    area = length * size * size;
  }
  point.geometric_normal =
      length > 0.0F ? cross * (instance.orientation / length) : glm::vec3(0, 0, 1);
  point.normal = point.geometric_normal;
  if (!mesh.normals.empty()) {
    glm::vec3 normal = interpolate(mesh.normals, corners, hit);
    if (!instance.identity) normal = instance.normal_to_world * normal;
    point.normal = unit(normal, point.geometric_normal);
  }
  if (!mesh.colours.empty()) point.colour = interpolate(mesh.colours, corners, hit);
  const float cosine = std::abs(glm::dot(point.geometric_normal, direction));
  const auto texture_point = [&](const std::vector<glm::vec2>& uvs) -> shading::TexturePoint {
    return {interpolate(uvs, corners, hit), footprint(uvs, corners, area, cosine, cone.width)};
  };
  if (instance.texture_sets > 1 && !mesh.uvs2.empty()) point.second = texture_point(mesh.uvs2);
  if (instance.texture_sets > 0 && !mesh.uvs.empty()) {
    const shading::TexturePoint first = texture_point(mesh.uvs);
    point.uv = first.uv;
    point.footprint = first.footprint;
    if (!mesh.tangents.empty()) {
      const glm::vec4 along = interpolate(mesh.tangents, corners, hit);
      glm::vec3 tangent(along);
      if (!instance.identity) tangent = glm::mat3(instance.to_world) * tangent;
      const float side = mesh.tangents[corners.x].w < 0.0F ? -1.0F : 1.0F;
      point.tangent = glm::vec4(unit(tangent, glm::vec3(1, 0, 0)), side * instance.orientation);
    }
  }
  return result;
}

CoveragePoint coverage_point(const GeometryInstance& instance, const Hit& hit, int set) {
  const scenes::Mesh& mesh = *instance.mesh;
  const glm::uvec3 corners = mesh.triangles[hit.triangle];
  CoveragePoint result;
  const std::vector<glm::vec2>& uvs = mesh.uvs_of(set);
  if (!uvs.empty()) result.uv = interpolate(uvs, corners, hit);
  if (!mesh.colours.empty()) result.alpha = interpolate(mesh.colours, corners, hit).w;
  return result;
}

}  // namespace delray::raytrace
