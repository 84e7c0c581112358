// A maximal set of points no two of which are close (dart throwing, Cook 1986), those first that
// stand for points far away. Whoever is left out is within the radius of one that stays, however
// it came to be where it is. The radius is found by bisection; a hash grid finds who is
// near: of cells twice as wide eight have all that is within a radius.
//
// Degenerate: points at one place are one; where all are, one is left.
#include "packs/build/thin_points.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "packs/build/vertices.h"

namespace delray::packs::internal {
namespace {

// Points that stay, by cells of twice the radius.
class Grid {
 public:
  Grid(std::span<const glm::vec3> places, const geometry::Box3& box, float radius)
      : places_(places),
        low_(box.low),
        radius_(radius),
        heads_(std::bit_ceil(places.size()), kEnd) {
    next_.resize(places.size(), kEnd);
  }
  void add(std::uint32_t point) {
    std::uint32_t& head = heads_[slot(cell(places_[point]))];
    next_[point] = head;
    head = point;
  }
  // The nearest point, and how far it is, of those within `most`, which is no more than the radius.
  std::pair<std::uint32_t, float> nearest(const glm::vec3& p, float most) const {
    std::uint32_t found = kEnd;
    float squared = most * most;
    const glm::ivec3 first = cell(p - glm::vec3(radius_));
    for (int k = 0; k < 8; ++k) {
      const glm::ivec3 at = first + glm::ivec3(k & 1, k >> 1 & 1, k >> 2);
      for (std::uint32_t i = heads_[slot(at)]; i != kEnd; i = next_[i]) {
        const glm::vec3 way = places_[i] - p;
        const float distance = glm::dot(way, way);
        if (distance > squared || (distance == squared && found != kEnd && found < i)) continue;
        squared = distance;
        found = i;
      }
    }
    return {found, std::sqrt(squared)};
  }
  static constexpr std::uint32_t kEnd = scenes::kNone;

 private:
  glm::ivec3 cell(const glm::vec3& p) const {
    constexpr float kFarthest = 1e9F;
    return glm::ivec3(glm::min(glm::floor((p - low_) * (0.5F / radius_)), kFarthest));
  }
  std::size_t slot(const glm::ivec3& cell) const {
    const auto bits = [](int v, std::uint64_t by) { return static_cast<std::uint32_t>(v) * by; };
    const std::uint64_t h = bits(cell.x, 0x9E3779B97F4A7C15U) ^ bits(cell.y, 0xC2B2AE3D27D4EB4FU) ^
                            bits(cell.z, 0x165667B19E3779F9U);
    return (h >> 32) & (heads_.size() - 1);
  }

  std::span<const glm::vec3> places_;
  glm::vec3 low_;
  float radius_;
  std::vector<std::uint32_t> heads_, next_;
};

struct Chosen {
  std::vector<std::uint32_t> points;  // that stay, in the order of choosing
  std::vector<float> errors;          // by point
  float largest = 0;
};

class Thinning {
 public:
  Thinning(const scenes::Mesh& mesh, std::span<const float> before) {
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      places_.push_back(mesh.positions[mesh.triangles[i].x]);
      before_.push_back(before.empty() ? 0.0F : before[i]);
      box_.include(places_.back());
    }
    order_.resize(places_.size());
    std::iota(order_.begin(), order_.end(), 0U);
    std::stable_sort(order_.begin(), order_.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return before_[a] > before_[b]; });
  }

  // Everything that is left out has an error of no more than the radius.
  Chosen choose(float radius) const {
    Chosen chosen;
    chosen.errors = before_;
    Grid grid(places_, box_, radius);
    for (const std::uint32_t point : order_) {
      const float most = radius - before_[point];
      const auto [near, distance] =
          most >= 0 ? grid.nearest(places_[point], most) : std::pair{Grid::kEnd, 0.0F};
      if (near == Grid::kEnd) {
        chosen.points.push_back(point);
        grid.add(point);
      } else {
        constexpr float kRounding = 1 + 1e-5F;
        const float error = (before_[point] + distance) * kRounding;
        chosen.errors[near] = std::max(chosen.errors[near], error);
      }
      chosen.largest = std::max(chosen.largest, before_[point]);
    }
    for (const std::uint32_t point : chosen.points)
      chosen.largest = std::max(chosen.largest, chosen.errors[point]);
    return chosen;
  }

  // The least radius that leaves so many points, about.
  Chosen choose_about(std::size_t most) const {
    constexpr int kHalvings = 5;
    constexpr float kGrowth = 2;
    const glm::vec3 size = box_.size();
    const float diagonal = glm::length(size);
    if (!(diagonal > 0)) return choose(1);
    float high = diagonal / std::sqrt(static_cast<float>(places_.size()));
    for (const float error : before_) high = std::max(high, error);
    float low = 0;
    Chosen chosen = choose(high);
    while (chosen.points.size() > most && high < diagonal * kGrowth) {
      low = high;
      high *= kGrowth;
      chosen = choose(high);
    }
    for (int i = 0; i < kHalvings; ++i) {
      const float middle = low > 0 ? std::sqrt(low * high) : high * 0.5F;
      if (!(middle > 0 && std::isnormal(1 / middle))) break;
      Chosen tried = choose(middle);
      if (tried.points.size() > most) {
        low = middle;
      } else {
        high = middle;
        chosen = std::move(tried);
      }
    }
    return chosen;
  }

 private:
  std::vector<glm::vec3> places_;
  std::vector<float> before_;
  std::vector<std::uint32_t> order_;
  geometry::Box3 box_;
};

}  // namespace

Simplified thin_points(const scenes::Mesh& mesh, std::span<const float> before) {
  const auto most =
      static_cast<std::size_t>(kKept * static_cast<double>(mesh.triangles.size())) + 1;
  Chosen chosen = Thinning(mesh, before).choose_about(most);
  std::ranges::sort(chosen.points);
  std::vector<glm::vec3> places;
  for (const std::uint32_t point : chosen.points)
    places.push_back(mesh.positions[mesh.triangles[point].x]);
  Simplified result;
  result.mesh.shape = mesh.shape;
  result.mesh.material = mesh.material;
  result.largest_error = chosen.largest;
  for (const std::uint32_t i : order_along_curve(places)) {
    const std::uint32_t point = chosen.points[i];
    result.mesh.triangles.emplace_back(static_cast<std::uint32_t>(result.mesh.positions.size()));
    copy_vertex(mesh, mesh.triangles[point].x, result.mesh);
    result.errors.push_back(chosen.errors[point]);
  }
  return result;
}

}  // namespace delray::packs::internal
