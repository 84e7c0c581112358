// The place of a hit on its splat: of a disc in the frame of its normal, of a sphere its normal in
// octahedral coordinates (Meyer et al. 2010), of a segment how far along it and the normal in
// 2 x 12 bits of them.
//
// Degenerate: a disc's normal without a direction is (0, 0, 1); segments without length are met as
// spheres are.
#include "raytrace/scene/splat_hits.h"

#include <algorithm>
#include <cmath>

#include "geometry/frame.h"
#include "parallel/parallel_for.h"

namespace delray::raytrace {
namespace {

using ShapeKind = scenes::Shape::Kind;

constexpr std::size_t kGrain = 1 << 14;  // points: some ten microseconds

glm::vec3 unit_or(const glm::vec3& v, const glm::vec3& otherwise) {
  const float squared = glm::dot(v, v);
  return squared > 0 ? v * (1.0F / std::sqrt(squared)) : otherwise;
}

float sign_of(float x) { return x < 0 ? -1.0F : 1.0F; }

glm::vec2 to_octahedron(const glm::vec3& n) {
  const float sum = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
  if (!(sum > 0)) return {0, 0};
  const float x = n.x / sum, y = n.y / sum;
  if (n.z >= 0) return {x, y};
  return {(1 - std::abs(y)) * sign_of(x), (1 - std::abs(x)) * sign_of(y)};
}

glm::vec3 from_octahedron(const glm::vec2& at) {
  glm::vec3 n(at.x, at.y, 1 - std::abs(at.x) - std::abs(at.y));
  if (n.z < 0)
    n = {(1 - std::abs(at.y)) * sign_of(at.x), (1 - std::abs(at.x)) * sign_of(at.y), n.z};
  return unit_or(n, {0, 0, 1});
}

constexpr float kSteps = 4095;  // of a coordinate in 12 bits

float packed(const glm::vec2& at) {
  const auto step = [](float x) {
    return std::nearbyint((std::clamp(x, -1.0F, 1.0F) + 1) * (0.5F * kSteps));
  };
  return step(at.x) * (kSteps + 1) + step(at.y);
}
glm::vec2 unpacked(float value) {
  const float high = std::floor(value / (kSteps + 1)), low = value - high * (kSteps + 1);
  return glm::vec2(high, low) * (2 / kSteps) - 1.0F;
}

glm::vec3 normal_of(const GeometryInstance& instance, std::uint32_t vertex) {
  const glm::vec3& normal = instance.mesh->normals[vertex];
  return unit_or(instance.identity ? normal : instance.normal_to_world * normal, {0, 0, 1});
}

}  // namespace

float splat_radius(const GeometryInstance& instance, const scenes::Shape& shape) {
  const glm::mat4x3& m = instance.to_world;
  const float longest =
      std::max({glm::dot(m[0], m[0]), glm::dot(m[1], m[1]), glm::dot(m[2], m[2])});
  return shape.radius * std::sqrt(longest);
}

Splats make_splats(const GeometryInstance& instance) {
  const scenes::Mesh& mesh = *instance.mesh;
  const float radius = splat_radius(instance, mesh.shape);
  Splats splats;
  splats.kind = mesh.shape.kind;
  const std::size_t count = mesh.triangles.size();
  const bool segments = splats.kind == ShapeKind::line;
  splats.places.resize(segments ? 2 * count : count);
  if (segments) {
    splats.segments.resize(count);
    splats.neighbours.assign(count, 0);
  }
  const bool turned = splats.kind == ShapeKind::disc && !mesh.normals.empty();
  if (turned) splats.normals.resize(count);
  parallel::parallel_for(0, count, kGrain, [&](std::size_t t) {
    const glm::uvec3& corners = mesh.triangles[t];
    const glm::vec4 first(instance.positions[corners.x], radius);
    if (turned) splats.normals[t] = normal_of(instance, corners.x);
    if (!segments) {
      splats.places[t] = first;
      return;
    }
    splats.places[2 * t] = first;
    splats.places[2 * t + 1] = glm::vec4(instance.positions[corners.y], radius);
    splats.segments[t] = static_cast<std::uint32_t>(2 * t);
  });
  return splats;
}

void keep_place(const Splats& splats, std::uint32_t number, const SplatRay& ray, float& u,
                float& v) {
  if (splats.kind == ShapeKind::line) {
    v = packed(to_octahedron(ray.normal));
    return;
  }
  if (splats.kind == ShapeKind::sphere) {
    const glm::vec2 at = to_octahedron(ray.normal);
    u = at.x, v = at.y;
    return;
  }
  const glm::vec3 normal =
      splats.normals.empty() ? -unit_or(ray.direction, {0, 0, 1}) : splats.normals[number];
  const geometry::Frame frame = geometry::frame_around(normal);
  const glm::vec3 apart =
      (ray.origin - glm::vec3(splats.places[number])) + ray.direction * ray.distance;
  u = glm::dot(apart, frame.tangent), v = glm::dot(apart, frame.bitangent);
}

Intersection splat_intersection(const GeometryInstance& instance, const Hit& hit,
                                const glm::vec3& direction) {
  const scenes::Mesh& mesh = *instance.mesh;
  const glm::uvec3 corners = mesh.triangles[hit.triangle];
  const float radius = splat_radius(instance, mesh.shape);
  glm::vec3 centre = instance.positions[corners.x];
  Intersection result;
  shading::Point& point = result.point;
  if (!mesh.colours.empty()) point.colour = mesh.colours[corners.x];
  glm::vec3 normal, offset;
  if (mesh.shape.kind == ShapeKind::line) {
    normal = from_octahedron(unpacked(hit.v));
    centre += (instance.positions[corners.y] - centre) * hit.u;
    offset = normal * radius;
    if (!mesh.colours.empty()) point.colour += (mesh.colours[corners.y] - point.colour) * hit.u;
  } else if (mesh.shape.kind == ShapeKind::sphere) {
    normal = from_octahedron({hit.u, hit.v});
    offset = normal * radius;
  } else {
    normal = mesh.normals.empty() ? -direction : normal_of(instance, corners.x);
    const geometry::Frame frame = geometry::frame_around(normal);
    offset = frame.tangent * hit.u + frame.bitangent * hit.v;
  }
  point.position = centre + offset;
  point.geometric_normal = point.normal = normal;
  result.offset = kOffset * (largest_magnitude(centre) + 2 * radius + instance.transform_scale);
  return result;
}

}  // namespace delray::raytrace
