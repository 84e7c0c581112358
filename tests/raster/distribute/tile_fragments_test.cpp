#include "raster/distribute/tile_fragments.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

#include "composite/deep.h"

namespace delray::raster {
namespace {

using Surfaces = TileFragments<image::RgbaF>;

// What several ranks saw at some samples of `rect`, with ties of depth; a sample's fragments in
// order, an opaque one last if any.
std::vector<Surfaces> random_surfaces(std::mt19937& random, const geometry::Rect& rect,
                                      bool opaque) {
  std::uniform_real_distribution<float> unit(0, 1);
  std::vector<Surfaces> ranks(1 + random() % 4);
  std::uint64_t primitive = 1;
  for (Surfaces& seen : ranks) {
    primitive += std::uint64_t{random() % 3} << 32;
    for (int y = rect.y0; y < rect.y1; ++y) {
      for (int x = rect.x0; x < rect.x1; ++x) {
        const std::uint64_t depths = opaque ? random() % 2 : random() % 4;
        float depth = -1;
        for (std::uint64_t k = 0; k < depths; ++k) {
          depth += 0.125F * static_cast<float>(random() % 4 + 1) / 4;
          const bool last = opaque || (k + 1 == depths && random() % 2 == 0);
          seen.positions.push_back(
              static_cast<std::uint16_t>(y % kTileSize * kTileSize + x % kTileSize));
          ++primitive;
          seen.fragments.push_back({{unit(random), unit(random), unit(random), last ? 1.0F : 0.5F},
                                    depth,
                                    static_cast<std::uint32_t>(primitive),
                                    static_cast<std::uint32_t>(primitive >> 32)});
        }
      }
    }
  }
  return ranks;
}

std::vector<TileSpan<image::RgbaF>> spans_of(const std::vector<Surfaces>& ranks) {
  std::vector<TileSpan<image::RgbaF>> spans;
  for (std::size_t i = 0; i < ranks.size(); ++i)
    spans.push_back(span_of(static_cast<int>(7 * i), ranks[i]));
  return spans;
}

TEST(TileFragments, ArriveAsTheyWereSent) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    std::vector<Surfaces> sent = random_surfaces(random, {64, 128, 83, 137}, false);
    sent.emplace_back();
    const auto spans = spans_of(sent);
    const comm::Buffer message = pack_tiles(std::span(spans));
    const auto arrived = unpack_tiles<image::RgbaF>(message);
    ASSERT_EQ(arrived.size(), sent.size());
    for (std::size_t i = 0; i < sent.size(); ++i) {
      EXPECT_EQ(arrived[i].tile, static_cast<int>(7 * i));
      EXPECT_TRUE(std::equal(arrived[i].positions.begin(), arrived[i].positions.end(),
                             sent[i].positions.begin(), sent[i].positions.end()));
      ASSERT_EQ(arrived[i].fragments.size(), sent[i].fragments.size());
      for (std::size_t k = 0; k < sent[i].fragments.size(); ++k) {
        EXPECT_EQ(arrived[i].fragments[k].payload, sent[i].fragments[k].payload);
        EXPECT_EQ(arrived[i].fragments[k].depth, sent[i].fragments[k].depth);
        EXPECT_EQ(arrived[i].fragments[k].primitive(), sent[i].fragments[k].primitive());
      }
    }
  }
  const comm::Buffer nothing = pack_tiles(std::span<const TileSpan<image::Rgba8>>());
  EXPECT_TRUE(unpack_tiles<image::Rgba8>(nothing).empty());
}

TEST(TileFragments, AreBlendedByDepthAndPrimitiveWhoeverSawThem) {
  const geometry::Rect rect{70, 3, 97, 21};
  for (unsigned seed = 0; seed < 40; ++seed) {
    std::mt19937 random(seed);
    const bool opaque = seed % 2 == 0;
    const std::vector<Surfaces> ranks = random_surfaces(random, rect, opaque);
    std::map<int, std::vector<composite::Fragment>> at;
    for (const Surfaces& seen : ranks) {
      for (std::size_t i = 0; i < seen.positions.size(); ++i)
        at[seen.positions[i]].push_back(seen.fragments[i]);
    }
    auto spans = spans_of(ranks);
    std::shuffle(spans.begin(), spans.end(), random);
    image::ImageF blended(128, 64), nearest(128, 64);
    blend_surfaces<image::RgbaF>(spans, rect, window_of(blended));
    if (opaque) keep_nearest<image::RgbaF>(spans, rect, window_of(nearest));
    for (int y = rect.y0; y < rect.y1; ++y) {
      for (int x = rect.x0; x < rect.x1; ++x) {
        std::vector<composite::Fragment> fragments = at[y * kTileSize + x % kTileSize];
        std::sort(fragments.begin(), fragments.end(), composite::in_front<image::RgbaF>);
        const auto last = std::find_if(fragments.begin(), fragments.end(), [](const auto& f) {
          return composite::is_opaque(f.payload);
        });
        if (last != fragments.end()) fragments.erase(last + 1, fragments.end());
        const std::size_t i = static_cast<std::size_t>(y) * 128 + static_cast<std::size_t>(x);
        EXPECT_EQ(blended.colour[i], composite::blend(fragments)) << "seed " << seed;
        const float depth = fragments.empty() ? image::kEmptyDepth : fragments.front().depth;
        EXPECT_EQ(blended.depth[i], depth);
        if (!opaque) continue;
        EXPECT_EQ(nearest.colour[i], blended.colour[i]);
        EXPECT_EQ(nearest.depth[i], depth);
      }
    }
  }
}

}  // namespace
}  // namespace delray::raster
