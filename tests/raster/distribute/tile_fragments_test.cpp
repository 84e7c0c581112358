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

// One rank's own samples are in the image; ties go to the lowest primitive whoever has it.
TEST(TileFragments, MergeWithAnImageAsTheyDoWithEachOther) {
  const geometry::Rect rect{70, 3, 97, 21};
  scenes::Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles.assign(kClusterTriangles, {0, 1, 2});
  const glm::mat4x3 identity(1.0F);
  for (unsigned seed = 0; seed < 40; ++seed) {
    std::mt19937 random(seed);
    const std::uint64_t first = random() % 100 * 2;  // primitive of the list
    const DrawList list = make_draw_list({{&mesh, &identity, 0, kClusterTriangles, first}});
    std::vector<Surfaces> ranks = random_surfaces(random, rect, true);
    for (Surfaces& seen : ranks) {
      for (auto& fragment : seen.fragments) {
        fragment.depth = -0.25F * static_cast<float>(1 + random() % 3);
        fragment.primitive_low = random() % 200 * 2 + 1;
        fragment.primitive_high = 0;
      }
    }
    Surfaces& own = ranks[random() % ranks.size()];
    std::vector<std::uint32_t> numbers(kTilePixels, kNothing);
    image::ImageF merged(128, 64), nearest(128, 64);
    std::fill_n(merged.depth.data(), merged.pixels(), image::kEmptyDepth);
    for (std::size_t i = 0; i < own.fragments.size(); ++i) {
      const std::uint32_t number = random() % kClusterTriangles / 2 * 2;
      auto& fragment = own.fragments[i];
      fragment.primitive_low = static_cast<std::uint32_t>(list.primitive_of(number));
      numbers[own.positions[i]] = number;
      const int x = 64 + own.positions[i] % kTileSize, y = own.positions[i] / kTileSize;
      const auto at = static_cast<std::size_t>(y) * 128 + static_cast<std::size_t>(x);
      merged.colour[at] = fragment.payload;
      merged.depth[at] = fragment.depth;
    }
    keep_nearest<image::RgbaF>(spans_of(ranks), rect, window_of(nearest));
    std::vector<Surfaces> others;
    for (const Surfaces& seen : ranks)
      if (&seen != &own) others.push_back(seen);
    merge_nearest<image::RgbaF>(spans_of(others), rect, list, numbers, window_of(merged));
    for (int y = rect.y0; y < rect.y1; ++y) {
      for (int x = rect.x0; x < rect.x1; ++x) {
        const std::size_t i = static_cast<std::size_t>(y) * 128 + static_cast<std::size_t>(x);
        if (nearest.depth[i] == image::kEmptyDepth) continue;
        EXPECT_EQ(merged.colour[i], nearest.colour[i]) << "seed " << seed;
        EXPECT_EQ(merged.depth[i], nearest.depth[i]);
      }
    }
  }
}

}  // namespace
}  // namespace delray::raster
