#include "raster/pipeline/visibility.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <random>

#include "tests/raster/coverage.h"
#include "tests/support/targets.h"

namespace delray::raster {
namespace {

constexpr int kWidth = 101, kHeight = 75;  // two by two tiles, neither full

// A triangle with positive area whose corners are at most `reach` subpixels from the centre, on
// multiples of `step` moved by half a pixel: large steps give corners and edges on pixel centres.
ScreenTriangle random_triangle(std::mt19937& random, int reach, int step) {
  std::uniform_int_distribution<int> place(-reach / step, reach / step);
  std::uniform_real_distribution<float> depth(-1.0F, -0.001F);
  ScreenTriangle t;
  do {
    for (ScreenVertex& v : t.vertex) {
      v = {std::clamp(place(random) * step + kHalfPixel, -kGuardSubpixels, kGuardSubpixels),
           std::clamp(place(random) * step + kHalfPixel, -kGuardSubpixels, kGuardSubpixels),
           depth(random)};
    }
  } while (doubled_area(t.vertex[0], t.vertex[1], t.vertex[2]) == 0);
  if (doubled_area(t.vertex[0], t.vertex[1], t.vertex[2]) < 0) std::swap(t.vertex[1], t.vertex[2]);
  return t;
}

void expect_exact_coverage(int reach, int step, int rounds, unsigned seed) {
  const Screen screen = make_screen(plain_view(kWidth, kHeight));
  std::mt19937 random(seed);
  int covered = 0;
  for (int round = 0; round < rounds; ++round) {
    const ScreenTriangle t = random_triangle(random, reach, step);
    std::vector<int> pixels(kWidth * kHeight);
    count(screen, t, pixels);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        ASSERT_EQ(pixels[y * kWidth + x], covered_by_definition(t, screen, x, y))
            << "seed " << seed << " round " << round << " pixel " << x << ", " << y;
        covered += pixels[y * kWidth + x];
      }
    }
  }
  EXPECT_GT(covered, 0);
}

TEST(Visibility, CoverageIsExactForRandomTriangles) {
  tests::for_each_target([] {
    expect_exact_coverage(30 * kSubpixels, 1, 60, 1);
    expect_exact_coverage(3 * kSubpixels, 1, 60, 2);
  });
}

TEST(Visibility, CoverageIsExactForCornersOnPixelCentres) {
  tests::for_each_target([] {
    expect_exact_coverage(20 * kSubpixels, kSubpixels, 60, 3);
    expect_exact_coverage(4 * kSubpixels, kHalfPixel, 60, 4);
  });
}

TEST(Visibility, CoverageIsExactAtTheEndsOfTheGuardBand) {
  tests::for_each_target([] {
    expect_exact_coverage(kGuardSubpixels, 1, 60, 5);
    expect_exact_coverage(kGuardSubpixels, kGuardSubpixels, 60, 6);
  });
}

struct Pixels {
  std::vector<float> depth;
  std::vector<std::uint32_t> number;
  bool operator==(const Pixels& other) const {
    return number == other.number &&
           std::memcmp(depth.data(), other.depth.data(), depth.size() * sizeof(float)) == 0;
  }
};

// What is seen of `triangles`, drawn in the order of `entries`.
Pixels drawn(const Screen& screen, std::span<const ScreenTriangle> triangles,
             std::span<const std::uint32_t> entries) {
  static VisibilityTile tile;
  Pixels pixels{std::vector<float>(screen.width * screen.height),
                std::vector<std::uint32_t>(screen.width * screen.height)};
  for (int k = 0; k < screen.tiles(); ++k) {
    const geometry::Rect rect = screen.tile(k);
    tile.clear(rect);
    rasterize(screen, rect, triangles, entries, tile);
    rasterize_masked(
        screen, rect, triangles, entries, [](std::uint32_t, int, int) { return true; }, tile);
    for (int y = rect.y0; y < rect.y1; ++y) {
      for (int x = rect.x0; x < rect.x1; ++x) {
        const int i = (y - rect.y0) * kTileSize + x - rect.x0;
        pixels.depth[y * screen.width + x] = depth_of(tile.key[i]);
        pixels.number[y * screen.width + x] = number_of(tile.key[i]);
      }
    }
  }
  return pixels;
}

// A few hundred triangles of all sizes, many of which share a plane so that depths tie.
std::vector<ScreenTriangle> random_heap(std::mt19937& random) {
  std::vector<ScreenTriangle> triangles;
  for (int i = 0; i < 400; ++i) {
    const int reach = i % 4 == 0 ? 200 * kSubpixels : i % 4 == 1 ? 40 * kSubpixels : 5 * kSubpixels;
    ScreenTriangle t = random_triangle(random, reach, i % 3 == 0 ? kSubpixels : 1);
    if (i % 4 >= 2) {
      std::uniform_int_distribution<int> shift(-40 * kSubpixels, 40 * kSubpixels);
      const int x = shift(random), y = shift(random);
      for (ScreenVertex& v : t.vertex) {
        v.x += x;
        v.y += y;
      }
    }
    if (i % 2 == 0)
      for (ScreenVertex& v : t.vertex) v.depth = -0.25F * static_cast<float>(1 + i % 3);
    t.number = static_cast<std::uint32_t>(i);
    triangles.push_back(t);
  }
  return triangles;
}

TEST(Visibility, LeavesTheLeastDepthAndNumberInAnyOrderOnEveryTarget) {
  const Screen screen = make_screen(plain_view(kWidth, kHeight));
  std::mt19937 random(7);
  const std::vector<ScreenTriangle> triangles = random_heap(random);
  std::vector<std::uint32_t> entries(triangles.size());
  for (std::size_t i = 0; i < entries.size(); ++i) entries[i] = static_cast<std::uint32_t>(i);

  Pixels expected{std::vector<float>(kWidth * kHeight, image::kEmptyDepth),
                  std::vector<std::uint32_t>(kWidth * kHeight, kNothing)};
  for (const ScreenTriangle& t : triangles) {
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        if (!covered_by_definition(t, screen, x, y)) continue;
        TileTriangle plane;
        const int tile_x = x / kTileSize * kTileSize, tile_y = y / kTileSize * kTileSize;
        ASSERT_TRUE(make_tile_triangle(t, screen, tile_x, tile_y, plane));
        const float depth = depth_at(plane, x - tile_x, y - tile_y);
        if (depth < expected.depth[y * kWidth + x]) {
          expected.depth[y * kWidth + x] = depth;
          expected.number[y * kWidth + x] = t.number;
        }
      }
    }
  }
  tests::for_each_target([&] {
    for (int round = 0; round < 4; ++round) {
      EXPECT_EQ(drawn(screen, triangles, entries), expected) << "round " << round;
      std::shuffle(entries.begin(), entries.end(), random);
    }
  });
  // Some masked, some not: the two ways of drawing agree.
  for (std::uint32_t& entry : entries)
    if (random() % 2 == 0) entry |= kMasked;
  EXPECT_EQ(drawn(screen, triangles, entries), expected);
}

TEST(Visibility, MaskedPixelsAreLeftOut) {
  const Screen screen = make_screen(plain_view(64, 64));
  ScreenTriangle t{{{-kGuardSubpixels, -kGuardSubpixels, -0.5F},
                    {kGuardSubpixels, -kGuardSubpixels, -0.5F},
                    {0, kGuardSubpixels, -0.5F}},
                   3};
  VisibilityTile tile;
  tile.clear(screen.frame());
  const std::uint32_t entry = kMasked;
  rasterize_masked(
      screen, screen.frame(), {&t, 1}, {&entry, 1},
      [](std::uint32_t number, int x, int y) { return number == 3 && x > y; }, tile);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x)
      ASSERT_EQ(number_of(tile.key[y * kTileSize + x]), x > y ? 3U : kNothing) << x << ", " << y;
  }
}

TEST(Visibility, DepthIsLinearOnTheScreenAndWithinTheTriangle) {
  const Screen screen = make_screen(plain_view(kWidth, kHeight));
  std::mt19937 random(8);
  int pixels = 0;
  for (int round = 0; round < 300; ++round) {
    const ScreenTriangle t = random_triangle(random, 60 * kSubpixels, 1);
    const ScreenVertex* v = t.vertex;
    const double area = static_cast<double>(doubled_area(v[0], v[1], v[2]));
    for (int k = 0; k < screen.tiles(); ++k) {
      const geometry::Rect rect = screen.tile(k);
      TileTriangle plane;
      if (!make_tile_triangle(t, screen, rect.x0, rect.y0, plane)) continue;
      for (int y = rect.y0; y < rect.y1; ++y) {
        for (int x = rect.x0; x < rect.x1; ++x) {
          if (!covers(plane, x - rect.x0, y - rect.y0)) continue;
          ++pixels;
          const ScreenVertex p{(x - screen.centre_x) * kSubpixels + kHalfPixel,
                               (y - screen.centre_y) * kSubpixels + kHalfPixel, 0};
          const double exact = (doubled_area(p, v[1], v[2]) * double{v[0].depth} +
                                doubled_area(v[0], p, v[2]) * double{v[1].depth} +
                                doubled_area(v[0], v[1], p) * double{v[2].depth}) /
                               area;
          const float depth = depth_at(plane, x - rect.x0, y - rect.y0);
          // Slivers have steep planes: the error is that of a few roundings of the largest term.
          const double term = std::abs(double{plane.slope_x}) * (std::abs(plane.x) + 64) +
                              std::abs(double{plane.slope_y}) * (std::abs(plane.y) + 64) + 1;
          EXPECT_NEAR(depth, exact, 4e-7 * term);
          EXPECT_GE(depth, plane.nearest);
          EXPECT_LE(depth, plane.farthest);
        }
      }
    }
  }
  EXPECT_GT(pixels, 10000);
}

}  // namespace
}  // namespace delray::raster
