#include "raytrace/sky_table.h"

#include <algorithm>
#include <cmath>

#include "shading/arithmetic.h"

namespace delray::raytrace {
namespace {

using shading::kPi;

constexpr int kMostColumns = 256;
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
    : up_(environment.up), front_(environment.front), right_(environment.right) {
  const bool textured = environment.texture < textures.size();
  std::size_t level = 0;
  if (textured) {
    const shading::Texture& texture = textures[environment.texture];
    level = level_of(texture);
    rows_ = texture.levels[level].height;
    columns_ = texture.levels[level].width;
  } else {
    rows_ = kGradientRows;
    columns_ = 1;
  }
  heights_.resize(static_cast<std::size_t>(rows_) + 1);
  for (int y = 0; y <= rows_; ++y) {
    heights_[y] = shading::sin_cos(kPi * static_cast<float>(y) / static_cast<float>(rows_)).cos;
  }
  heights_.front() = 1.0F;
  heights_.back() = -1.0F;

  std::vector<float> light(static_cast<std::size_t>(rows_) * static_cast<std::size_t>(columns_));
  const auto at = [&](int x, int y) -> float& {
    return light[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) +
                 static_cast<std::size_t>(x)];
  };
  for (int y = 0; y < rows_; ++y) {
    for (int x = 0; x < columns_; ++x) {
      if (textured) {
        const glm::vec2 uv((static_cast<float>(x) + 0.5F) / static_cast<float>(columns_),
                           (static_cast<float>(y) + 0.5F) / static_cast<float>(rows_));
        at(x, y) = mean(glm::vec3(
            shading::sample(textures[environment.texture], uv, static_cast<float>(level))));
      } else {
        const float height = 0.5F * (heights_[y] + heights_[y + 1]);
        const float across = std::sqrt(std::max(0.0F, 1.0F - height * height));
        at(x, y) = mean(shading::radiance(environment, textures, up_ * height + front_ * across));
      }
    }
  }
  double sum = 0.0;
  const float turn = 2.0F * kPi / static_cast<float>(columns_);
  for (int y = 0; y < rows_; ++y) {
    for (int x = 0; x < columns_; ++x) sum += at(x, y) * (heights_[y] - heights_[y + 1]) * turn;
  }
  integral_ = static_cast<float>(sum);
  const float average = integral_ / (4.0F * kPi);
  std::vector<float> weights(light.size());
  for (int y = 0; y < rows_; ++y) {
    for (int x = 0; x < columns_; ++x) {
      // Half of it from the cells around, into which filtering reaches.
      float around = 0.0F;
      for (int j = -1; j <= 1; ++j) {
        for (int i = -1; i <= 1; ++i) {
          around += at((x + i + columns_) % columns_, std::clamp(y + j, 0, rows_ - 1));
        }
      }
      weights[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) +
              static_cast<std::size_t>(x)] =
          (0.5F * at(x, y) + around * (0.5F / 9.0F) + kEverywhere * average) *
          (heights_[y] - heights_[y + 1]);
    }
  }
  table_ = AliasTable(weights);
}

float SkyTable::cell_pdf(int row, std::uint32_t cell) const {
  const float size =
      (heights_[row] - heights_[row + 1]) * (2.0F * kPi / static_cast<float>(columns_));
  return table_.probability(cell) / size;
}

SkyDirection SkyTable::sample(const glm::vec2& cell, const glm::vec2& place) const {
  const std::uint32_t i = table_.pick(cell.x, cell.y);
  const int row = static_cast<int>(i / static_cast<std::uint32_t>(columns_));
  const auto column = static_cast<float>(i % static_cast<std::uint32_t>(columns_));
  const float height = shading::mix(heights_[row], heights_[row + 1], place.y);
  const float across = std::sqrt(std::max(0.0F, 1.0F - height * height));
  const float u = (column + place.x) / static_cast<float>(columns_);
  const shading::SinCos phi = shading::sin_cos((u - 0.5F) * 2.0F * kPi);
  return {up_ * height + (front_ * phi.cos + right_ * phi.sin) * across, cell_pdf(row, i)};
}

float SkyTable::pdf(const glm::vec3& direction) const {
  const float height = std::clamp(glm::dot(direction, up_), -1.0F, 1.0F);
  const float v = shading::acos(height) * shading::kInversePi;
  int row = std::clamp(static_cast<int>(v * static_cast<float>(rows_)), 0, rows_ - 1);
  while (row > 0 && height > heights_[row]) --row;
  while (row + 1 < rows_ && height <= heights_[row + 1]) ++row;
  int column = 0;
  if (columns_ > 1) {
    const float u = shading::atan2(glm::dot(direction, right_), glm::dot(direction, front_)) *
                        (0.5F * shading::kInversePi) +
                    0.5F;
    column = std::clamp(static_cast<int>(u * static_cast<float>(columns_)), 0, columns_ - 1);
  }
  return cell_pdf(row, static_cast<std::uint32_t>(row * columns_ + column));
}

}  // namespace delray::raytrace
