#include "composite/deep.h"
#include "composite/flatten.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <random>

#include "comm/threads.h"
#include "composite/scheme.h"

namespace delray::composite {
namespace {

using image::Rgba8;
using image::RgbaF;

Fragment fragment(float depth, std::uint64_t primitive, RgbaF colour) {
  return {colour, depth, static_cast<std::uint32_t>(primitive),
          static_cast<std::uint32_t>(primitive >> 32)};
}

// Fragments of few depths, so that many tie, some opaque; primitives are the rank's own.
DeepImage<RgbaF> partial_image(int width, int height, int rank, int ranks, unsigned seed) {
  DeepImage<RgbaF> image(width, height);
  std::mt19937 random(seed * 100 + static_cast<unsigned>(rank));
  std::vector<Fragment> list;
  for (std::size_t i = 0; i < image.lists.size(); ++i) {
    list.clear();
    for (unsigned k = random() % 4; k > 0; --k) {
      const auto primitive = (std::uint64_t{random() % 50} * 4 + k) * static_cast<unsigned>(ranks) +
                             static_cast<unsigned>(rank);
      const float alpha = random() % 3 == 0 ? 1.0F : static_cast<float>(random() % 64) / 64;
      const float value = static_cast<float>(random() % 256) / 256 * alpha;
      list.push_back(fragment(static_cast<float>(random() % 3), primitive << 30,
                              {value, value / 2, alpha - value, alpha}));
    }
    image.set(i, list);
  }
  return image;
}

TEST(DeepImage, KeepsFragmentsInOrderAndNoneBehindAnOpaqueOne) {
  DeepImage<RgbaF> image(2, 1);
  std::vector<Fragment> list = {fragment(3, 1, {0, 0, 0, 1}), fragment(1, 9, {1, 0, 0, 0.5F}),
                                fragment(2, 7, {0, 1, 0, 1}), fragment(1, 4ULL << 32, {0, 0, 1, 0}),
                                fragment(2, 6, {0, 0, 0, 0.25F})};
  image.set(1, list);
  EXPECT_TRUE(image.at(0).empty());
  ASSERT_EQ(image.at(1).size(), 4U);
  EXPECT_EQ(image.at(1)[0].primitive(), 9U);
  EXPECT_EQ(image.at(1)[1].primitive(), 4ULL << 32);
  EXPECT_EQ(image.at(1)[2].primitive(), 6U);
  EXPECT_EQ(image.at(1)[3].primitive(), 7U);
}

TEST(DeepImage, FlattensFrontToBack) {
  DeepImage<RgbaF> deep(3, 1);
  std::vector<Fragment> glass = {fragment(2, 0, {0, 0.5F, 0, 1}),
                                 fragment(1, 0, {0.25F, 0, 0, 0.5F})};
  std::vector<Fragment> opaque = {fragment(5, 0, {0.1F, 0.2F, 0.3F, 1})};
  deep.set(0, glass);
  deep.set(2, opaque);
  const auto image = flatten<RgbaF>(deep);
  EXPECT_EQ(image.colour[0], (RgbaF{0.25F, 0.25F, 0, 1}));
  EXPECT_EQ(image.depth[0], 1);
  EXPECT_EQ(image.colour[1], RgbaF());
  EXPECT_EQ(image.depth[1], image::kEmptyDepth);
  EXPECT_EQ(image.colour[2], (RgbaF{0.1F, 0.2F, 0.3F, 1}));
  EXPECT_EQ(flatten<Rgba8>(deep).colour[2].a, 255);
}

TEST(DeepImage, TakesTheListsOfTiles) {
  std::vector<DeepTile<RgbaF>> tiles(3);
  tiles[0].pixels = {{5, 2}, {1, 1}};
  for (std::uint64_t k = 0; k < 3; ++k) tiles[0].fragments.push_back(fragment(1, k, {}));
  tiles[2].pixels = {{0, 0}, {3, 1}};
  tiles[2].fragments = {fragment(7, 9, {})};
  const DeepImage<RgbaF> image(3, 2, std::move(tiles));
  ASSERT_EQ(image.at(5).size(), 2U);
  EXPECT_EQ(image.at(5)[0].primitive(), 0U);
  EXPECT_EQ(image.at(5)[1].primitive(), 1U);
  ASSERT_EQ(image.at(1).size(), 1U);
  EXPECT_EQ(image.at(1)[0].primitive(), 2U);
  ASSERT_EQ(image.at(3).size(), 1U);
  EXPECT_EQ(image.at(3)[0].primitive(), 9U);
  for (const std::size_t pixel : {0U, 2U, 4U}) EXPECT_TRUE(image.at(pixel).empty());
}

TEST(DeepLayer, ReplaceTakesWhateverWasCut) {
  DeepLayer<RgbaF> layer(partial_image(9, 7, 0, 2, 1)), other(partial_image(9, 7, 1, 2, 1));
  layer.replace({5, 60}, other.encode({5, 60}));
  for (std::size_t i = 0; i < 63; ++i) {
    const DeepImage<RgbaF> expected = partial_image(9, 7, i >= 5 && i < 60 ? 1 : 0, 2, 1);
    ASSERT_EQ(layer.image().at(i).size(), expected.at(i).size()) << i;
    for (std::size_t k = 0; k < expected.at(i).size(); ++k) {
      EXPECT_EQ(layer.image().at(i)[k].primitive(), expected.at(i)[k].primitive());
      EXPECT_EQ(layer.image().at(i)[k].payload, expected.at(i)[k].payload);
    }
  }
}

TEST(DeepLayer, IsEmptyWithoutFragments) {
  EXPECT_TRUE(DeepLayer<RgbaF>(DeepImage<RgbaF>(3, 4)).empty());
  EXPECT_TRUE(DeepLayer<RgbaF>(DeepImage<RgbaF>(0, 4)).empty());
  EXPECT_FALSE(DeepLayer<RgbaF>(partial_image(3, 4, 0, 1, 1)).empty());
  DeepLayer<RgbaF> nothing(DeepImage<RgbaF>(3, 4));
  EXPECT_EQ(
      nothing.merge({0, 12}, DeepLayer<RgbaF>(DeepImage<RgbaF>(3, 4)).encode({0, 12}), Side::lower),
      0U);
  EXPECT_TRUE(nothing.empty());
}

// Every scheme and number of ranks gives the bytes that one list per pixel gives.
TEST(DeepLayer, EverySchemeBlendsTheSamePicture) {
  for (const Scheme& scheme : schemes()) {
    for (int ranks = 1; ranks <= 9; ++ranks) {
      const int width = 13, height = 5;
      const auto seed = static_cast<unsigned>(ranks);
      DeepImage<RgbaF> all(width, height);
      for (std::size_t i = 0; i < all.lists.size(); ++i) {
        std::vector<Fragment> list;
        for (int rank = 0; rank < ranks; ++rank) {
          const DeepImage<RgbaF> part = partial_image(width, height, rank, ranks, seed);
          list.insert(list.end(), part.at(i).begin(), part.at(i).end());
        }
        all.set(i, list);
      }
      const auto expected = flatten<RgbaF>(all);
      comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
        auto layer = make_deep(partial_image(width, height, communicator.rank(), ranks, seed));
        OwnedPixels part =
            gather(communicator, scheme.compose(communicator, std::move(layer), {}), /*root=*/0);
        if (communicator.rank() != 0) return;
        const auto image = flatten<RgbaF>(take_deep<RgbaF>(std::move(part)));
        for (std::size_t i = 0; i < image.pixels(); ++i) {
          ASSERT_EQ(image.colour[i], expected.colour[i]) << scheme.name << ranks << " pixel " << i;
          ASSERT_EQ(image.depth[i], expected.depth[i]) << scheme.name << ranks << " pixel " << i;
        }
      });
    }
  }
}

// A fragment that its pixel's owner colours after compositing.
struct Surface {
  std::array<float, 24> attributes{};
  std::uint32_t opaque = 0;
  bool operator==(const Surface&) const = default;
};
bool is_opaque(const Surface& surface) { return surface.opaque != 0; }

using Surfaces = std::vector<std::vector<DeepFragment<Surface>>>;

// By pixel, unsorted. Much is empty, full or covered by one opaque surface, as in pictures.
Surfaces surfaces(std::size_t pixels, unsigned rank) {
  Surfaces result(pixels);
  std::mt19937 random(rank);
  for (std::size_t i = 0; i < pixels; ++i) {
    const std::size_t shape = (i + rank * 999) / 2000 % 3;
    const unsigned size = shape == 0 ? 0 : shape == 1 ? 1 : random() % 3;
    for (unsigned k = 0; k < size; ++k) {
      DeepFragment<Surface> fragment{{}, static_cast<float>(random() % 4), 10 * rank + k, 0};
      fragment.payload.attributes.fill(static_cast<float>(random()));
      fragment.payload.opaque = shape == 1 || random() % 2 == 0 ? 1 : 0;
      result[i].push_back(fragment);
    }
  }
  return result;
}

DeepImage<Surface> deep_image(int width, int height, Surfaces lists) {
  DeepImage<Surface> image(width, height);
  for (std::size_t i = 0; i < lists.size(); ++i) image.set(i, lists[i]);
  return image;
}

TEST(DeepLayer, CarriesWhateverTheOwnerShades) {
  static_assert(sizeof(DeepFragment<Surface>) == sizeof(Surface) + 12);
  constexpr int kRanks = 5, kWidth = 97, kHeight = 131;
  constexpr std::size_t kPixels = std::size_t{kWidth} * kHeight;
  Surfaces all(kPixels);
  for (unsigned rank = 0; rank < kRanks; ++rank) {
    const Surfaces own = surfaces(kPixels, rank);
    for (std::size_t i = 0; i < kPixels; ++i)
      all[i].insert(all[i].end(), own[i].begin(), own[i].end());
  }
  const DeepImage<Surface> expected = deep_image(kWidth, kHeight, all);
  for (const Scheme& scheme : schemes()) {
    comm::run_threads(kRanks, 2, [&](comm::Communicator& communicator) {
      const auto rank = static_cast<unsigned>(communicator.rank());
      OwnedPixels part = scheme.compose(
          communicator, make_deep(deep_image(kWidth, kHeight, surfaces(kPixels, rank))), {});
      part = gather(communicator, std::move(part), 1);
      if (rank != 1) return;
      const auto image = take_deep<Surface>(std::move(part));
      for (std::size_t i = 0; i < kPixels; ++i) {
        ASSERT_TRUE(std::equal(
            image.at(i).begin(), image.at(i).end(), expected.at(i).begin(), expected.at(i).end(),
            [](const auto& a, const auto& b) {
              return a.payload == b.payload && a.depth == b.depth && a.primitive() == b.primitive();
            }))
            << scheme.name << " pixel " << i;
      }
    });
  }
}

TEST(DeepLayer, KeepsMemoryInProportionToItsFragments) {
  constexpr std::size_t kPixels = 5000;
  const auto size_of = [](const DeepLayer<RgbaF>& layer) {
    std::size_t size = 0;
    for (const auto& chunk : layer.image().chunks) size += chunk.size();
    return size;
  };
  const auto glass = [](std::uint64_t primitive) {
    DeepImage<RgbaF> image(kPixels, 1);
    for (std::size_t i = 0; i < kPixels; i += 2) {
      std::vector<Fragment> list = {fragment(1, primitive, {0, 0, 0, 0.5F})};
      image.set(i, list);
    }
    return image;
  };
  DeepLayer<RgbaF> layer(glass(0));
  for (std::uint64_t primitive = 1; primitive < 30; ++primitive) {
    DeepLayer<RgbaF> other(glass(primitive));
    layer.merge({0, kPixels}, other.encode({0, kPixels}), Side::higher);
    const std::size_t used = kPixels / 2 * (primitive + 1);
    EXPECT_GE(size_of(layer), used);
    EXPECT_LE(size_of(layer), 2 * used);
  }
  for (std::size_t i = 0; i < kPixels; ++i) {
    ASSERT_EQ(layer.image().at(i).size(), i % 2 == 0 ? 30U : 0U);
    for (std::size_t k = 0; k < layer.image().at(i).size(); ++k) {
      EXPECT_EQ(layer.image().at(i)[k].primitive(), k);
    }
  }
  DeepLayer<RgbaF> nothing(DeepImage<RgbaF>(kPixels, 1));
  layer.replace({0, kPixels}, nothing.encode({0, kPixels}));
  EXPECT_EQ(size_of(layer), 0U);
}

TEST(DeepLayer, SendsFourBytesPerPixelAndItsFragments) {
  const Surfaces lists = surfaces(9000, 1);
  std::size_t covered = 0, fragments = 0;
  DeepLayer<Surface> layer(deep_image(9000, 1, lists));
  for (std::size_t i = 10; i < 8990; ++i) {
    covered += layer.image().at(i).empty() ? 0 : 1;
    fragments += layer.image().at(i).size();
  }
  const comm::Buffer message = layer.encode({10, 8990});
  const std::size_t bytes = 4 * covered + (sizeof(Surface) + 12) * fragments;
  EXPECT_GE(message.size(), bytes + 8);
  EXPECT_LE(message.size(), bytes + 8 + 8980 * 13 / 100);
  EXPECT_EQ(layer.encode({8990, 8990}).size(), 8U);
  EXPECT_EQ(
      layer.merge({10, 8990}, DeepLayer<Surface>(DeepImage<Surface>(9000, 1)).encode({10, 8990}),
                  Side::lower),
      0U);
  const comm::Buffer all = layer.encode({0, 9000});
  EXPECT_EQ(layer.encode({10, 8990}).size(), message.size());
  DeepLayer<Surface> copy(DeepImage<Surface>(9000, 1));
  copy.merge({0, 9000}, all, Side::lower);
  const comm::Buffer again = copy.encode({0, 9000});
  ASSERT_EQ(again.size(), all.size());
  EXPECT_EQ(std::memcmp(again.data(), all.data(), all.size()), 0);
}

}  // namespace
}  // namespace delray::composite
