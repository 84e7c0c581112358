// Makes an octahedron of each point, six vertices and eight faces, in parallel over points.
#include "apps/input/dots.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "parallel/parallel_for.h"

namespace delray::apps {
namespace {

constexpr std::size_t kDotsPerBlock = 1024;  // some 20 microseconds of copying
constexpr float kTouching = 1.2F;            // of the distance in a square lattice on the surface
constexpr float kSmallest = 1e-3F, kLargest = 2e-2F;  // of the diagonal

constexpr std::array kCorners = {glm::vec3(1, 0, 0),  glm::vec3(-1, 0, 0), glm::vec3(0, 1, 0),
                                 glm::vec3(0, -1, 0), glm::vec3(0, 0, 1),  glm::vec3(0, 0, -1)};
constexpr std::array kFaces = {glm::uvec3(0, 2, 4), glm::uvec3(2, 1, 4), glm::uvec3(1, 3, 4),
                               glm::uvec3(3, 0, 4), glm::uvec3(2, 0, 5), glm::uvec3(1, 2, 5),
                               glm::uvec3(3, 1, 5), glm::uvec3(0, 3, 5)};

}  // namespace

float dot_diameter(std::size_t points, const glm::vec3& size) {
  const float apart = kTouching / std::sqrt(static_cast<float>(std::max<std::size_t>(1, points)));
  const float diagonal = glm::length(size);
  return (diagonal > 0 ? diagonal : 1.0F) * std::clamp(apart, kSmallest, kLargest);
}

std::size_t draw_as_dots(scenes::Mesh& mesh, float diameter) {
  const std::size_t step = (mesh.positions.size() + kMostDots - 1) / kMostDots;
  const std::size_t dots = step == 0 ? 0 : (mesh.positions.size() + step - 1) / step;
  scenes::Mesh drawn;
  drawn.name = mesh.name;
  drawn.material = mesh.material;
  drawn.positions.resize(dots * kCorners.size());
  drawn.normals.resize(dots * kCorners.size());
  if (!mesh.colours.empty()) drawn.colours.resize(dots * kCorners.size());
  drawn.triangles.resize(dots * kFaces.size());
  parallel::parallel_for(0, dots, kDotsPerBlock, [&](std::size_t i) {
    const std::size_t first = i * kCorners.size();
    for (std::size_t k = 0; k < kCorners.size(); ++k) {
      drawn.positions[first + k] = mesh.positions[i * step] + kCorners[k] * (diameter * 0.5F);
      drawn.normals[first + k] = kCorners[k];
      if (!mesh.colours.empty()) drawn.colours[first + k] = mesh.colours[i * step];
    }
    for (std::size_t k = 0; k < kFaces.size(); ++k) {
      drawn.triangles[i * kFaces.size() + k] = kFaces[k] + static_cast<std::uint32_t>(first);
    }
  });
  mesh = std::move(drawn);
  return step;
}

}  // namespace delray::apps
