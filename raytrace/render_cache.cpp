// Carries samples over by projecting their points, the nearest one for each pixel, then classes
// pixels by how much they need a ray and gives rays to the most urgent ones until the share is
// used up; within a class a hash of pixel and frame decides, so that no pixel waits for long. What
// is left without a ray gets the mean colour of what is around it. Every new sample is compared
// with the one that was carried to its pixel: what the samples of a tile show of each other stands
// for all of it.
//
// Degenerate: points behind the eye or outside of the frame are lost, and a view that shows nothing
// of the last one is traced as far as the share goes.
#include "raytrace/render_cache.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

#include "parallel/parallel_for.h"

namespace delray::raytrace {
namespace {

constexpr float kNowhere = std::numeric_limits<float>::infinity();
// Steps of depth between neighbours that are taken for silhouettes, as a part of the depth.
constexpr float kDepthStep = 0.03F;
// Pixels around surfaces where others may have come into sight.
constexpr int kSurfaceReach = 24;
// Squares of up to 16 x 16 pixels.
constexpr int kFillLevels = 4;
// Frames after which a sample is as urgent as those at silhouettes.
constexpr std::uint32_t kOldAge = 12;
// Classes of pixels; of kDoubtful ones all are traced.
enum : std::uint8_t { kEmpty, kKnown, kNearSurface, kOldSample, kEdge, kHole, kDoubtful, kClasses };
// Sides of the tiles in which new samples are compared with those that were carried over, and the
// mean difference, of 1 as it is shown, from which on none of the tile is carried over.
constexpr std::size_t kTile = 8;
constexpr float kMostDifference = 2.0F / 255;
// Fewer samples than this say nothing of a tile.
constexpr int kFewSamples = 3;

// Evenly spread numbers for pixels and frames.
std::uint32_t hash_of(std::uint32_t pixel, std::uint32_t frame) {
  std::uint64_t x = (std::uint64_t{frame} << 32 | pixel) * 0x9E3779B97F4A7C15U;
  x = (x ^ x >> 29) * 0xBF58476D1CE4E5B9U;
  return static_cast<std::uint32_t>(x >> 40);  // 24 bits
}

// Of two colours as a screen shows them, about: its values are near to square roots.
float difference_of(const image::RgbaF& a, const image::RgbaF& b) {
  const auto shown = [](float value) { return std::sqrt(std::clamp(value, 0.0F, 1.0F)); };
  return (std::abs(shown(a.r) - shown(b.r)) + std::abs(shown(a.g) - shown(b.g)) +
          std::abs(shown(a.b) - shown(b.b))) /
         3;
}

glm::vec3 place_of(const scenes::View& view, int x, int y, float depth) {
  const float right = (static_cast<float>(x) + 0.5F - view.half_width) / view.scale;
  const float up = (view.half_height - static_cast<float>(y) - 0.5F) / view.scale;
  const glm::vec3 aside = view.right * right + view.up * up;
  if (view.orthographic) return view.eye + aside + view.forward * depth;
  return view.eye + (view.forward + aside) * depth;
}

}  // namespace

RenderCache::RenderCache(int width, int height, double share)
    : width_(width), height_(height), share_(share) {
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  last_.resize(pixels);
  trace_.assign(pixels, 1);
  urgent_.resize(pixels);
  depth_.resize(pixels);
  if (pixels > 0) revealing_.resize(tile_of(width - 1, height - 1) + 1);
}

std::size_t RenderCache::tile_of(int x, int y) const {
  const std::size_t columns = (static_cast<std::size_t>(width_) + kTile - 1) / kTile;
  return static_cast<std::size_t>(y) / kTile * columns + static_cast<std::size_t>(x) / kTile;
}

void RenderCache::carry_over(const scenes::View& view) {
  now_.assign(last_.size(), {});
  std::fill(depth_.begin(), depth_.end(), kNowhere);
  for (const Sample& sample : last_) {
    if (sample.frame == 0) continue;
    const glm::vec3 v = sample.place - view.eye;
    const float depth = glm::dot(v, view.forward);
    if (!(depth > view.near)) continue;
    const float scale = view.orthographic ? view.scale : view.scale / depth;
    const float x = std::floor(view.half_width + glm::dot(v, view.right) * scale);
    const float y = std::floor(view.half_height - glm::dot(v, view.up) * scale);
    if (!(x >= 0 && y >= 0 && x < static_cast<float>(width_) && y < static_cast<float>(height_)))
      continue;
    const std::size_t pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                              static_cast<std::size_t>(x);
    if (depth >= depth_[pixel]) continue;
    depth_[pixel] = depth;
    now_[pixel] = sample;
  }
}

std::uint8_t RenderCache::urgency(int x, int y) const {
  const auto at = [&](int column, int row) {
    const bool is_outside = column < 0 || row < 0 || column >= width_ || row >= height_;
    return is_outside ? -1.0F
                      : depth_[static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) +
                               static_cast<std::size_t>(column)];
  };
  const float own = at(x, y);
  int around = 0, known = 0, nearer = 0, farther = 0;
  for (int j = -1; j <= 1; ++j) {
    for (int i = -1; i <= 1; ++i) {
      const float other = at(x + i, y + j);
      if (other < 0 || (i == 0 && j == 0)) continue;
      ++around;
      if (other == kNowhere) continue;
      ++known;
      nearer += other < own * (1 - kDepthStep) ? 1 : 0;
      farther += other > own * (1 + kDepthStep) ? 1 : 0;
    }
  }
  if (own == kNowhere && revealing_[tile_of(x, y)] != 0) return kDoubtful;
  if (own == kNowhere) return 2 * known >= around ? kHole : known > 0 ? kEdge : kEmpty;
  const Sample& sample = now_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                              static_cast<std::size_t>(x)];
  if (sample.is_doubtful) return kDoubtful;
  if (nearer > 2 || known < around || farther > 2) return kEdge;
  return frame_ - sample.frame >= kOldAge ? kOldSample : kKnown;
}

// Marks the pixels to trace, the most urgent ones first.
void RenderCache::choose() {
  constexpr std::size_t kRows = 8;
  const auto width = static_cast<std::size_t>(width_);
  parallel::parallel_for(0, static_cast<std::size_t>(height_), kRows, [&](std::size_t y) {
    for (int x = 0; x < width_; ++x)
      urgent_[y * width + static_cast<std::size_t>(x)] = urgency(x, static_cast<int>(y));
  });
  // Distances from surfaces, along rows and then along columns: a square around each.
  std::vector<std::uint8_t> close(urgent_.size(), 0);
  parallel::parallel_for(0, static_cast<std::size_t>(height_), kRows, [&](std::size_t y) {
    int since = kSurfaceReach + 1;
    const auto look = [&](std::size_t x) {
      since = depth_[y * width + x] == kNowhere ? since + 1 : 0;
      if (since <= kSurfaceReach) close[y * width + x] = 1;
    };
    for (std::size_t x = 0; x < width; ++x) look(x);
    since = kSurfaceReach + 1;
    for (std::size_t x = width; x-- > 0;) look(x);
  });
  parallel::parallel_for(0, width, kRows, [&](std::size_t x) {
    const auto pass = [&](bool down) {
      int since = kSurfaceReach + 1;
      for (std::size_t i = 0; i < static_cast<std::size_t>(height_); ++i) {
        const std::size_t y = down ? i : static_cast<std::size_t>(height_) - 1 - i;
        since = close[y * width + x] == 1 ? 0 : since + 1;
        std::uint8_t& urgent = urgent_[y * width + x];
        if (since <= kSurfaceReach && urgent == kEmpty) urgent = kNearSurface;
      }
    };
    pass(true);
    pass(false);
  });

  std::array<std::uint64_t, kClasses> sizes{};
  for (const std::uint8_t urgent : urgent_) ++sizes[urgent];
  const auto doubtful = static_cast<double>(sizes[kDoubtful]);
  const auto all = static_cast<double>(urgent_.size());
  double left = std::max(all * share_ - doubtful, 0.5 * share_ * (all - doubtful));
  std::array<std::uint32_t, kClasses> below{};  // of hashes: those are traced
  below[kDoubtful] = 1U << 24;
  for (int c = kDoubtful; c-- > 0;) {
    const auto size = static_cast<double>(sizes[c]);
    const double part = size > 0 ? std::min(1.0, left / size) : 0.0;
    below[c] = static_cast<std::uint32_t>(part * 0x1p24);
    left = std::max(0.0, left - size);
  }
  traced_ = 0;
  for (std::size_t i = 0; i < urgent_.size(); ++i) {
    trace_[i] = hash_of(static_cast<std::uint32_t>(i), frame_) < below[urgent_[i]] ? 1 : 0;
    traced_ += trace_[i];
  }
}

const std::vector<std::uint8_t>& RenderCache::plan(const scenes::View& view) {
  ++frame_;
  if (frame_ == 1) {
    now_.assign(last_.size(), {});
    traced_ = last_.size();
    return trace_;
  }
  carry_over(view);
  choose();
  return trace_;
}

// Pixels that nothing is known of, but that lie beside known ones, get the mean of those in the
// smallest square of a pyramid that has any, up to kFillLevels.
void RenderCache::fill(image::ImageF& picture) const {
  struct Level {
    std::size_t width, height;
    std::vector<image::RgbaF> sums;
    std::vector<float> counts;
  };
  const auto is_known = [&](std::size_t i) { return trace_[i] != 0 || now_[i].frame != 0; };
  std::vector<Level> levels;
  std::size_t width = static_cast<std::size_t>(width_), height = static_cast<std::size_t>(height_);
  for (int k = 0; k < kFillLevels; ++k) {
    Level level{(width + 1) / 2, (height + 1) / 2, {}, {}};
    level.sums.resize(level.width * level.height);
    level.counts.resize(level.sums.size());
    const Level* const finer = levels.empty() ? nullptr : &levels.back();
    parallel::parallel_for(0, level.height, 8, [&](std::size_t y) {
      for (std::size_t i = 0; i < 4 * level.width; ++i) {
        const std::size_t x = i / 4, column = 2 * x + i % 2, row = 2 * y + i / 2 % 2;
        if (column >= width || row >= height) continue;
        const std::size_t from = row * width + column;
        if (finer == nullptr && !is_known(from)) continue;
        const image::RgbaF& c = finer == nullptr ? picture.colour[from] : finer->sums[from];
        image::RgbaF& sum = level.sums[y * level.width + x];
        sum = {sum.r + c.r, sum.g + c.g, sum.b + c.b, sum.a + c.a};
        level.counts[y * level.width + x] += finer == nullptr ? 1.0F : finer->counts[from];
      }
    });
    width = level.width;
    height = level.height;
    levels.push_back(std::move(level));
  }
  parallel::parallel_for(0, static_cast<std::size_t>(height_), 8, [&](std::size_t y) {
    for (std::size_t x = 0; x < static_cast<std::size_t>(width_); ++x) {
      const std::size_t i = y * static_cast<std::size_t>(width_) + x;
      if (is_known(i)) continue;
      for (std::size_t k = 0; k < levels.size(); ++k) {
        const std::size_t at = (y >> (k + 1)) * levels[k].width + (x >> (k + 1));
        const float count = levels[k].counts[at];
        if (!(count > 0)) continue;
        const image::RgbaF& sum = levels[k].sums[at];
        picture.colour[i] = {sum.r / count, sum.g / count, sum.b / count, sum.a / count};
        break;
      }
    }
  });
}

// By tile: 1 where new samples differ from those that were carried over, 0 where they agree, -1
// where there are too few to tell. Samples of different surfaces are not compared.
std::vector<std::int8_t> RenderCache::judge_tiles(const image::ImageF& picture) const {
  const auto width = static_cast<std::size_t>(width_), height = static_cast<std::size_t>(height_);
  const std::size_t columns = (width + kTile - 1) / kTile, rows = (height + kTile - 1) / kTile;
  std::vector<std::int8_t> result(columns * rows, -1);
  parallel::parallel_for(0, rows, 1, [&](std::size_t row) {
    for (std::size_t column = 0; column < columns; ++column) {
      int count = 0;
      float sum = 0;
      for (std::size_t y = row * kTile; y < std::min(height, (row + 1) * kTile); ++y) {
        for (std::size_t x = column * kTile; x < std::min(width, (column + 1) * kTile); ++x) {
          const std::size_t i = y * width + x;
          if (trace_[i] == 0 || now_[i].frame == 0) continue;
          const float depth = picture.depth[i];
          if (!(std::abs(depth - depth_[i]) <= kDepthStep * depth_[i])) continue;
          ++count;
          sum += difference_of(picture.colour[i], now_[i].colour);
        }
      }
      if (count >= kFewSamples)
        result[row * columns + column] =
            sum > kMostDifference * static_cast<float>(count) ? std::int8_t{1} : std::int8_t{0};
    }
  });
  return result;
}

void RenderCache::find_revealing_tiles(const image::ImageF& picture) {
  const auto width = static_cast<std::size_t>(width_), height = static_cast<std::size_t>(height_);
  const std::size_t columns = (width + kTile - 1) / kTile, rows = (height + kTile - 1) / kTile;
  std::vector<std::uint8_t> found(columns * rows, 0);
  parallel::parallel_for(0, rows, 1, [&](std::size_t row) {
    for (std::size_t column = 0; column < columns; ++column) {
      int count = 0, surfaces = 0;
      for (std::size_t y = row * kTile; y < std::min(height, (row + 1) * kTile); ++y) {
        for (std::size_t x = column * kTile; x < std::min(width, (column + 1) * kTile); ++x) {
          const std::size_t i = y * width + x;
          if (trace_[i] == 0 || now_[i].frame != 0) continue;
          ++count;
          surfaces += picture.depth[i] == image::kEmptyDepth ? 0 : 1;
        }
      }
      found[row * columns + column] = count >= kFewSamples && 8 * surfaces >= 7 * count ? 1 : 0;
    }
  });
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t column = 0; column < columns; ++column) {
      std::uint8_t any = 0;
      for (std::size_t j = row > 0 ? row - 1 : 0; j < std::min(rows, row + 2); ++j)
        for (std::size_t i = column > 0 ? column - 1 : 0; i < std::min(columns, column + 2); ++i)
          any |= found[j * columns + i];
      revealing_[row * columns + column] = any;
    }
  }
}

void RenderCache::complete(const scenes::View& view, image::ImageF& picture) {
  assert(picture.width == width_ && picture.height == height_);
  constexpr std::size_t kRows = 8;
  const auto width = static_cast<std::size_t>(width_);
  const std::vector<std::int8_t> judged = judge_tiles(picture);
  if (frame_ > 1) find_revealing_tiles(picture);
  parallel::parallel_for(0, static_cast<std::size_t>(height_), kRows, [&](std::size_t y) {
    for (std::size_t x = 0; x < width; ++x) {
      const std::size_t i = y * width + x;
      Sample& sample = now_[i];
      const std::int8_t tile = judged[tile_of(static_cast<int>(x), static_cast<int>(y))];
      if (tile >= 0) sample.is_doubtful = tile == 1;
      if (trace_[i] == 0) {
        picture.colour[i] = sample.colour;
        picture.depth[i] = sample.frame == 0 ? image::kEmptyDepth : depth_[i];
        continue;
      }
      const bool is_doubtful = sample.is_doubtful;
      sample = {};
      if (picture.depth[i] == image::kEmptyDepth) continue;
      sample = {place_of(view, static_cast<int>(x), static_cast<int>(y), picture.depth[i]),
                picture.colour[i], frame_, is_doubtful};
    }
  });
  if (frame_ > 1) fill(picture);
  std::swap(last_, now_);
}

}  // namespace delray::raytrace
