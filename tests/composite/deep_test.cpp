#include "composite/deep.h"

#include <gtest/gtest.h>

#include <mutex>
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
DeepImage partial_image(int width, int height, int rank, int ranks, unsigned seed) {
  DeepImage image(width, height);
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
  DeepImage image(2, 1);
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
  DeepImage deep(3, 1);
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

TEST(DeepLayer, ReplaceTakesWhateverWasCut) {
  DeepLayer layer(partial_image(9, 7, 0, 2, 1)), other(partial_image(9, 7, 1, 2, 1));
  layer.replace({5, 60}, other.cut({5, 60}));
  for (std::size_t i = 0; i < 63; ++i) {
    const DeepImage expected = partial_image(9, 7, i >= 5 && i < 60 ? 1 : 0, 2, 1);
    ASSERT_EQ(layer.image().at(i).size(), expected.at(i).size()) << i;
    for (std::size_t k = 0; k < expected.at(i).size(); ++k) {
      EXPECT_EQ(layer.image().at(i)[k].primitive(), expected.at(i)[k].primitive());
      EXPECT_EQ(layer.image().at(i)[k].colour, expected.at(i)[k].colour);
    }
  }
}

TEST(DeepLayer, IsEmptyWithoutFragments) {
  EXPECT_TRUE(DeepLayer(DeepImage(3, 4)).empty());
  EXPECT_TRUE(DeepLayer(DeepImage(0, 4)).empty());
  EXPECT_FALSE(DeepLayer(partial_image(3, 4, 0, 1, 1)).empty());
  DeepLayer nothing(DeepImage(3, 4));
  EXPECT_EQ(nothing.merge({0, 12}, DeepLayer(DeepImage(3, 4)).cut({0, 12}), Side::lower), 0U);
  EXPECT_TRUE(nothing.empty());
}

// Every scheme and number of ranks gives the bytes that one list per pixel gives.
TEST(DeepLayer, EverySchemeBlendsTheSamePicture) {
  for (const Scheme& scheme : schemes()) {
    for (int ranks = 1; ranks <= 9; ++ranks) {
      const int width = 13, height = 5;
      const auto seed = static_cast<unsigned>(ranks);
      DeepImage all(width, height);
      for (std::size_t i = 0; i < all.lists.size(); ++i) {
        std::vector<Fragment> list;
        for (int rank = 0; rank < ranks; ++rank) {
          const DeepImage part = partial_image(width, height, rank, ranks, seed);
          list.insert(list.end(), part.at(i).begin(), part.at(i).end());
        }
        all.set(i, list);
      }
      const auto expected = flatten<RgbaF>(all);
      comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
        auto layer = make_deep(partial_image(width, height, communicator.rank(), ranks, seed));
        Part part =
            gather(communicator, scheme.compose(communicator, std::move(layer), {}), /*root=*/0);
        if (communicator.rank() != 0) return;
        const auto image = flatten<RgbaF>(dynamic_cast<DeepLayer&>(*part.layer).image());
        for (std::size_t i = 0; i < image.pixels(); ++i) {
          ASSERT_EQ(image.colour[i], expected.colour[i]) << scheme.name << ranks << " pixel " << i;
          ASSERT_EQ(image.depth[i], expected.depth[i]) << scheme.name << ranks << " pixel " << i;
        }
      });
    }
  }
}

}  // namespace
}  // namespace delray::composite
