#include "delaunay/insertion_order.h"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <random>
#include <utility>

#include "delaunay/internal/cells.h"

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

void sort_along_curve(std::span<std::uint32_t> numbers, std::span<const glm::dvec2> points,
                      const internal::CellGrid& grid) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> places(numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    places[i] = {hilbert_of_morton(grid.number(points[numbers[i]])), numbers[i]};
  }
  std::sort(places.begin(), places.end());
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = places[i].second;
}

}  // namespace

std::vector<std::uint32_t> insertion_order(std::span<const glm::dvec2> points,
                                           std::string_view name, std::uint64_t seed) {
  assert(name == "random" || name == "hilbert" || name == "brio");
  std::vector<std::uint32_t> numbers(points.size());
  std::iota(numbers.begin(), numbers.end(), 0U);
  if (points.empty()) return numbers;
  if (name != "hilbert") shuffle(numbers, seed);
  if (name == "random") return numbers;
  const internal::CellGrid grid(internal::box_of(points));
  // Smaller rounds are not worth a curve of their own.
  constexpr std::size_t kFirstRound = 64;
  const std::size_t smallest = name == "brio" ? kFirstRound : points.size();
  for (std::size_t last = points.size(), first; last > 0; last = first) {
    first = last > smallest ? last / 2 : 0;
    sort_along_curve(std::span(numbers).subspan(first, last - first), points, grid);
  }
  return numbers;
}

}  // namespace delray::delaunay
