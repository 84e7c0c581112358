// When a refitted tree has become worth building anew.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace delray::raytrace {

// What a ray is expected to cost in a tree that is refitted, over what it cost when the tree was
// built, by the surface area heuristic (Goldsmith and Salmon 1987): the sum of the surfaces of all
// boxes over that of the root. Trees are Embree's own, so that a proxy stands for them: a binary
// tree over up to kSamples of the triangles, evenly taken and sorted along a Z curve when the tree
// was built. Triangles that were neighbours then and have parted make its boxes grow as they make
// those of the real one. O(kSamples log kSamples) to make, O(kSamples) to ask.
class RefitCost {
 public:
  static constexpr std::size_t kSamples = std::size_t{1} << 14;

  RefitCost(std::span<const glm::uvec3> triangles, std::span<const glm::vec3> positions);

  // 1 as long as nothing has changed, and of a mesh that has no extent.
  double growth(std::span<const glm::uvec3> triangles, std::span<const glm::vec3> positions) const;

 private:
  double cost(std::span<const glm::uvec3> triangles, std::span<const glm::vec3> positions) const;

  std::vector<std::uint32_t> order_;  // of the samples: triangles, neighbours side by side
  double built_ = 0;
};

}  // namespace delray::raytrace
