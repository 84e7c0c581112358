#include "delaunay/insertion_order.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <numeric>
#include <random>
#include <utility>

#include "delaunay/internal/cells.h"
#include "delaunay/internal/hilbert3.h"

namespace delray::delaunay {
namespace {

// The place on the Hilbert curve of a cell of the Morton order: at each level the quadrant's two
// bits (x below y) are turned as the curve is turned there.
std::uint32_t hilbert_of_morton(std::uint32_t morton) {
  std::uint32_t place = 0;
  bool exchange = false, mirror = false;
  for (int shift = 30; shift >= 0; shift -= 2) {
    bool x = (morton >> shift & 1) != 0, y = (morton >> shift & 2) != 0;
    if (exchange) std::swap(x, y);
    if (mirror) x = !x, y = !y;
    place = place << 2 | ((x ? 3U : 0U) ^ (y ? 1U : 0U));
    // The first and the last quadrant hold the curve reflected in one of the diagonals.
    if (!y) {
      exchange = !exchange;
      if (x) mirror = !mirror;
    }
  }
  return place;
}

void shuffle(std::span<std::uint32_t> numbers, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  // Not std::shuffle, whose result differs between libraries. The bias is below n / 2^64.
  for (std::size_t i = numbers.size(); i > 1; --i) std::swap(numbers[i - 1], numbers[random() % i]);
}

// The places of points on the curve over their bounding box.
class PlaneCurve {
 public:
  using Place = std::uint32_t;
  explicit PlaneCurve(std::span<const glm::dvec2> points) : grid_(internal::box_of(points)) {}
  Place operator()(const glm::dvec2& p) const { return hilbert_of_morton(grid_.number(p)); }

 private:
  internal::CellGrid grid_;
};

class SpaceCurve {
 public:
  using Place = std::uint64_t;
  explicit SpaceCurve(std::span<const glm::dvec3> points) {
    glm::dvec3 low = points[0], high = points[0];
    for (const glm::dvec3& p : points) {
      low = min(low, p);
      high = max(high, p);
    }
    // Neither the width nor its reciprocal may overflow.
    const glm::dvec3 size = high * 0.25 - low * 0.25;
    const double width = std::max({size.x, size.y, size.z});
    if (width > 0x1p+900) before_ = 0x1p-200;
    if (width < 0x1p-900) before_ = 0x1p+600;
    low_ = low * (0.25 * before_);
    if (width > 0) scale_ = (kCellsAcross - 0.5) / (width * before_);
  }
  Place operator()(const glm::dvec3& p) const {
    const glm::dvec3 place = (p * (0.25 * before_) - low_) * scale_;
    std::array<std::uint32_t, 3> cell;
    for (int k = 0; k < 3; ++k) {
      cell[static_cast<std::size_t>(k)] =
          static_cast<std::uint32_t>(std::clamp(place[k], 0.0, kCellsAcross - 1));
    }
    return internal::place_on_curve(cell, kBits);
  }

 private:
  static constexpr int kBits = 20;
  static constexpr double kCellsAcross = 0x1p+20;

  double before_ = 1, scale_ = 0;
  glm::dvec3 low_{0};
};

template <class Curve, class Point>
void sort_along_curve(std::span<std::uint32_t> numbers, std::span<const Point> points,
                      const Curve& curve) {
  std::vector<std::pair<typename Curve::Place, std::uint32_t>> places(numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    places[i] = {curve(points[numbers[i]]), numbers[i]};
  }
  std::sort(places.begin(), places.end());
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = places[i].second;
}

template <class Curve, class Point>
std::vector<std::uint32_t> order_of(std::span<const Point> points, std::string_view name,
                                    std::uint64_t seed, double start) {
  assert(name == "random" || name == "hilbert" || name == "brio");
  std::vector<std::uint32_t> numbers(points.size());
  std::iota(numbers.begin(), numbers.end(), 0U);
  if (points.empty()) return numbers;
  if (name != "hilbert") shuffle(numbers, seed);
  if (name == "random") return numbers;
  const Curve curve(points);
  // Smaller rounds are not worth a curve of their own.
  constexpr std::size_t kFirstRound = 64;
  const std::size_t smallest = name == "brio" ? kFirstRound : points.size();
  for (std::size_t last = points.size(), first; last > 0; last = first) {
    first = last > smallest ? last / 2 : 0;
    const std::span<std::uint32_t> round = std::span(numbers).subspan(first, last - first);
    sort_along_curve(round, points, curve);
    const double begin = start * static_cast<double>(round.size());
    std::rotate(round.begin(), round.begin() + static_cast<std::ptrdiff_t>(begin), round.end());
  }
  return numbers;
}

}  // namespace

std::vector<std::uint32_t> insertion_order(std::span<const glm::dvec2> points,
                                           std::string_view name, std::uint64_t seed,
                                           double start) {
  return order_of<PlaneCurve>(points, name, seed, start);
}

std::vector<std::uint32_t> insertion_order(std::span<const glm::dvec3> points,
                                           std::string_view name, std::uint64_t seed,
                                           double start) {
  return order_of<SpaceCurve>(points, name, seed, start);
}

}  // namespace delray::delaunay
