// A biased randomized insertion order in space (Amenta, Choi and Rote 2003) by one radix sort.
//
// Each point gets a 64-bit key of its random round, its place on a Hilbert curve and its row; keys
// are sorted by their 11-bit digits in parallel, and the points are copied in that order. Each
// round is several times as large as the one before. O(n).
//
// Degenerate: coordinates are scaled so that neither the extent nor its reciprocal overflows, and
// an extent of 0 puts all points into one cell, in the order of their rows within a round.
#include "delaunay/order/curve_order_3d.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "delaunay/mesh/blocks.h"
#include "geometry/hilbert_curve.h"

namespace delray::delaunay::internal {
namespace {

glm::dvec3 point_at_3d(const PointView<double>& points, std::size_t row) {
  return {points(row, 0) + 0.0, points(row, 1) + 0.0, points(row, 2) + 0.0};
}

std::uint64_t scramble(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31);
}

// Sorts by the bits [first_bit, last_bit) from the lowest digit up; items that are equal in them
// stay in order.
void radix_sort(Array<std::uint64_t>& items, int first_bit, int last_bit, const Blocks& blocks) {
  constexpr int kDigit = 11;
  using Counts = std::array<std::uint32_t, std::size_t{1} << kDigit>;
  Array<std::uint64_t> other(items.size());
  std::vector<Counts> counts(blocks.count());
  for (int shift = first_bit; shift < last_bit; shift += kDigit) {
    const auto digit = [shift](std::uint64_t item) {
      return (item >> shift) & ((std::size_t{1} << kDigit) - 1);
    };
    blocks.for_each([&](std::size_t block, std::size_t first, std::size_t last) {
      counts[block].fill(0);
      for (std::size_t i = first; i < last; ++i) ++counts[block][digit(items[i])];
    });
    std::uint32_t begin = 0;
    for (std::size_t d = 0; d < counts[0].size(); ++d) {
      for (Counts& count : counts) begin += std::exchange(count[d], begin);
    }
    blocks.for_each([&](std::size_t block, std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) {
        other[counts[block][digit(items[i])]++] = items[i];
      }
    });
    std::swap(items, other);
  }
}

struct Found {
  glm::dvec3 low, high;
  int exponent = kNone;
  bool finite = true;

  static constexpr int kNone = 4000;
};

// REQUIRES: first < last.
Found find_range(const PointView<double>& points, std::size_t first, std::size_t last) {
  Found found;
  found.low = found.high = point_at_3d(points, first);
  for (std::size_t row = first; row < last; ++row) {
    const glm::dvec3 p = point_at_3d(points, row);
    found.low = min(found.low, p);
    found.high = max(found.high, p);
    for (int k = 0; k < 3; ++k) {
      found.finite &= p[k] - p[k] == 0;
      if (p[k] == 0) continue;
      const auto bits = std::bit_cast<std::uint64_t>(p[k]);
      const auto biased = static_cast<int>(bits >> 52 & 0x7ff);
      // Denormals have no leading 1, and the exponent of the smallest normal numbers.
      const std::uint64_t mantissa =
          (bits & ((std::uint64_t{1} << 52) - 1)) | (biased != 0 ? std::uint64_t{1} << 52 : 0);
      found.exponent =
          std::min(found.exponent, std::max(biased, 1) - 1075 + std::countr_zero(mantissa));
    }
  }
  return found;
}

}  // namespace

PointRange finite_range(const PointView<double>& points, int threads) {
  PointRange range;
  if (points.size() == 0) return range;
  const Blocks blocks(points.size(), threads);
  std::vector<Found> parts(blocks.count());
  blocks.for_each([&](std::size_t block, std::size_t first, std::size_t last) {
    parts[block] = find_range(points, first, last);
  });
  Found all = parts[0];
  for (const Found& part : parts) {
    all.low = min(all.low, part.low);
    all.high = max(all.high, part.high);
    all.exponent = std::min(all.exponent, part.exponent);
    all.finite &= part.finite;
  }
  range.low = all.low;
  range.high = all.high;
  if (all.exponent != Found::kNone) range.grid_exponent = all.exponent;
  if (all.finite) return range;
  std::size_t row = 0;
  while (std::isfinite(points(row, 0)) && std::isfinite(points(row, 1)) &&
         std::isfinite(points(row, 2))) {
    ++row;
  }
  throw std::invalid_argument("row " + std::to_string(row) +
                              " has a coordinate that is not finite");
}

CurveOrder3d curve_order_3d(const PointView<double>& points, const PointRange& range,
                            std::uint64_t seed, int threads) {
  const std::size_t n = points.size();
  // Each round is some times larger than all before it. In small ones the walks are long, but in
  // large ones the curve alone would visit degenerate sets in a bad order, and the simplices at its
  // beginning are so large that threads stand in each other's way.
  constexpr unsigned kGrowth = 4;
  constexpr std::size_t kFirstRound = 500;
  int rounds = 1;
  for (std::size_t size = n; size > kFirstRound && rounds < 15; size /= kGrowth) ++rounds;
  // Cells of about 2^-12 of a point each if points are everywhere alike, as far as round, place on
  // the curve and row fit one word.
  const int row_bits = static_cast<int>(std::bit_width(n)), round_bits = 4;
  const int bits = std::min(row_bits / 3 + 4, (64 - round_bits - row_bits) / 3);

  // Neither the width nor its reciprocal may overflow.
  double before = 1;
  glm::dvec3 size = range.high * 0.25 - range.low * 0.25;
  const double width = std::max({size.x, size.y, size.z});
  if (width > 0x1p+900) before = 0x1p-200;
  if (width < 0x1p-900) before = 0x1p+600;
  const glm::dvec3 low = range.low * (0.25 * before);
  const double cells = std::ldexp(1.0, bits);
  const double scale = width > 0 ? (cells - 0.5) / (width * before) : 0;

  const Blocks blocks(n, threads);
  Array<std::uint64_t> keys(n);  // from the highest bits: round, place, row
  const auto make_key = [&](std::size_t row) {
    const glm::dvec3 p = (point_at_3d(points, row) * (0.25 * before) - low) * scale;
    std::array<std::uint32_t, 3> cell;
    for (int k = 0; k < 3; ++k) {
      cell[static_cast<std::size_t>(k)] = static_cast<std::uint32_t>(std::min(p[k], cells - 1));
    }
    // Growing rounds: the last one with probability 1 - 1 / kGrowth, and so on.
    std::uint64_t random = scramble(row + scramble(seed));
    int round = rounds - 1;
    while (round > 0 && random % kGrowth == 0) {
      --round;
      random /= kGrowth;
    }
    const std::uint64_t place = geometry::place_on_curve(cell, bits);
    keys[row] = (static_cast<std::uint64_t>(round) << (3 * bits) | place) << row_bits | row;
  };
  blocks.for_each([&](std::size_t, std::size_t first, std::size_t last) {
    for (std::size_t row = first; row < last; ++row) make_key(row);
  });
  const int place_end = row_bits + 3 * bits;
  radix_sort(keys, row_bits, place_end + std::bit_width(static_cast<unsigned>(rounds - 1)), blocks);

  CurveOrder3d result;
  result.vertices = Array<SpaceVertex>(n + 1);
  result.vertices[0] = {glm::dvec3(0), 0, 0};
  blocks.for_each([&](std::size_t, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const auto row = static_cast<std::uint32_t>(keys[i] & ((std::uint64_t{1} << row_bits) - 1));
      result.vertices[i + 1] = {point_at_3d(points, row), row, 0};
    }
  });
  for (int round = 0; round < rounds; ++round) {
    const std::uint64_t* const begin = std::lower_bound(
        keys.data(), keys.data() + n, static_cast<std::uint64_t>(round) << place_end);
    result.rounds.push_back(static_cast<std::uint32_t>(begin - keys.data()));
  }
  result.rounds.push_back(static_cast<std::uint32_t>(n));
  return result;
}

}  // namespace delray::delaunay::internal
