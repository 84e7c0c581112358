// Insertion orders: random, along a Hilbert curve, and the biased randomized order BRIO (Amenta,
// Choi and Rote 2003).
//
// BRIO shuffles the points and sorts rounds of doubling size, the last being half of all points,
// each by the place of the points on the curve. Places are computed once; the rounds are sorted by
// several threads. O(n log n).
//
// Degenerate: equal points have one place on the curve, and their order is deterministic.
// Coordinates are scaled so that neither the width of the bounding box nor its reciprocal
// overflows, and a box without width maps all points to one place.
#include "delaunay/insertion/insertion_order.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>
#include <numeric>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>

#include "delaunay/mesh/array.h"
#include "delaunay/mesh/blocks.h"
#include "delaunay/order/cells.h"
#include "delaunay/order/radix_sort.h"
#include "geometry/hilbert_curve.h"
#include "parallel/team.h"

namespace delray::delaunay {
namespace {

// The way of the curve through the quadrants of a square: whether x and y are exchanged, and then
// both mirrored (bits 0 and 1 of the state), on the way in.
struct Quadrant {
  std::uint8_t place, state;
};

constexpr std::array<std::array<Quadrant, 4>, 4> quadrants() {
  std::array<std::array<Quadrant, 4>, 4> result{};
  for (unsigned state = 0; state < 4; ++state) {
    for (unsigned quadrant = 0; quadrant < 4; ++quadrant) {
      bool x = (quadrant & 1) != 0, y = (quadrant & 2) != 0;
      if ((state & 1) != 0) std::swap(x, y);
      if ((state & 2) != 0) x = !x, y = !y;
      // The first and the last quadrant hold the curve reflected in one of the diagonals.
      const unsigned turn = y ? 0U : x ? 3U : 1U;
      result[state][quadrant] = {static_cast<std::uint8_t>((x ? 3U : 0U) ^ (y ? 1U : 0U)),
                                 static_cast<std::uint8_t>(state ^ turn)};
    }
  }
  return result;
}

// The place on the Hilbert curve of a cell of the Morton order, from the largest quadrants down.
std::uint32_t hilbert_of_morton(std::uint32_t morton) {
  static constexpr auto kQuadrants = quadrants();
  std::uint32_t place = 0;
  unsigned state = 0;
  for (int shift = 30; shift >= 0; shift -= 2) {
    const Quadrant quadrant = kQuadrants[state][morton >> shift & 3];
    place = place << 2 | quadrant.place;
    state = quadrant.state;
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
    return geometry::place_on_curve(cell, kBits);
  }

 private:
  static constexpr int kBits = 20;
  static constexpr double kCellsAcross = 0x1p+20;

  double before_ = 1, scale_ = 0;
  glm::dvec3 low_{0};
};

// Sorts numbers by places[number].
void sort_by_place(std::span<std::uint32_t> numbers, std::span<const std::uint32_t> places) {
  Array<std::uint64_t> entries(numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    entries[i] = std::uint64_t{places[numbers[i]]} << 32 | numbers[i];
  }
  internal::radix_sort(entries, internal::Blocks(numbers.size(), 1));
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    numbers[i] = static_cast<std::uint32_t>(entries[i]);
  }
}

void sort_by_place(std::span<std::uint32_t> numbers, std::span<const std::uint64_t> places) {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> entries(numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) entries[i] = {places[numbers[i]], numbers[i]};
  std::sort(entries.begin(), entries.end());
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = entries[i].second;
}

// A thread takes about as long to start as to sort so many points.
constexpr std::size_t kPerThread = 4096;

// Calls f(first, last) for the threads' shares of [0, n).
template <class F>
void in_parts(std::size_t n, std::size_t threads, F&& f) {
  const std::size_t parts = n < threads * kPerThread ? 1 : threads;
  parallel::Team().run(parts,
                       [&](std::size_t part) { f(n * part / parts, n * (part + 1) / parts); });
}

template <class Curve, class Point>
std::vector<std::uint32_t> order_of(std::span<const Point> points, std::string_view name,
                                    std::uint64_t seed, double start, std::size_t threads) {
  if (name != "random" && name != "hilbert" && name != "brio")
    throw std::invalid_argument("there is no order \"" + std::string(name) + "\"");
  if (!(start >= 0 && start < 1))
    throw std::invalid_argument("an order starts at least 0 and less than 1 of the way");
  std::vector<std::uint32_t> numbers(points.size());
  std::iota(numbers.begin(), numbers.end(), 0U);
  if (points.empty()) return numbers;
  if (name != "hilbert") shuffle(numbers, seed);
  if (name == "random") return numbers;
  const Curve curve(points);
  // All at once, in the order in which points lie in memory.
  std::vector<typename Curve::Place> places(points.size());
  in_parts(points.size(), threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) places[i] = curve(points[i]);
  });
  // Smaller rounds are not worth a curve of their own.
  constexpr std::size_t kFirstRound = 64;
  const std::size_t smallest = name == "brio" ? kFirstRound : points.size();
  std::vector<std::span<std::uint32_t>> rounds;
  for (std::size_t last = points.size(), first; last > 0; last = first) {
    first = last > smallest ? last / 2 : 0;
    rounds.push_back(std::span(numbers).subspan(first, last - first));
  }
  std::atomic<std::size_t> next = 0;  // the largest first
  const auto sort_rounds = [&](std::size_t) {
    for (std::size_t i = next++; i < rounds.size(); i = next++) {
      sort_by_place(rounds[i], places);
      const double begin = start * static_cast<double>(rounds[i].size());
      std::rotate(rounds[i].begin(), rounds[i].begin() + static_cast<std::ptrdiff_t>(begin),
                  rounds[i].end());
    }
  };
  const std::size_t sorting =
      points.size() < threads * kPerThread ? 1 : std::min(threads, rounds.size());
  parallel::Team().run(sorting, sort_rounds);
  return numbers;
}

}  // namespace

std::vector<std::uint32_t> insertion_order(std::span<const glm::dvec2> points,
                                           std::string_view name, std::uint64_t seed, double start,
                                           std::size_t threads) {
  return order_of<PlaneCurve>(points, name, seed, start, threads);
}

std::vector<std::uint32_t> insertion_order(std::span<const glm::dvec3> points,
                                           std::string_view name, std::uint64_t seed, double start,
                                           std::size_t threads) {
  return order_of<SpaceCurve>(points, name, seed, start, threads);
}

}  // namespace delray::delaunay
