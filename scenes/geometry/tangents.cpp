// Tangents along growing u on each triangle, summed over the triangles of a vertex and made
// orthogonal to its normal. Vertices are split first where texture space is mirrored. O(vertices +
// triangles), besides the splits. Degenerate: triangles without area in texture space add nothing,
// and a sum along the normal is replaced by any orthogonal direction.
#include <cassert>
#include <cmath>

#include "geometry/frame.h"
#include "scenes/geometry/normals.h"
#include "scenes/geometry/split.h"

namespace delray::scenes::internal {
namespace {

// The direction of growing u on a triangle, with w the sign of its area in texture space; 0 if that
// area is 0. Its length is the triangle's weight: that of the edges.
glm::vec4 tangent_of(const Mesh& mesh, int set, const glm::uvec3& v) {
  const std::vector<glm::vec2>& uvs = mesh.uvs_of(set);
  const glm::vec3 p = mesh.positions[v.y] - mesh.positions[v.x];
  const glm::vec3 q = mesh.positions[v.z] - mesh.positions[v.x];
  const glm::vec2 s = uvs[v.y] - uvs[v.x], t = uvs[v.z] - uvs[v.x];
  const float area = s.x * t.y - s.y * t.x;
  if (!(std::abs(area) > 0)) return glm::vec4(0);
  // v grows downwards, which turns the sense of (u, v) round; the bitangent points along -v, as
  // normal maps of glTF have it.
  const float sign = area > 0 ? 1.0F : -1.0F;
  return {(p * t.y - q * s.y) * sign, -sign};
}

glm::vec3 orthogonal_unit(const glm::vec3& tangent, const glm::vec3& normal) {
  const glm::vec3 flat = tangent - normal * glm::dot(tangent, normal);
  const float length = glm::length(flat);
  const bool usable = length > 0 && std::isfinite(length);
  return usable ? flat / length : geometry::frame_around(normal).tangent;
}

}  // namespace

void compute_tangents(Mesh& mesh, int set) {
  assert(mesh.normals.size() == mesh.positions.size());
  assert(mesh.uvs_of(set).size() == mesh.positions.size());
  std::vector<std::uint32_t> labels(mesh.triangles.size() * 3);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::uint32_t mirrored = tangent_of(mesh, set, mesh.triangles[t]).w < 0 ? 1 : 0;
    labels[3 * t] = labels[3 * t + 1] = labels[3 * t + 2] = mirrored;
  }
  mesh.tangents.clear();
  split_vertices(mesh, labels);
  mesh.tangents.assign(mesh.positions.size(), glm::vec4(0, 0, 0, 1));
  for (const glm::uvec3& triangle : mesh.triangles) {
    const glm::vec4 tangent = tangent_of(mesh, set, triangle);
    for (int k = 0; k < 3 && tangent.w != 0; ++k) {
      glm::vec4& sum = mesh.tangents[triangle[k]];
      sum = glm::vec4(glm::vec3(sum) + glm::vec3(tangent), tangent.w);
    }
  }
  for (std::size_t v = 0; v < mesh.tangents.size(); ++v) {
    glm::vec4& tangent = mesh.tangents[v];
    tangent = glm::vec4(orthogonal_unit(glm::vec3(tangent), mesh.normals[v]), tangent.w);
  }
}

}  // namespace delray::scenes::internal
