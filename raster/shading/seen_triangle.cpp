// Gathers what shading looks up for one triangle: attributes of its corners in the world, planes of
// them over the screen, and points at pixels.
//
// Degenerate: normals, tangents and triangles without a direction get a substitute; triangles whose
// planes would lose their digits are interpolated with bounded shares.
#include "raster/shading/seen_triangle.h"

#include <cmath>

namespace delray::raster {
namespace {

bool has_direction(const glm::vec3& v) {
  const float squared = glm::dot(v, v);
  return squared > 0 && squared <= std::numeric_limits<float>::max();
}

// `otherwise` where v has no direction.
glm::vec3 unit(const glm::vec3& v, const glm::vec3& otherwise) {
  return has_direction(v) ? v * (1.0F / std::sqrt(glm::dot(v, v))) : otherwise;
}

void make_planes(SeenTriangle& triangle) {
  const auto planes = [&](const glm::vec4& p, const glm::vec4& q, const glm::vec4& r) {
    return make_value_planes(triangle.barycentrics, {p, q, r});
  };
  const auto of = [&](const glm::vec3(&v)[3], float last) {
    return planes({v[0], last}, {v[1], last}, {v[2], last});
  };
  triangle.position_planes = of(triangle.position, 1);
  triangle.normal_planes = of(triangle.normal, 0);
  if (triangle.has_tangent) {
    const auto& t = triangle.tangent;
    triangle.tangent_planes = of({glm::vec3(t[0]), glm::vec3(t[1]), glm::vec3(t[2])}, 0);
  }
  if (triangle.has_colour)
    triangle.colour_planes = planes(triangle.colour[0], triangle.colour[1], triangle.colour[2]);
  if (triangle.has_uv || triangle.has_uv2) {
    const auto& uv = triangle.uv;
    const auto& uv2 = triangle.uv2;
    triangle.uv_planes = planes({uv[0], uv2[0]}, {uv[1], uv2[1]}, {uv[2], uv2[2]});
  }
}

void set_first(const shading::TexturePoint& at, shading::Point& point) {
  point.uv = at.uv;
  point.footprint = at.footprint;
}

// The weights of a triangle whose shares have to be bounded.
shading::Point bounded_point_at(const SeenTriangle& triangle, int x, int y) {
  const Weights w = weights_at(triangle.barycentrics, x, y);
  shading::Point point;
  point.position = interpolate(w, triangle.position);
  point.normal = interpolate(w, triangle.normal);
  if (triangle.has_colour) point.colour = interpolate(w, triangle.colour);
  if (triangle.has_uv) set_first(bounded_texture_point(triangle, 0, w), point);
  if (triangle.has_uv2) point.second = bounded_texture_point(triangle, 1, w);
  if (triangle.has_tangent) point.tangent = interpolate(w, triangle.tangent);
  return point;
}

// point_planes.h has the same for vectors.
shading::Point plain_point_at(const SeenTriangle& triangle, int x, int y) {
  const auto dx = static_cast<float>(x - triangle.barycentrics.x);
  const auto dy = static_cast<float>(y - triangle.barycentrics.y);
  shading::Point point;
  const ValuePlanes& positions = triangle.position_planes;
  const glm::vec4 position = sums_at(positions, dx, dy);
  const float share = 1 / position.w;
  point.position = glm::vec3(position) * share;
  point.normal = glm::vec3(sums_at(triangle.normal_planes, dx, dy)) * share;
  if (triangle.has_colour) point.colour = sums_at(triangle.colour_planes, dx, dy) * share;
  const PixelShare at{dx, dy, share};
  if (triangle.has_uv) set_first(texture_point(triangle.uv_planes, 0, positions, at), point);
  if (triangle.has_uv2) point.second = texture_point(triangle.uv_planes, 1, positions, at);
  if (triangle.has_tangent)
    point.tangent = glm::vec4(glm::vec3(sums_at(triangle.tangent_planes, dx, dy)) * share, 0);
  return point;
}

glm::vec3 position_in_world(const Draw& draw, std::uint32_t vertex) {
  const glm::mat4x3& m = *draw.transform;
  const glm::vec3& p = draw.mesh->positions[vertex];
  return ((m[0] * p.x + m[1] * p.y) + m[2] * p.z) + m[3];
}

// 0 where it has no direction.
glm::vec3 normal_in_world(const Draw& draw, const ShadedDraw& shaded, std::uint32_t vertex) {
  return unit(shaded.normal_to_world * draw.mesh->normals[vertex], glm::vec3(0.0F));
}

}  // namespace

glm::vec4 tangent_in_world(const Draw& draw, const ShadedDraw& shaded, std::uint32_t vertex) {
  const glm::mat4x3& m = *draw.transform;
  const glm::vec4& tangent = draw.mesh->tangents[vertex];
  const glm::vec3 along = (m[0] * tangent.x + m[1] * tangent.y) + m[2] * tangent.z;
  return glm::vec4(unit(along, {1, 0, 0}), tangent.w * shaded.handedness);
}

ShadedDraw make_shaded_draw(const scenes::View& view, const Draw& draw) {
  ShadedDraw result;
  const glm::mat4x3& m = *draw.transform;
  result.to_view = to_view(view, m);
  // Normals go with the inverse transpose, which is the cofactors up to a factor.
  const glm::dvec3 x(m[0]), y(m[1]), z(m[2]);
  result.handedness = glm::dot(glm::cross(x, y), z) < 0 ? -1.0F : 1.0F;
  const glm::dmat3 cofactors(glm::cross(y, z), glm::cross(z, x), glm::cross(x, y));
  double largest = 0;
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < 3; ++i) largest = std::max(largest, std::abs(cofactors[k][i]));
  const double scale = largest > 0 ? double{result.handedness} / largest : 0;
  result.normal_to_world = glm::mat3(cofactors * scale);
  return result;
}

Barycentrics make_screen_barycentrics(const Screen& screen, const ToView& to_view,
                                      std::span<const glm::vec3> positions,
                                      const glm::uvec3& corners) {
  const std::uint32_t which[3] = {corners.x, corners.y, corners.z};
  ScreenVertices v;
  transform(to_view, screen, positions, which, v);
  if (!v.any_outside)
    return make_barycentrics(screen, std::array<ScreenVertex, 3>{v[0], v[1], v[2]});
  return make_barycentrics(
      screen, std::array<glm::vec3, 3>{to_view(positions[corners.x]), to_view(positions[corners.y]),
                                       to_view(positions[corners.z])});
}

SeenTriangle make_seen_triangle(const Screen& screen, const shading::Shader& shader,
                                const Draw& draw, const ShadedDraw& shaded, std::uint32_t t) {
  const scenes::Mesh& mesh = *draw.mesh;
  const glm::uvec3& corners = mesh.triangles[t];
  SeenTriangle result;
  result.material = &shading::material(shader, mesh.material);
  result.has_uv = !mesh.uvs.empty();
  result.has_uv2 = !mesh.uvs2.empty();
  result.has_tangent = !mesh.tangents.empty();
  result.blended = shaded.blended;
  result.has_colour = !mesh.colours.empty();
  for (int k = 0; k < 3; ++k) {
    const std::uint32_t i = corners[k];
    result.position[k] = position_in_world(draw, i);
  }
  result.barycentrics = make_screen_barycentrics(screen, shaded.to_view, mesh.positions, corners);
  result.front = result.barycentrics.counter_clockwise == (shaded.handedness > 0);
  const glm::vec3* p = result.position;
  result.geometric_normal =
      unit(glm::cross(p[1] - p[0], p[2] - p[0]) * shaded.handedness, {0, 0, 1});
  const glm::vec3 edges = cross_of_edges(mesh, corners);
  for (int k = 0; k < 3; ++k) {
    const std::uint32_t i = corners[k];
    result.normal[k] = result.geometric_normal;
    if (!mesh.normals.empty()) {
      const glm::vec3 normal = normal_in_world(draw, shaded, i);
      result.own_normal[k] = normal != glm::vec3(0.0F);
      if (result.own_normal[k]) result.normal[k] = normal;
      result.agrees[k] = normal_agrees(mesh, i, edges);
    }
    result.uv[k] = result.has_uv ? mesh.uvs[i] : glm::vec2(0.0F);
    result.uv2[k] = result.has_uv2 ? mesh.uvs2[i] : glm::vec2(0.0F);
    result.colour[k] = mesh.colours.empty() ? glm::vec4(1.0F) : mesh.colours[i];
    result.tangent[k] = glm::vec4(0.0F);
    if (result.has_tangent) {
      result.tangent[k] = tangent_in_world(draw, shaded, i);
    }
  }
  if (result.barycentrics.proper) make_planes(result);
  return result;
}

shading::TexturePoint texture_point(const ValuePlanes& uvs, int set, const ValuePlanes& ones,
                                    const PixelShare& at) {
  const glm::vec4 sums = sums_at(uvs, at.dx, at.dy);
  shading::TexturePoint point;
  for (int k = 0; k < 2; ++k) {
    const int from = 2 * set + k;
    point.uv[k] = sums[from] * at.share;
    point.footprint.dx[k] = (uvs.a[from] - point.uv[k] * ones.a[3]) * at.share;
    point.footprint.dy[k] = (uvs.b[from] - point.uv[k] * ones.b[3]) * at.share;
  }
  return point;
}

shading::TexturePoint bounded_texture_point(const SeenTriangle& triangle, int set,
                                            const Weights& weights) {
  const auto& corners = set == 0 ? triangle.uv : triangle.uv2;
  const Barycentrics& t = triangle.barycentrics;
  const glm::vec2 uv = interpolate(weights, corners);
  return {uv, {derivative(weights, t.a, corners, uv), derivative(weights, t.b, corners, uv)}};
}

shading::Point point_at(const SeenTriangle& triangle, int x, int y) {
  shading::Point point = triangle.barycentrics.proper ? plain_point_at(triangle, x, y)
                                                      : bounded_point_at(triangle, x, y);
  point.geometric_normal = triangle.geometric_normal;
  point.normal = unit(point.normal, triangle.geometric_normal);
  if (triangle.has_tangent) {
    const glm::vec3 tangent(point.tangent);
    const glm::vec3 along = tangent - point.normal * glm::dot(point.normal, tangent);
    point.tangent = glm::vec4(unit(along, glm::vec3(0.0F)), triangle.tangent[0].w);
    if (glm::vec3(point.tangent) == glm::vec3(0.0F)) point.tangent.w = 0;
  }
  return point;
}

shading::Point corner(const SeenTriangle& triangle, int k) {
  shading::Point point;
  point.position = triangle.position[k];
  point.geometric_normal = triangle.geometric_normal;
  point.normal = triangle.normal[k];
  point.colour = triangle.colour[k];
  point.uv = triangle.uv[k];
  point.second.uv = triangle.uv2[k];
  point.tangent = triangle.tangent[k];
  return point;
}

}  // namespace delray::raster
