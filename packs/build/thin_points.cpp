// Covers points by balls around some of them, few for their radius: a sweep comes to the first
// point that is not covered, and of a few points further on whose balls have it takes the one that
// covers most of what is left, a greedy choice of sets (Johnson 1974) that leaves no gaps behind
// it. On a plane 0.50 / radius^2 points are taken for a unit of area where there are many to choose
// from; dart throwing takes 0.66, the thinnest cover of all 0.38. The radius that leaves as many as
// wanted is searched for in an interval. Where balls have many points a sample of them tells how
// much each covers. A hash grid finds who is near: of cells twice as wide as the radius eight have
// all of a ball.
//
// Degenerate: points at one place are one; where all are, one is left. A radius is no less than
// what rounding does to places: beside one that is very far away others are as one.
#include "packs/build/thin_points.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "packs/build/vertices.h"

namespace delray::packs::internal {
namespace {

// Points by cell, of which each has a reach: squared, or less than 0 where it has none.
class Grid {
 public:
  Grid(std::span<const glm::vec3> places, const glm::vec3& low, float radius)
      : low_(low), radius_(radius), first_(std::bit_ceil(places.size()) + 1) {
    std::vector<std::uint32_t> slots;
    slots.reserve(places.size());
    for (const glm::vec3& place : places) {
      slots.push_back(slot(cell(place - low)));
      ++first_[slots.back() + 1];
    }
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::vector<float>& values : values_) values.resize(places.size());
    point_.resize(places.size());
    at_.resize(places.size());
    for (std::uint32_t i = 0; i < places.size(); ++i) {
      const std::uint32_t at = next[slots[i]]++;
      for (int k = 0; k < 3; ++k) values_[k][at] = places[i][k];
      point_[at] = i;
      at_[i] = at;
    }
  }
  void set_reach(std::uint32_t point, float squared) { values_[3][at_[point]] = squared; }
  bool has_reach(std::uint32_t point) const { return values_[3][at_[point]] >= 0; }

  // Calls f(point, squared distance) for at least all points within the radius.
  template <class F>
  void for_each_near(const glm::vec3& p, F&& f) const {
    for_each_cell(p, [&](std::uint32_t begin, std::uint32_t end) {
      for (std::uint32_t at = begin; at < end; ++at) f(point_[at], squared_distance(at, p));
    });
  }
  // How many points reach a place.
  std::uint32_t count(const glm::vec3& p) const {
    std::uint32_t result = 0;
    for_each_cell(p, [&](std::uint32_t begin, std::uint32_t end) {
      for (std::uint32_t at = begin; at < end; ++at)
        result += squared_distance(at, p) <= values_[3][at] ? 1U : 0U;
    });
    return result;
  }

 private:
  float squared_distance(std::uint32_t at, const glm::vec3& p) const {
    const float x = values_[0][at] - p.x, y = values_[1][at] - p.y, z = values_[2][at] - p.z;
    return x * x + y * y + z * z;
  }
  template <class F>
  void for_each_cell(const glm::vec3& p, F&& f) const {
    // What rounding may have moved places by comes on top, for which there may be a third cell.
    constexpr float kRounding = 8 * std::numeric_limits<float>::epsilon();
    const glm::vec3 at = p - low_, reach = glm::vec3(radius_) + glm::abs(at) * kRounding;
    const glm::ivec3 first = cell(at - reach), last = cell(at + reach);
    std::array<std::uint32_t, 27> seen;
    std::size_t count = 0;
    for (int z = first.z; z <= last.z; ++z) {
      for (int y = first.y; y <= last.y; ++y) {
        for (int x = first.x; x <= last.x; ++x) {
          const std::uint32_t s = slot({x, y, z});
          const auto end = seen.begin() + static_cast<std::ptrdiff_t>(count);
          if (first_[s] == first_[s + 1] || std::find(seen.begin(), end, s) != end) continue;
          if (count == seen.size()) return;  // cannot be: a cell is two radii wide
          seen[count++] = s;
          f(first_[s], first_[s + 1]);
        }
      }
    }
  }
  // Of a place as seen from low_.
  glm::ivec3 cell(const glm::vec3& at) const {
    constexpr float kFarthest = 1e9F;
    return glm::ivec3(glm::clamp(glm::floor(at * (0.5F / radius_)), -kFarthest, kFarthest));
  }
  std::uint32_t slot(const glm::ivec3& cell) const {
    const auto bits = [](int v, std::uint64_t by) { return static_cast<std::uint32_t>(v) * by; };
    const std::uint64_t h = bits(cell.x, 0x9E3779B97F4A7C15U) ^ bits(cell.y, 0xC2B2AE3D27D4EB4FU) ^
                            bits(cell.z, 0x165667B19E3779F9U);
    return static_cast<std::uint32_t>((h >> 32) & (first_.size() - 2));
  }

  glm::vec3 low_;
  float radius_;
  std::vector<std::uint32_t> first_;          // by slot, and the end
  std::array<std::vector<float>, 4> values_;  // coordinates and reach, by place in the grid
  std::vector<std::uint32_t> point_, at_;     // by place in the grid; by point
};

struct Chosen {
  std::vector<std::uint32_t> points;  // that stay
  std::vector<std::uint32_t> whose;   // by point: the number in `points` that it counts for
  std::vector<float> errors;          // of those
};

// Points are numbered in the order of the sweep.
class Thinning {
 public:
  explicit Thinning(const FineSurface& fine) {
    const std::size_t n = fine.mesh.triangles.size();
    const auto place = [&](std::uint32_t i) -> const glm::vec3& {
      return fine.mesh.positions[fine.mesh.triangles[i].x];
    };
    for (std::uint32_t i = 0; i < n; ++i) box_.include(place(i));
    const glm::vec3 size = box_.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    std::vector<std::pair<float, std::uint32_t>> order(n);
    for (std::uint32_t i = 0; i < n; ++i) order[i] = {place(i)[axis], i};
    std::sort(order.begin(), order.end());
    for (const auto& [coordinate, i] : order) {
      triangle_.push_back(i);
      places_.push_back(place(i));
      before_.push_back(fine.before.empty() ? 0.0F : fine.before[i]);
    }
  }
  // Its number as a triangle of the mesh.
  std::uint32_t triangle(std::uint32_t point) const { return triangle_[point]; }

  // Around each point that is left those that count for it are within the radius, with their error
  // before, unless that alone is more.
  Chosen choose(float radius) const {
    Chosen chosen;
    Grid left(places_, box_.low, radius);
    std::optional<Grid> sample;  // those that tell how much a ball covers, where not all do
    if (stride_ > 1) {
      std::vector<glm::vec3> places;
      for (std::size_t i = 0; i < places_.size(); i += stride_) places.push_back(places_[i]);
      sample.emplace(places, box_.low, radius);
    }
    const Grid& some_left = sample ? *sample : left;
    const auto set_reach = [&](std::uint32_t i, float squared) {
      left.set_reach(i, squared);
      if (sample && i % stride_ == 0) sample->set_reach(i / stride_, squared);
    };
    for (std::uint32_t i = 0; i < places_.size(); ++i) {
      const float reach = radius - before_[i];
      set_reach(i, reach >= 0 ? reach * reach : -1);
    }
    std::vector<std::uint32_t> ahead;
    chosen.whose.assign(places_.size(), scenes::kNone);
    for (std::uint32_t i = 0; i < places_.size(); ++i) {
      if (chosen.whose[i] != scenes::kNone) continue;
      const std::uint32_t best = best_ahead(some_left, i, radius, ahead);
      const auto number = static_cast<std::uint32_t>(chosen.points.size());
      chosen.points.push_back(best);
      const auto give = [&](std::uint32_t j) {
        chosen.whose[j] = number;
        set_reach(j, -1);
      };
      left.for_each_near(places_[best], [&](std::uint32_t j, float squared) {
        const float reach = radius - before_[j];
        if (left.has_reach(j) && squared <= reach * reach) give(j);
      });
      give(i);
      give(best);
    }
    return chosen;
  }
  // One that all count for.
  Chosen choose_one() const {
    Chosen chosen{{0}, std::vector<std::uint32_t>(places_.size(), 0), {}};
    find_errors(chosen);
    return chosen;
  }

  // The least radius that leaves so many points, about: between one that leaves too many and one
  // that does not, where it would be if their number fell with its square.
  Chosen choose_about(std::size_t most, float expected) {
    constexpr std::size_t kInBall = 32;  // of the points that tell, on the average
    stride_ = static_cast<std::uint32_t>(std::max<std::size_t>(1, places_.size() / most / kInBall));
    constexpr int kTries = 7;
    constexpr float kGrowth = 2, kWanted = 0.97F, kEnough = 0.94F, kCover = 0.5F;
    const float diagonal = glm::length(box_.size());
    const auto wanted = static_cast<float>(most);
    // Of less than what rounding does to places nothing can be told.
    const float least = 16 * std::numeric_limits<float>::epsilon() * diagonal;
    const float start = std::max(least, kCover * diagonal / std::sqrt(wanted));
    float radius = expected > least ? expected : start;
    float low = 0, high = std::numeric_limits<float>::infinity();
    Chosen best;
    for (int i = 0; i < kTries || std::isinf(high); ++i) {
      if (!std::isnormal(radius) || !std::isnormal(1 / radius)) break;
      Chosen tried = choose(radius);
      const auto count = static_cast<float>(tried.points.size());
      if (tried.points.size() > most) {
        low = radius;
        if (radius >= diagonal * kGrowth) break;
      } else {
        high = radius;
        best = std::move(tried);
        if (count >= kEnough * wanted) break;
      }
      const bool is_misled = i == 0 && ((count > 2 * wanted && start > radius) ||
                                        (2 * count < wanted && start < radius));
      radius =
          is_misled && radius != start ? start : radius * std::sqrt(count / (kWanted * wanted));
      if (std::isinf(high)) {
        radius = std::max(radius, low * (i + 1 < kTries ? 1 : kGrowth));
      } else if (!(radius > low && radius < high)) {
        radius = low > 0 ? std::sqrt(low * high) : high * 0.5F;
      }
      if (!(radius > least)) break;
    }
    if (best.points.empty()) return choose_one();
    find_nearer(high, best);
    return best;
  }

 private:
  // Of a few points whose balls have point i, none before it, the one that covers most, as far as
  // some of the points tell.
  std::uint32_t best_ahead(const Grid& some_left, std::uint32_t i, float radius,
                           std::vector<std::uint32_t>& ahead) const {
    constexpr std::size_t kLookAt = 16;
    const float reach = radius - before_[i];
    ahead.clear();
    if (reach > 0) {
      some_left.for_each_near(places_[i], [&](std::uint32_t j, float squared) {
        if (j * stride_ > i && squared <= reach * reach) ahead.push_back(j * stride_);
      });
    }
    std::uint32_t best = i, most = 0;
    const auto look_at = [&](std::uint32_t j) {
      const std::uint32_t count = some_left.count(places_[j]);
      if (count > most) most = count, best = j;
    };
    const std::size_t looks = std::min(kLookAt, ahead.size());
    for (std::size_t k = 0; k < looks; ++k) look_at(ahead[ahead.size() * k / looks]);
    look_at(i);
    return best;
  }

  // Points that were chosen later may be nearer.
  void find_nearer(float radius, Chosen& chosen) const {
    std::vector<glm::vec3> places;
    places.reserve(chosen.points.size());
    for (const std::uint32_t point : chosen.points) places.push_back(places_[point]);
    const Grid grid(places, box_.low, radius);
    for (std::uint32_t i = 0; i < places_.size(); ++i) {
      std::uint32_t& nearest = chosen.whose[i];
      const glm::vec3 way = places_[i] - places[nearest];
      float least = glm::dot(way, way);
      grid.for_each_near(places_[i], [&](std::uint32_t j, float squared) {
        if (squared > least || (squared == least && j > nearest)) return;
        least = squared;
        nearest = j;
      });
    }
    find_errors(chosen);
  }
  void find_errors(Chosen& chosen) const {
    constexpr float kRounding = 1 + 1e-5F;
    chosen.errors.assign(chosen.points.size(), 0);
    for (std::uint32_t i = 0; i < places_.size(); ++i) {
      float& error = chosen.errors[chosen.whose[i]];
      const float distance = glm::distance(places_[i], places_[chosen.points[chosen.whose[i]]]);
      error = std::max(error, (before_[i] + distance) * kRounding);
    }
  }

  std::vector<std::uint32_t> triangle_;
  std::vector<glm::vec3> places_;
  std::vector<float> before_;
  std::uint32_t stride_ = 1;  // one in so many points tells how much a ball covers
  geometry::Box3 box_;
};

}  // namespace

ThinnedPoints thin_points(const FineSurface& fine, std::size_t most, float expected) {
  Thinning thinning(fine);
  const Chosen chosen = thinning.choose_about(most, expected);
  ThinnedPoints result;
  result.mesh.shape = fine.mesh.shape;
  result.mesh.material = fine.mesh.material;
  const auto vertex_of = [&](std::uint32_t point) {
    return fine.mesh.triangles[thinning.triangle(point)].x;
  };
  std::vector<glm::vec3> places;
  for (const std::uint32_t point : chosen.points)
    places.push_back(fine.mesh.positions[vertex_of(point)]);
  std::vector<std::uint32_t> number(chosen.points.size());
  for (const std::uint32_t i : order_along_curve(places)) {
    number[i] = static_cast<std::uint32_t>(result.mesh.triangles.size());
    result.mesh.triangles.emplace_back(number[i]);
    copy_vertex(fine.mesh, vertex_of(chosen.points[i]), result.mesh);
    result.errors.triangles.push_back(chosen.errors[i]);
  }
  result.errors.largest = std::ranges::max(result.errors.triangles);
  result.errors.nearest.assign(fine.mesh.positions.size(), scenes::kNone);
  for (std::uint32_t i = 0; i < chosen.whose.size(); ++i)
    result.errors.nearest[vertex_of(i)] = number[chosen.whose[i]];
  return result;
}

}  // namespace delray::packs::internal
