// Sorts triangles into the squares of the picture that they may be seen in, by counting (Cormen et
// al., 8.2). Each thread counts and places those of some parts of the scene.
#include <algorithm>
#include <limits>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "parallel/arena.h"
#include "parallel/parallel_for.h"
#include "raytrace/first_hits/triangle_bins.h"

namespace delray::raytrace {
namespace {

static_assert(kBinBlocks == 4);

// Blocks [x0, x1) x [y0, y1) of a square.
BlocksOfSquare blocks_of(int x0, int y0, int x1, int y1) {
  const auto between = [](int first, int last) { return (1U << last) - (1U << first); };
  // A bit for the first block of each row, times the bits of a row.
  return (0x1111U & between(kBinBlocks * y0, kBinBlocks * y1)) * between(x0, x1) |
         static_cast<std::uint32_t>((x1 - x0) * (y1 - y0)) << kSquareBlocks;
}

// Calls f(square, its blocks) for all squares with any.
template <class F>
void for_each_square(const WideTriangle& triangle, int columns, F&& f) {
  for (int y = triangle.y0 / kBinBlocks; y <= (triangle.y1 - 1) / kBinBlocks; ++y) {
    for (int x = triangle.x0 / kBinBlocks; x <= (triangle.x1 - 1) / kBinBlocks; ++x) {
      const int left = x * kBinBlocks, top = y * kBinBlocks;
      f(static_cast<std::uint32_t>(y * columns + x),
        blocks_of(std::max(triangle.x0 - left, 0), std::max(triangle.y0 - top, 0),
                  std::min(triangle.x1 - left, kBinBlocks),
                  std::min(triangle.y1 - top, kBinBlocks)));
    }
  }
}

// Some parts of the scene, of one thread.
struct Share {
  std::span<const SeenTriangles* const> parts;
  std::vector<std::uint32_t> triangles, blocks;  // by square; triangles: then where the next one is
};

// Shares of about as many triangles each.
std::vector<Share> shares_of(std::span<const SeenTriangles* const> parts, std::size_t shares) {
  const auto size = [](const SeenTriangles* part) {
    return part->in_squares.size() + part->wide.size();
  };
  std::size_t all = 0, sum = 0, begin = 0;
  for (const SeenTriangles* part : parts) all += size(part);
  std::vector<Share> result;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    sum += size(parts[i]);
    if (sum * shares < all * (result.size() + 1)) continue;
    result.push_back({parts.subspan(begin, i + 1 - begin), {}, {}});
    begin = i + 1;
  }
  return result;
}

// Calls f(part, triangle, its nearest, square, its blocks) for all of a share.
template <class F>
void for_each_triangle(const Share& share, int columns, F&& f) {
  for (const SeenTriangles* part : share.parts) {
    for (const TriangleInSquare& t : part->in_squares)
      f(*part, t.triangle, t.nearest, t.square, t.blocks);
    for (const WideTriangle& t : part->wide) {
      for_each_square(t, columns, [&](std::uint32_t square, BlocksOfSquare blocks) {
        f(*part, t.triangle, t.nearest, square, blocks);
      });
    }
  }
}

}  // namespace

TriangleBins bin_triangles(std::span<const SeenTriangles> seen, const geometry::Rect& window) {
  std::vector<const SeenTriangles*> parts;
  for (const SeenTriangles& part : seen) {
    if (!part.in_squares.empty() || !part.wide.empty()) parts.push_back(&part);
  }
  std::ranges::stable_sort(parts, {}, [](const SeenTriangles* part) { return part->nearest; });
  TriangleBins bins;
  bins.columns = squares_along(window.width());
  bins.rows = squares_along(window.height());
  const auto squares = static_cast<std::size_t>(bins.columns) * static_cast<std::size_t>(bins.rows);
  std::vector<Share> shares = shares_of(parts, static_cast<std::size_t>(parallel::arena_threads()));
  parallel::parallel_for(0, shares.size(), 1, [&](std::size_t s) {
    Share& share = shares[s];
    share.triangles.resize(squares);
    share.blocks.resize(squares);
    for_each_triangle(share, bins.columns,
                      [&](const SeenTriangles&, std::uint32_t, float, std::uint32_t square,
                          BlocksOfSquare blocks) {
                        ++share.triangles[square];
                        share.blocks[square] += static_cast<std::uint32_t>(count(blocks));
                      });
  });
  // Where each square begins, and in it each share.
  constexpr std::size_t kGrain = 512;
  bins.first.resize(squares + 1);
  bins.blocks.resize(squares);
  std::vector<std::uint64_t> of_square(squares);
  parallel::parallel_for(0, squares, kGrain, [&](std::size_t square) {
    for (const Share& share : shares) {
      bins.blocks[square] += share.blocks[square];
      of_square[square] += share.triangles[square];
    }
  });
  std::uint64_t sum = 0;
  for (std::size_t square = 0; square < squares; ++square) {
    bins.first[square] = static_cast<std::uint32_t>(sum);
    sum += of_square[square];
  }
  if (sum > std::numeric_limits<std::uint32_t>::max())
    throw std::length_error("--primary raster: triangles are seen in too many squares");
  bins.first[squares] = static_cast<std::uint32_t>(sum);
  parallel::parallel_for(0, squares, kGrain, [&](std::size_t square) {
    std::uint32_t next = bins.first[square];
    for (Share& share : shares) {
      const std::uint32_t its = std::exchange(share.triangles[square], next);
      next += its;
    }
  });
  bins.triangles = std::make_unique_for_overwrite<BinnedTriangle[]>(sum);
  parallel::parallel_for(0, shares.size(), 1, [&](std::size_t s) {
    Share& share = shares[s];
    for_each_triangle(
        share, bins.columns,
        [&](const SeenTriangles& part, std::uint32_t triangle, float nearest, std::uint32_t square,
            BlocksOfSquare blocks) {
          bins.triangles[share.triangles[square]++] = {part.instance, triangle, nearest, blocks};
        });
  });
  return bins;
}

}  // namespace delray::raytrace
