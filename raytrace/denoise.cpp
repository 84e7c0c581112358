#include "raytrace/denoise.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "parallel/parallel_for.h"
#include "raytrace/film.h"
#include "shading/arithmetic.h"

namespace delray::raytrace {
namespace {

constexpr std::size_t kRows = 4;  // of pixels, for a thread at a time: a millisecond of work

// The cubic B-spline, as the transform has it, from the middle on.
constexpr float kKernel[3] = {3.0F / 8.0F, 1.0F / 4.0F, 1.0F / 16.0F};

// Albedo so dark that light cannot be told from it; such channels are smoothed as they are.
constexpr float kDarkAlbedo = 0.02F;

// How different albedos may be, and depths as a part of themselves beyond what the slope explains.
constexpr float kAlbedo = 0.1F, kDepth = 0.01F;

struct Light {
  glm::vec3 colour{0.0F};  // over the albedo
  float variance = 0.0F;   // of its luminance
};

// What the weights look at, gathered in one place for each pixel.
struct Guide {
  glm::vec3 normal{0.0F}, albedo{0.0F};
  float depth = image::kEmptyDepth;
  float slope = 0.0F;  // how much depth changes to the next pixel
};

struct Plane {
  int width = 0, height = 0;
  std::vector<Guide> guide;
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
};

template <class F>
void for_each_pixel(const Plane& plane, F&& f) {
  parallel::parallel_for(0, static_cast<std::size_t>(plane.height), kRows, [&](std::size_t y) {
    for (int x = 0; x < plane.width; ++x) f(x, static_cast<int>(y));
  });
}

float luminance_of(const glm::vec3& c) { return luminance({c.x, c.y, c.z, 1.0F}); }

glm::vec3 divisor(const glm::vec3& albedo) {
  return {albedo.x > kDarkAlbedo ? albedo.x : 1.0F, albedo.y > kDarkAlbedo ? albedo.y : 1.0F,
          albedo.z > kDarkAlbedo ? albedo.z : 1.0F};
}

// The smaller of the changes to either side: the larger one may be an edge.
float slope_at(const Plane& plane, int x, int y) {
  const float here = plane.guide[plane.at(x, y)].depth;
  const auto change = [&](int dx, int dy) {
    float least = image::kEmptyDepth;
    for (const int side : {-1, 1}) {
      const int i = x + side * dx, j = y + side * dy;
      if (i < 0 || j < 0 || i >= plane.width || j >= plane.height) continue;
      const float difference = std::abs(plane.guide[plane.at(i, j)].depth - here);
      if (difference < least) least = difference;  // false for NaN, of two that are empty
    }
    return std::isfinite(least) ? least : 0.0F;
  };
  return std::max(change(1, 0), change(0, 1));
}

float alike(const Guide& a, const Guide& b, float distance) {
  float cosine = std::max(0.0F, glm::dot(a.normal, b.normal));
  for (int i = 0; i < 5; ++i) cosine *= cosine;  // to the 32nd power
  const glm::vec3 albedo = a.albedo - b.albedo;
  const float tint = glm::dot(albedo, albedo) * (1.0F / (kAlbedo * kAlbedo));
  const float depth =
      std::abs(a.depth - b.depth) / (kDepth * a.depth + a.slope * distance + 1e-30F);
  return cosine * shading::exp2(-tint - depth);
}

// The variance around a pixel, which says more than its own.
float blurred_variance(const Plane& plane, const std::vector<Light>& light, int x, int y) {
  float sum = 0.0F, weights = 0.0F;
  for (int j = std::max(0, y - 1); j <= std::min(plane.height - 1, y + 1); ++j) {
    for (int i = std::max(0, x - 1); i <= std::min(plane.width - 1, x + 1); ++i) {
      if (plane.guide[plane.at(i, j)].depth == image::kEmptyDepth) continue;
      const float weight = (i == x ? 2.0F : 1.0F) * (j == y ? 2.0F : 1.0F);
      sum += light[plane.at(i, j)].variance * weight;
      weights += weight;
    }
  }
  return sum / weights;
}

Light smoothed(const Plane& plane, const std::vector<Light>& light, int x, int y, int step,
               float strength) {
  const Guide& guide = plane.guide[plane.at(x, y)];
  const Light& own = light[plane.at(x, y)];
  const float mine = luminance_of(own.colour);
  const float spread = blurred_variance(plane, light, x, y);
  if (!(spread > 0.0F)) return own;
  const float sharpness = 1.0F / (strength * std::sqrt(spread));
  glm::vec3 sum(0.0F);
  float variance = 0.0F, weights = 0.0F;
  for (int dy = -2; dy <= 2; ++dy) {
    const int j = y + dy * step;
    if (j < 0 || j >= plane.height) continue;
    for (int dx = -2; dx <= 2; ++dx) {
      const int i = x + dx * step;
      if (i < 0 || i >= plane.width) continue;
      const std::size_t other = plane.at(i, j);
      const Guide& there = plane.guide[other];
      if (there.depth == image::kEmptyDepth) continue;
      float weight = kKernel[std::abs(dx)] * kKernel[std::abs(dy)];
      if (dx != 0 || dy != 0) {
        const auto distance = static_cast<float>(step * std::max(std::abs(dx), std::abs(dy)));
        weight *= alike(guide, there, distance) *
                  shading::exp2(-std::abs(luminance_of(light[other].colour) - mine) * sharpness);
      }
      sum += light[other].colour * weight;
      variance += light[other].variance * weight * weight;
      weights += weight;
    }
  }
  return {sum * (1.0F / weights), variance / (weights * weights)};
}

}  // namespace

Features::Features(std::size_t pixels)
    : normal(pixels, glm::vec3(0.0F)),
      albedo(pixels, glm::vec3(0.0F)),
      instance(pixels, 0xFFFFFFFFU),
      material(pixels, 0xFFFFFFFFU) {}

void denoise(image::ImageF& picture, const Features& features, std::span<const float> variance,
             const DenoiseOptions& options) {
  Plane plane{picture.width, picture.height, std::vector<Guide>(picture.pixels())};
  std::vector<Light> light(picture.pixels()), next(picture.pixels());
  for_each_pixel(plane, [&](int x, int y) {
    const std::size_t i = plane.at(x, y);
    plane.guide[i] = {features.normal[i], features.albedo[i], picture.depth[i], 0.0F};
    const image::RgbaF& c = picture.colour[i];
    const glm::vec3 by = divisor(features.albedo[i]);
    const float scale = 1.0F / std::max(luminance_of(by), kDarkAlbedo);
    light[i] = {glm::vec3(c.r, c.g, c.b) / by, variance[i] * scale * scale};
  });
  for_each_pixel(plane,
                 [&](int x, int y) { plane.guide[plane.at(x, y)].slope = slope_at(plane, x, y); });
  for (int level = 0; level < options.levels; ++level) {
    for_each_pixel(plane, [&](int x, int y) {
      const std::size_t i = plane.at(x, y);
      next[i] = plane.guide[i].depth == image::kEmptyDepth
                    ? light[i]
                    : smoothed(plane, light, x, y, 1 << level, options.strength);
    });
    std::swap(light, next);
  }
  for_each_pixel(plane, [&](int x, int y) {
    const std::size_t i = plane.at(x, y);
    if (plane.guide[i].depth == image::kEmptyDepth) return;
    const glm::vec3 c = light[i].colour * divisor(features.albedo[i]);
    picture.colour[i] = {c.x, c.y, c.z, picture.colour[i].a};
  });
}

}  // namespace delray::raytrace
