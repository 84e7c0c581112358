#include "raytrace/film.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace delray::raytrace {
namespace {

// Every pixel of the film gets so many samples more: noise around `light`.
void expose(Film& film, int count, float light, float deviation, std::mt19937& random) {
  std::normal_distribution<float> normal(0.0F, deviation);
  const std::vector<std::uint8_t> all(film.samples().size(), 1);
  for (int done = 0; done < count;) {
    const int samples = chunk_size(static_cast<int>(film.samples()[0]));
    image::ImageF means(film.window().width(), film.window().height());
    for (std::size_t i = 0; i < means.pixels(); ++i) {
      float sum = 0.0F;
      for (int s = 0; s < samples; ++s) sum += light + normal(random);
      const float v = sum / static_cast<float>(samples);
      means.colour[i] = {v, v, v, 1.0F};
      means.depth[i] = 2.0F + static_cast<float>(done);
    }
    film.add(means, samples, all);
    done += samples;
  }
}

TEST(Film, ChunksAreAlignedPowersOfTwo) {
  int first = 0;
  for (int n = 1; n < 100; ++n) {
    const int size = chunk_size(first);
    EXPECT_EQ(size & (size - 1), 0);
    EXPECT_EQ(first % size, 0);
    EXPECT_EQ(chunks(first), n - 1);
    EXPECT_EQ(chunks(first + 1), n);
    first += size;
    EXPECT_EQ(chunks(first), n);
  }
  EXPECT_EQ(chunks(0), 0);
}

TEST(Film, CellsCoverTheWindowOnce) {
  const Film film({16, 32, 75, 65});
  EXPECT_EQ(film.columns(), 4);
  EXPECT_EQ(film.rows(), 3);
  std::vector<int> seen(film.pixels().size(), 0);
  for (int c = 0; c < film.columns() * film.rows(); ++c) {
    const geometry::Rect cell = film.cell(static_cast<std::size_t>(c));
    for (int y = cell.y0; y < cell.y1; ++y) {
      for (int x = cell.x0; x < cell.x1; ++x) {
        ++seen[film.pixel(x, y)];
        ASSERT_EQ(film.cell_of(x, y), static_cast<std::size_t>(c));
      }
    }
  }
  for (const int count : seen) ASSERT_EQ(count, 1);
  EXPECT_EQ(Film({0, 0, 0, 0}).pixels().size(), 0U);
}

TEST(Film, MeanAndVarianceAreThoseOfTheSamples) {
  std::mt19937 random(2);
  Film film({0, 0, 40, 30});
  expose(film, 128, 0.5F, 0.2F, random);
  EXPECT_EQ(film.total_samples(), 40U * 30U * 128U);
  const image::ImageF picture = mean(film);
  const std::vector<float> spread = variance(film);
  double error = 0, told = 0;
  for (std::size_t i = 0; i < picture.pixels(); ++i) {
    error += std::pow(picture.colour[i].g - 0.5, 2) / 1200;
    told += spread[i] / 1200.0;
    ASSERT_EQ(picture.depth[i], 2.0F);
    ASSERT_EQ(picture.colour[i].a, 1.0F);
  }
  const double expected = 0.2 * 0.2 / 128;
  EXPECT_NEAR(error / expected, 1.0, 0.2) << "seed 2";
  EXPECT_NEAR(told / expected, 1.0, 0.05) << "seed 2";
}

TEST(Film, NoiseIsTheDeviationOnTheScreen) {
  std::mt19937 random(3);
  Film film({0, 0, 128, 128});
  expose(film, 12, 0.25F, 0.1F, random);
  for (const float n : noise(film)) EXPECT_TRUE(std::isinf(n));  // too few to tell
  expose(film, 52, 0.25F, 0.1F, random);
  // 64 samples: 0.1 / 8 of 0.25, halved by the root.
  double sum = 0;
  for (const float n : noise(film)) sum += n / 64.0;
  EXPECT_NEAR(sum, 0.0125 / (2 * 0.5), 0.003) << "seed 3";
}

TEST(Film, OnlyNoisyCellsAndThoseBesideThemGoOn) {
  std::mt19937 random(4);
  Film film({0, 0, 160, 16});
  expose(film, 64, 0.25F, 0.0F, random);
  for (int x = 80; x < 84; ++x) film.pixels()[film.pixel(x, 3)].squares += 64.0F;
  const std::vector<std::uint8_t> open = unfinished(film, 1000, 0.01F);
  EXPECT_EQ(open, (std::vector<std::uint8_t>{0, 0, 0, 0, 1, 1, 1, 0, 0, 0}));
  EXPECT_EQ(unfinished(film, 64, 0.01F), std::vector<std::uint8_t>(10, 0));
  EXPECT_EQ(unfinished(film, 1000, 0.0F), std::vector<std::uint8_t>(10, 1));
}

TEST(Film, SamplesLeftGoByTheSquareOfTheNoise) {
  std::mt19937 random(5);
  Film film({0, 0, 128, 128});
  const std::vector<std::uint8_t> all(film.samples().size(), 1);
  const std::uint64_t pixels = film.pixels().size();
  EXPECT_EQ(samples_left(film, all, 256, 0.01F), 256 * pixels);  // nothing is known
  expose(film, 64, 0.25F, 0.1F, random);
  EXPECT_EQ(samples_left(film, all, 256, 0.0F), 192 * pixels);
  EXPECT_EQ(samples_left(film, std::vector<std::uint8_t>(all.size(), 0), 256, 0.0F), 0U);
  double needed = 0.0;
  for (const float n : noise(film)) needed += 64.0 * (n / 0.005) * (n / 0.005) - 64.0;
  const double told = static_cast<double>(samples_left(film, all, 100000, 0.005F));
  EXPECT_NEAR(told / static_cast<double>(pixels), needed / static_cast<double>(all.size()), 0.01);
  EXPECT_EQ(samples_left(film, all, 65, 0.005F), pixels);  // no more than there may be
}

TEST(Film, OnlyTheCellsInAMaskGetSamples) {
  Film film({0, 0, 40, 16});
  image::ImageF means(40, 16);
  image::clear(means, {0.5F, 0.5F, 0.5F, 1.0F});
  film.add(means, 4, std::vector<std::uint8_t>{0, 1, 0});
  EXPECT_EQ(film.samples()[0], 0U);
  EXPECT_EQ(film.samples()[1], 4U);
  const image::ImageF picture = mean(film);
  EXPECT_EQ(picture.colour[15], image::RgbaF{});
  EXPECT_EQ(picture.colour[16], (image::RgbaF{0.5F, 0.5F, 0.5F, 1.0F}));
  EXPECT_EQ(picture.colour[32], image::RgbaF{});
}

}  // namespace
}  // namespace delray::raytrace
