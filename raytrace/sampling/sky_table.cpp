// Cuts the sphere into cells, weights each by its light and that of its neighbours, into which
// filtering reaches, and draws from an alias table, by vectors. O(cells) to build, O(1) to draw.
//
// Degenerate: every cell gets part of the mean, so that no direction has density 0; at borders
// between rows rounding is corrected by the heights themselves.
#include "raytrace/sampling/sky_table.h"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/sampling/sky_table.cpp"
#include <hwy/foreach_target.h>
// Code that is compiled per target comes after it.
#include <hwy/highway.h>

#include "raytrace/sampling/alias_lanes.h"
#include "shading/arithmetic.h"

HWY_BEFORE_NAMESPACE();
namespace delray::raytrace {
namespace HWY_NAMESPACE {

HWY_INLINE F height_of(const SkyCells& cells, I row) {
  return hn::GatherIndex(FloatTag(), cells.heights.data(), row);
}

// The density in a cell between two heights.
HWY_INLINE F density(const SkyCells& cells, I cell, F high, F low) {
  const float turn = 2.0F * shading::kPi / static_cast<float>(cells.columns);
  return looked_up(cells.table.probabilities(), cell) / ((high - low) * set(turn));
}

void sky_samples(const SkyCells& cells, const Pairs16& choices, const Pairs16& places,
                 shading::Vectors16& directions, shading::Floats16& pdfs) {
  const FloatTag d;
  const F one = set(1.0F), columns = set(static_cast<float>(cells.columns));
  for (int i = 0; i < shading::kBlockPoints; i += lanes()) {
    const I cell = pick(cells.table, load(choices.x, i), load(choices.y, i));
    const F number = to_float(cell);  // exact: there are few
    const I row = truncated((number + set(0.5F)) / columns);
    const F column = number - to_float(row) * columns;
    const F high = height_of(cells, row), low = height_of(cells, row + set(1));
    const F height = mix(high, low, load(places.y, i));
    const F across = hn::Sqrt(max_of(set(0.0F), one - height * height));
    const F u = (column + load(places.x, i)) / columns;
    const SinCosLanes phi = sin_cos((u - set(0.5F)) * set(2.0F * shading::kPi));
    const F3 direction =
        set(cells.up) * height + (set(cells.front) * phi.cos + set(cells.right) * phi.sin) * across;
    hn::Store(direction.x, d, directions.x.lane + i);
    hn::Store(direction.y, d, directions.y.lane + i);
    hn::Store(direction.z, d, directions.z.lane + i);
    hn::Store(density(cells, cell, high, low), d, pdfs.lane + i);
  }
}

void sky_densities(const SkyCells& cells, const shading::Vectors16& directions,
                   shading::Floats16& pdfs) {
  const FloatTag d;
  const I none = set(0), last = set(cells.rows - 1);
  const auto within = [](I x, I low, I high) { return hn::Min(hn::Max(x, low), high); };
  for (int i = 0; i < shading::kBlockPoints; i += lanes()) {
    const F3 direction = load(directions, i);
    const F height = min_of(max_of(dot(direction, set(cells.up)), set(-1.0F)), set(1.0F));
    const F v = acos(height) * set(shading::kInversePi);
    I row = within(truncated(v * set(static_cast<float>(cells.rows))), none, last);
    // At the border of two rows the angle may be one off.
    const auto below = [&](M m) { return hn::VecFromMask(IntTag(), hn::RebindMask(IntTag(), m)); };
    row = hn::Max(row + below(hn::Gt(height, height_of(cells, row))), none);
    row = hn::Min(row - below(hn::Le(height, height_of(cells, row + set(1)))), last);
    I cell = row;
    if (cells.columns > 1) {
      const F u = atan2(dot(direction, set(cells.right)), dot(direction, set(cells.front))) *
                      set(0.5F * shading::kInversePi) +
                  set(0.5F);
      const I column = within(truncated(u * set(static_cast<float>(cells.columns))), none,
                              set(cells.columns - 1));
      cell = row * set(cells.columns) + column;
    }
    hn::Store(density(cells, cell, height_of(cells, row), height_of(cells, row + set(1))), d,
              pdfs.lane + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::raytrace
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace delray::raytrace {
namespace {

HWY_EXPORT(sky_samples);
HWY_EXPORT(sky_densities);

using shading::kPi;

constexpr int kMostColumns = 1024;  // a third of a degree, less than the sun
constexpr int kGradientRows = 64;

// Of the mean, which every cell gets besides its own light: bilinear filtering and blurred levels
// carry light into cells that have none.
constexpr float kEverywhere = 0.05F;

float mean(const glm::vec3& v) { return (v.x + v.y + v.z) * (1.0F / 3.0F); }

std::size_t level_of(const shading::Texture& texture) {
  std::size_t level = 0;
  while (texture.levels[level].width > kMostColumns && level + 1 < texture.levels.size()) ++level;
  return level;
}

}  // namespace

SkyTable::SkyTable(const shading::Environment& environment,
                   std::span<const shading::Texture> textures)
    : cells_{environment.up, environment.front, environment.right, 0, 0, {}, {}} {
  int &rows = cells_.rows, &columns = cells_.columns;
  std::vector<float>& heights = cells_.heights;
  const bool textured = environment.texture < textures.size();
  std::size_t level = 0;
  if (textured) {
    const shading::Texture& texture = textures[environment.texture];
    level = level_of(texture);
    rows = texture.levels[level].height;
    columns = texture.levels[level].width;
  } else {
    rows = kGradientRows;
    columns = 1;
  }
  heights.resize(static_cast<std::size_t>(rows) + 1);
  for (int y = 0; y <= rows; ++y) {
    heights[y] = shading::sin_cos(kPi * static_cast<float>(y) / static_cast<float>(rows)).cos;
  }
  heights.front() = 1.0F;
  heights.back() = -1.0F;

  std::vector<float> light(static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns));
  const auto at = [&](int x, int y) -> float& {
    return light[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) +
                 static_cast<std::size_t>(x)];
  };
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      if (textured) {
        const glm::vec2 uv((static_cast<float>(x) + 0.5F) / static_cast<float>(columns),
                           (static_cast<float>(y) + 0.5F) / static_cast<float>(rows));
        at(x, y) = mean(glm::vec3(
            shading::sample(textures[environment.texture], uv, static_cast<float>(level))));
      } else {
        const float height = 0.5F * (heights[y] + heights[y + 1]);
        const float across = std::sqrt(std::max(0.0F, 1.0F - height * height));
        at(x, y) = mean(shading::radiance(environment, textures,
                                          environment.up * height + environment.front * across));
      }
    }
  }
  double sum = 0.0;
  const float turn = 2.0F * kPi / static_cast<float>(columns);
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) sum += at(x, y) * (heights[y] - heights[y + 1]) * turn;
  }
  integral_ = static_cast<float>(sum);
  const float average = integral_ / (4.0F * kPi);
  std::vector<float> weights(light.size());
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      // Half of it from the cells around, into which filtering reaches.
      float around = 0.0F;
      for (int j = -1; j <= 1; ++j) {
        for (int i = -1; i <= 1; ++i) {
          around += at((x + i + columns) % columns, std::clamp(y + j, 0, rows - 1));
        }
      }
      weights[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) +
              static_cast<std::size_t>(x)] =
          (0.5F * at(x, y) + around * (0.5F / 9.0F) + kEverywhere * average) *
          (heights[y] - heights[y + 1]);
    }
  }
  cells_.table = AliasTable(weights);
}

void SkyTable::sample(const Pairs16& cell, const Pairs16& place, shading::Vectors16& directions,
                      shading::Floats16& pdfs) const {
  HWY_DYNAMIC_DISPATCH(sky_samples)(cells_, cell, place, directions, pdfs);
}

void SkyTable::pdf(const shading::Vectors16& directions, shading::Floats16& pdfs) const {
  HWY_DYNAMIC_DISPATCH(sky_densities)(cells_, directions, pdfs);
}

}  // namespace delray::raytrace
#endif
