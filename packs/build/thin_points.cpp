// A set of points near to all others: of those that none is near to, far ones first, the nearest
// point is taken (as by dart throwing, Cook 1986). The radius that leaves as many as wanted is
// searched for in an interval; a hash grid finds who is near: of cells twice as wide eight have all
// that is within a radius.
//
// Degenerate: points at one place are one; where all are, one is left.
#include "packs/build/thin_points.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

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
  std::vector<std::uint32_t> points;   // that stay, in the order of choosing
  std::vector<std::uint32_t> nearest;  // by fine point: the one that it counts for
  std::vector<float> errors;           // by point
  float largest = 0;
};

std::vector<glm::vec3> places_of(const scenes::Mesh& mesh) {
  std::vector<glm::vec3> places;
  places.reserve(mesh.triangles.size());
  for (const glm::uvec3& point : mesh.triangles) places.push_back(mesh.positions[point.x]);
  return places;
}

class Thinning {
 public:
  Thinning(const scenes::Mesh& mesh, const FineSurface& fine)
      : places_(places_of(mesh)), fine_(places_of(fine.mesh)), before_(fine.before) {
    for (const glm::vec3& place : places_) box_.include(place);
    order_.resize(fine_.size());
    std::iota(order_.begin(), order_.end(), 0U);
    std::stable_sort(order_.begin(), order_.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return before(a) > before(b); });
    find_nearest();
  }

  // No error is above the radius, but for rounding, where that is no less than least_radius_.
  Chosen choose(float radius) const {
    Chosen chosen;
    chosen.errors.assign(places_.size(), -1);
    chosen.nearest.resize(fine_.size());
    Grid grid(places_, box_, radius);
    for (const std::uint32_t i : order_) {
      const float most = radius - before(i);
      std::uint32_t point = most >= 0 ? grid.nearest(fine_[i], most).first : Grid::kEnd;
      if (point == Grid::kEnd) {
        point = nearest_[i];
        if (chosen.errors[point] < 0) {
          chosen.errors[point] = 0;
          chosen.points.push_back(point);
          grid.add(point);
        }
      }
      chosen.nearest[i] = point;
    }
    // Points that were chosen later may be nearer.
    for (std::uint32_t i = 0; i < fine_.size(); ++i) {
      std::uint32_t& point = chosen.nearest[i];
      float distance = glm::distance(fine_[i], places_[point]);
      if (distance <= radius) {
        const auto [near, less] = grid.nearest(fine_[i], distance);
        if (near != Grid::kEnd) std::tie(point, distance) = std::pair(near, less);
      }
      constexpr float kRounding = 1 + 1e-5F;
      const float error = (before(i) + distance) * kRounding;
      chosen.errors[point] = std::max(chosen.errors[point], error);
      chosen.largest = std::max(chosen.largest, error);
    }
    return chosen;
  }

  // The least radius that leaves so many points, about: between one that leaves too many and one
  // that does not, where it would be if their number fell with its square.
  Chosen choose_about(std::size_t most) const {
    constexpr int kTries = 6;
    constexpr float kGrowth = 2, kWanted = 0.97F, kEnough = 0.94F;
    const float diagonal = glm::length(box_.size());
    if (!(diagonal > 0)) return choose(1);
    const auto wanted = static_cast<float>(most);
    float low = 0, high = std::max(spacing(), least_radius_);
    Chosen best = choose(high);
    while (best.points.size() > most && high < diagonal * kGrowth) {
      low = high;
      high *= kGrowth;
      best = choose(high);
    }
    float count = static_cast<float>(best.points.size()), radius = high;
    for (int i = 0; i < kTries && (count > wanted || count < kEnough * wanted); ++i) {
      radius *= std::sqrt(count / (kWanted * wanted));
      if (!(radius > low && radius < high)) radius = low > 0 ? std::sqrt(low * high) : high * 0.5F;
      if (!(radius > 0 && std::isnormal(1 / radius))) break;
      Chosen tried = choose(radius);
      count = static_cast<float>(tried.points.size());
      if (tried.points.size() > most) {
        low = radius;
      } else {
        high = radius;
        best = std::move(tried);
      }
    }
    return best;
  }

 private:
  float before(std::uint32_t i) const { return before_.empty() ? 0.0F : before_[i]; }
  float spacing() const {
    return glm::length(box_.size()) / std::sqrt(static_cast<float>(places_.size()));
  }

  void find_nearest() {
    nearest_.assign(fine_.size(), 0);
    float radius = spacing();
    if (!(radius > 0 && std::isnormal(1 / radius))) radius = 1;
    std::vector<std::uint32_t> left = order_;
    while (!left.empty()) {
      Grid grid(places_, box_, radius);
      for (std::uint32_t i = 0; i < places_.size(); ++i) grid.add(i);
      std::erase_if(left, [&](std::uint32_t i) {
        const auto [near, distance] = grid.nearest(fine_[i], radius);
        if (near == Grid::kEnd) return false;
        nearest_[i] = near;
        least_radius_ = std::max(least_radius_, before(i) + distance);
        return true;
      });
      constexpr float kGrowth = 2;
      radius *= kGrowth;
      if (!std::isnormal(radius)) return;
    }
  }

  std::vector<glm::vec3> places_, fine_;
  std::span<const float> before_;       // by fine point
  std::vector<std::uint32_t> order_;    // of fine points
  std::vector<std::uint32_t> nearest_;  // by fine point
  float least_radius_ = 0;              // with which all are near to a point
  geometry::Box3 box_;
};

}  // namespace

ThinnedPoints thin_points(const scenes::Mesh& mesh, const FineSurface& fine) {
  const auto most =
      static_cast<std::size_t>(kKept * static_cast<double>(mesh.triangles.size())) + 1;
  Chosen chosen = Thinning(mesh, fine).choose_about(most);
  std::ranges::sort(chosen.points);
  std::vector<glm::vec3> places;
  for (const std::uint32_t point : chosen.points)
    places.push_back(mesh.positions[mesh.triangles[point].x]);
  ThinnedPoints result;
  result.mesh.shape = mesh.shape;
  result.mesh.material = mesh.material;
  result.errors.largest = chosen.largest;
  std::vector<std::uint32_t> number(mesh.triangles.size());
  for (const std::uint32_t i : order_along_curve(places)) {
    const std::uint32_t point = chosen.points[i];
    number[point] = static_cast<std::uint32_t>(result.mesh.triangles.size());
    result.mesh.triangles.emplace_back(number[point]);
    copy_vertex(mesh, mesh.triangles[point].x, result.mesh);
    result.errors.triangles.push_back(chosen.errors[point]);
  }
  result.errors.nearest.assign(fine.mesh.positions.size(), scenes::kNone);
  for (std::size_t i = 0; i < chosen.nearest.size(); ++i)
    result.errors.nearest[fine.mesh.triangles[i].x] = number[chosen.nearest[i]];
  return result;
}

}  // namespace delray::packs::internal
