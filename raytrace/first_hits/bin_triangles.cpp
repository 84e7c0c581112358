// Sorts triangles into the squares of the picture that they may be seen in, by counting. Threads
// share out rows of squares, so that nobody waits for anybody.
#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

#include "parallel/arena.h"
#include "parallel/parallel_for.h"
#include "raytrace/first_hits/triangle_bins.h"

namespace delray::raytrace {
namespace {

static_assert(kBinBlocks == 4);

// Blocks [x0, x1) x [y0, y1) of a square.
struct BlockBox {
  int x0, y0, x1, y1;

  std::uint32_t count() const { return static_cast<std::uint32_t>((x1 - x0) * (y1 - y0)); }
  // As bits; a bit for the first block of each row, times the bits of a row.
  std::uint32_t bits() const {
    const auto between = [](int first, int last) { return (1U << last) - (1U << first); };
    return (0x1111U & between(kBinBlocks * y0, kBinBlocks * y1)) * between(x0, x1);
  }
};

// Calls f(square, blocks of it that the triangle may be seen in) for all squares with any in rows
// [first, last).
template <class F>
void for_each_square(const SeenTriangle& seen, int columns, int first, int last, F&& f) {
  const int y0 = seen.y0 / kBinBlocks, y1 = (seen.y1 - 1) / kBinBlocks;
  const int x0 = seen.x0 / kBinBlocks, x1 = (seen.x1 - 1) / kBinBlocks;
  if (x0 == x1 && y0 == y1) {  // most
    if (y0 < first || y0 >= last) return;
    const int left = x0 * kBinBlocks, top = y0 * kBinBlocks;
    f(static_cast<std::size_t>(y0) * static_cast<std::size_t>(columns) +
          static_cast<std::size_t>(x0),
      BlockBox{seen.x0 - left, seen.y0 - top, seen.x1 - left, seen.y1 - top});
    return;
  }
  for (int y = std::max(first, y0); y <= std::min(last - 1, y1); ++y) {
    for (int x = x0; x <= x1; ++x) {
      const int left = x * kBinBlocks, top = y * kBinBlocks;
      f(static_cast<std::size_t>(y * columns + x),
        BlockBox{std::max(seen.x0 - left, 0), std::max(seen.y0 - top, 0),
                 std::min(seen.x1 - left, kBinBlocks), std::min(seen.y1 - top, kBinBlocks)});
    }
  }
}

float nearest_of(std::span<const SeenTriangle> seen) {
  float nearest = std::numeric_limits<float>::infinity();
  for (const SeenTriangle& t : seen) nearest = std::min(nearest, t.nearest);
  return nearest;
}

}  // namespace

TriangleBins bin_triangles(std::vector<std::vector<SeenTriangle>>&& seen,
                           const geometry::Rect& window) {
  std::vector<std::pair<float, std::span<const SeenTriangle>>> lists;
  for (const std::vector<SeenTriangle>& list : seen) {
    if (!list.empty()) lists.emplace_back(nearest_of(list), list);
  }
  std::ranges::stable_sort(lists, {}, [](const auto& list) { return list.first; });
  TriangleBins bins;
  bins.columns = (window.width() + kBinSide - 1) / kBinSide;
  bins.rows = (window.height() + kBinSide - 1) / kBinSide;
  const auto squares = static_cast<std::size_t>(bins.columns) * static_cast<std::size_t>(bins.rows);
  bins.first.assign(squares + 1, 0);
  bins.blocks.assign(squares, 0);
  const auto stripes = static_cast<std::size_t>(std::min(bins.rows, parallel::arena_threads()));
  const auto walk = [&](auto&& f) {
    parallel::parallel_for(0, stripes, 1, [&](std::size_t s) {
      const auto row = [&](std::size_t stripe) {
        return static_cast<int>(stripe * static_cast<std::size_t>(bins.rows) / stripes);
      };
      const int first = row(s), last = row(s + 1);
      for (const auto& [nearest, list] : lists) {
        for (const SeenTriangle& triangle : list) {
          for_each_square(
              triangle, bins.columns, first, last,
              [&](std::size_t square, const BlockBox& blocks) { f(triangle, square, blocks); });
        }
      }
    });
  };
  walk([&](const SeenTriangle&, std::size_t square, const BlockBox& blocks) {
    ++bins.first[square];
    bins.blocks[square] += blocks.count();
  });
  std::uint64_t sum = 0;
  for (std::uint32_t& first : bins.first)
    sum += std::exchange(first, static_cast<std::uint32_t>(sum));
  if (sum > std::numeric_limits<std::uint32_t>::max())
    throw std::length_error("--primary raster: triangles are seen in too many squares");
  bins.triangles = std::make_unique_for_overwrite<BinnedTriangle[]>(sum);
  std::vector<std::uint32_t> next = bins.first;
  walk([&](const SeenTriangle& t, std::size_t square, const BlockBox& blocks) {
    bins.triangles[next[square]++] = {t.instance, t.triangle, t.nearest, blocks.bits()};
  });
  return bins;
}

}  // namespace delray::raytrace
