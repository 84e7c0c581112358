// A tree over a sample of triangles, bottom up over an array: boxes of pairs, pairs of pairs, and
// so on. Degenerate: without triangles, and where all lie in one point, the cost is 0.
#include "raytrace/scene/refit_cost.h"

#include <algorithm>
#include <utility>

#include "geometry/box.h"

namespace delray::raytrace {
namespace {

double surface_of(const geometry::Box3& box) {
  const glm::dvec3 s(box.size());
  return s.x * s.y + s.y * s.z + s.z * s.x;
}

geometry::Box3 box_of_triangle(const glm::uvec3& t, std::span<const glm::vec3> positions) {
  geometry::Box3 box;
  for (int k = 0; k < 3; ++k) box.include(positions[t[k]]);
  return box;
}

// Bits of x with two zeros between any two: x < 2^10.
std::uint32_t spread_bits(std::uint32_t x) {
  x = (x | x << 16) & 0x030000FFU;
  x = (x | x << 8) & 0x0300F00FU;
  x = (x | x << 4) & 0x030C30C3U;
  return (x | x << 2) & 0x09249249U;
}

}  // namespace

RefitCost::RefitCost(std::span<const glm::uvec3> triangles, std::span<const glm::vec3> positions) {
  const std::size_t samples = std::min(kSamples, triangles.size());
  geometry::Box3 all;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> keys(samples);  // on the curve, triangle
  std::vector<glm::vec3> centres(samples);
  for (std::size_t i = 0; i < samples; ++i) {
    const std::size_t t = i * triangles.size() / samples;
    keys[i].second = static_cast<std::uint32_t>(t);
    centres[i] = box_of_triangle(triangles[t], positions).centre();
    all.include(centres[i]);
  }
  for (std::size_t i = 0; i < samples; ++i) {
    for (int k = 0; k < 3; ++k) {
      const float size = all.high[k] - all.low[k];
      const float part = size > 0 ? (centres[i][k] - all.low[k]) / size : 0.0F;
      keys[i].first |= spread_bits(static_cast<std::uint32_t>(part * 1023.0F)) << k;
    }
  }
  std::sort(keys.begin(), keys.end());
  order_.reserve(samples);
  for (const auto& [key, triangle] : keys) order_.push_back(triangle);
  built_ = cost(triangles, positions);
}

double RefitCost::cost(std::span<const glm::uvec3> triangles,
                       std::span<const glm::vec3> positions) const {
  std::vector<geometry::Box3> boxes;
  boxes.reserve(order_.size());
  double sum = 0;
  for (const std::uint32_t t : order_) {
    boxes.push_back(box_of_triangle(triangles[t], positions));
    sum += surface_of(boxes.back());
  }
  while (boxes.size() > 1) {
    std::size_t n = 0;
    for (std::size_t i = 0; i < boxes.size(); i += 2) {
      geometry::Box3 box = boxes[i];
      if (i + 1 < boxes.size()) box.include(boxes[i + 1]);
      sum += surface_of(box);
      boxes[n++] = box;
    }
    boxes.resize(n);
  }
  const double root = boxes.empty() ? 0 : surface_of(boxes.front());
  return root > 0 ? sum / root : 0;
}

double RefitCost::growth(std::span<const glm::uvec3> triangles,
                         std::span<const glm::vec3> positions) const {
  return built_ > 0 ? cost(triangles, positions) / built_ : 1;
}

}  // namespace delray::raytrace
