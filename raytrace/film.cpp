// Sums samples chunk by chunk, and estimates the noise that is left from how much the means of
// chunks vary.
//
// Squares of a chunk's mean are weighted by its size, as a mean has the variance of a sample over
// that size. A cell's noise is that of its noisiest quarter, or of a neighbouring cell where that
// is larger, relative to the light there. O(pixels), parallel over rows of cells.
//
// Degenerate: fewer than two chunks have variance 0; fewer than kLeastChunks make noise infinite,
// so that sampling goes on.
#include "raytrace/film.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "parallel/parallel_for.h"

namespace delray::raytrace {
namespace {

using geometry::Rect;

constexpr std::size_t kGrain = 4;  // rows of cells: some ten microseconds

// Light that is hardly above black shows no noise, however large that is beside it.
constexpr float kDarkest = 1e-3F;

template <class F>
void for_each_pixel(const Film& film, F&& f) {
  parallel::parallel_for(0, static_cast<std::size_t>(film.rows()), kGrain, [&](std::size_t row) {
    const std::size_t first = row * static_cast<std::size_t>(film.columns());
    for (std::size_t c = first; c < first + static_cast<std::size_t>(film.columns()); ++c) {
      const Rect cell = film.cell(c);
      for (int y = cell.y0; y < cell.y1; ++y) {
        for (int x = cell.x0; x < cell.x1; ++x) f(c, film.pixel(x, y));
      }
    }
  });
}

int chunks_of(std::uint32_t samples) { return chunks(static_cast<int>(samples)); }

// A chunk's mean has the variance of a sample over its size: squares are weighted by sizes.
float pixel_variance(const PixelSum& sum, std::uint32_t samples) {
  const int n = chunks_of(samples);
  if (n < 2) return 0.0F;
  const float mean = luminance(sum.colour) / static_cast<float>(samples);
  const float spread = sum.squares / static_cast<float>(samples) - mean * mean;
  return std::max(0.0F, spread) / static_cast<float>(n - 1);
}

template <class F>
float mean_over(const Rect& pixels, F&& f) {
  float sum = 0.0F;
  for (int y = pixels.y0; y < pixels.y1; ++y) {
    for (int x = pixels.x0; x < pixels.x1; ++x) sum += f(x, y);
  }
  return sum / static_cast<float>(pixels.area());
}

float noise_in(const Film& film, const Rect& pixels, std::uint32_t samples) {
  const auto light_of = [&](int x, int y) {
    return luminance(film.pixels()[film.pixel(x, y)].colour) / static_cast<float>(samples);
  };
  const float light = mean_over(pixels, light_of) + kDarkest;
  return 0.5F * std::sqrt(mean_over(pixels, [&](int x, int y) {
           const PixelSum& sum = film.pixels()[film.pixel(x, y)];
           return pixel_variance(sum, samples) / std::max(light, light_of(x, y));
         }));
}

}  // namespace

int chunk_size(int first) { return first < 16 ? 4 : first < 64 ? 8 : 16; }

int chunks(int samples) {
  int count = 0;
  for (int first = 0; first < std::min(samples, 64); first += chunk_size(first)) ++count;
  return count + std::max(0, samples - 64 + 15) / 16;
}

void add_chunk(const image::RgbaF& mean, float depth, int samples, PixelSum& sum) {
  const auto weight = static_cast<float>(samples);
  sum.colour = {sum.colour.r + mean.r * weight, sum.colour.g + mean.g * weight,
                sum.colour.b + mean.b * weight, sum.colour.a + mean.a * weight};
  const float light = luminance(mean);
  sum.squares += light * light * weight;
  sum.depth = std::min(sum.depth, depth);
}

Film::Film(const Rect& window)
    : window_(window),
      columns_((window.width() + kCellSide - 1) / kCellSide),
      rows_((window.height() + kCellSide - 1) / kCellSide),
      pixels_(static_cast<std::size_t>(window.area())),
      costs_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)),
      samples_(costs_.size(), 0) {}

Rect Film::cell(std::size_t i) const {
  const auto number = static_cast<int>(i);
  const int x = window_.x0 + number % columns_ * kCellSide;
  const int y = window_.y0 + number / columns_ * kCellSide;
  return {x, y, std::min(x + kCellSide, window_.x1), std::min(y + kCellSide, window_.y1)};
}

void Film::add(const image::ImageF& means, int samples, std::span<const std::uint8_t> cells) {
  for_each_pixel(*this, [&](std::size_t cell, std::size_t pixel) {
    if (cells[cell] == 0) return;
    add_chunk(means.colour[pixel], means.depth[pixel], samples, pixels_[pixel]);
  });
  for (std::size_t c = 0; c < cells.size(); ++c) {
    if (cells[c] != 0) samples_[c] += static_cast<std::uint32_t>(samples);
  }
}

std::uint64_t Film::total_samples() const {
  std::uint64_t sum = 0;
  for (std::size_t c = 0; c < samples_.size(); ++c) {
    sum += samples_[c] * static_cast<std::uint64_t>(cell(static_cast<int>(c)).area());
  }
  return sum;
}

image::ImageF mean(const Film& film) {
  image::ImageF picture(film.window().width(), film.window().height());
  for_each_pixel(film, [&](std::size_t cell, std::size_t pixel) {
    const PixelSum& sum = film.pixels()[pixel];
    const std::uint32_t samples = film.samples()[cell];
    const float weight = samples > 0 ? 1.0F / static_cast<float>(samples) : 0.0F;
    picture.colour[pixel] = {sum.colour.r * weight, sum.colour.g * weight, sum.colour.b * weight,
                             sum.colour.a * weight};
    picture.depth[pixel] = sum.depth;
  });
  return picture;
}

std::vector<float> variance(const Film& film) {
  std::vector<float> result(film.pixels().size());
  for_each_pixel(film, [&](std::size_t cell, std::size_t pixel) {
    result[pixel] = pixel_variance(film.pixels()[pixel], film.samples()[cell]);
  });
  return result;
}

std::vector<float> noise(const Film& film) {
  const auto columns = static_cast<std::size_t>(film.columns());
  std::vector<float> own(columns * static_cast<std::size_t>(film.rows()));
  parallel::parallel_for(0, static_cast<std::size_t>(film.rows()), kGrain, [&](std::size_t row) {
    for (std::size_t c = row * columns; c < (row + 1) * columns; ++c) {
      const std::uint32_t samples = film.samples()[c];
      if (chunks_of(samples) < kLeastChunks) {
        own[c] = std::numeric_limits<float>::infinity();
        continue;
      }
      const Rect cell = film.cell(c);
      constexpr int kHalf = kCellSide / 2;
      for (int y = cell.y0; y < cell.y1; y += kHalf) {
        for (int x = cell.x0; x < cell.x1; x += kHalf) {
          const Rect quarter = geometry::intersection(cell, {x, y, x + kHalf, y + kHalf});
          own[c] = std::max(own[c], noise_in(film, quarter, samples));
        }
      }
    }
  });
  std::vector<float> result(own.size());
  for (int y = 0; y < film.rows(); ++y) {
    for (int x = 0; x < film.columns(); ++x) {
      float most = 0.0F;
      for (int j = std::max(0, y - 1); j <= std::min(film.rows() - 1, y + 1); ++j) {
        for (int i = std::max(0, x - 1); i <= std::min(film.columns() - 1, x + 1); ++i) {
          most = std::max(most,
                          own[static_cast<std::size_t>(j) * columns + static_cast<std::size_t>(i)]);
        }
      }
      result[static_cast<std::size_t>(y) * columns + static_cast<std::size_t>(x)] = most;
    }
  }
  return result;
}

std::vector<std::uint8_t> unfinished(const Film& film, int most, float threshold) {
  std::vector<std::uint8_t> result(film.samples().size());
  std::vector<float> left;
  if (threshold > 0.0F) left = noise(film);
  for (std::size_t c = 0; c < result.size(); ++c) {
    const bool noisy = left.empty() || left[c] > threshold;
    result[c] = static_cast<int>(film.samples()[c]) < most && noisy ? 1 : 0;
  }
  return result;
}

std::uint64_t samples_left(const Film& film, std::span<const std::uint8_t> cells, int most,
                           float threshold) {
  std::vector<float> noise_of;
  if (threshold > 0.0F) noise_of = noise(film);
  double sum = 0.0;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const auto samples = static_cast<int>(film.samples()[c]);
    if (cells[c] == 0 || samples >= most) continue;
    double needed = most;
    if (!noise_of.empty() && std::isfinite(noise_of[c])) {
      const double ratio = static_cast<double>(noise_of[c]) / static_cast<double>(threshold);
      const double next = samples + chunk_size(samples);
      needed = std::min(needed, std::max(next, samples * ratio * ratio));
    }
    sum += (needed - samples) * static_cast<double>(film.cell(c).area());
  }
  return static_cast<std::uint64_t>(sum);
}

}  // namespace delray::raytrace
