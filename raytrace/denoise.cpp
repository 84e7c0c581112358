// Smoothing of noise: the edge-avoiding a-trous wavelet transform (Dammertz et al. 2010) with
// weights by variance (Schied et al. 2017), as a flux between pixels.
//
// A level exchanges light between each pixel and 24 others, further apart from level to level; the
// more alike two pixels are, the more. What one gives the other gets, so that energy stays what it
// is, and nothing is given beyond a mean of both, so that light stays within the range of what went
// into it. How far to trust the result is judged by Stein's unbiased estimate of its error (1981):
// where the transform has changed more around a pixel than its noise explains, the part that is too
// much is given back, values are held in the range that the pixels around had before, and what that
// takes of the picture's energy is given back as well.
// O(levels * 48 * pixels). Without variances they are told from neighbours that are alike.
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

constexpr std::size_t kRowsPerBlock =
    4;  // of pixels, for a thread at a time: a millisecond of work

// The cubic B-spline, as the transform has it, from the middle on.
constexpr float kKernel[3] = {3.0F / 8.0F, 1.0F / 4.0F, 1.0F / 16.0F};

// The least that light is told from albedo by: of what is darker, most is reflected by the surface
// itself, and dividing would multiply it beyond all bounds.
constexpr float kLeastAlbedo = 0.1F;

// How different albedos may be, and depths as a part of themselves beyond what the slope explains.
constexpr float kAlbedo = 0.05F, kDepth = 0.01F;

// Pixels to either side: of the range that values stay in, and of what the transform is judged by.
constexpr int kRange = 2, kJudged = 3;

struct Light {
  glm::vec3 colour{0.0F};  // over the albedo
  float variance = 0.0F;   // of its luminance
  float own = 1.0F;        // the part of it that the pixel itself had in the beginning
};

// The features that weights look at, gathered in one place for each pixel.
struct Guide {
  glm::vec3 normal{0.0F}, albedo{0.0F};
  float depth = image::kEmptyDepth;
  float slope = 0.0F;  // how much depth changes to the next pixel

  bool covered() const { return depth != image::kEmptyDepth; }
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
  parallel::parallel_for(0, static_cast<std::size_t>(plane.height), kRowsPerBlock,
                         [&](std::size_t y) {
                           for (int x = 0; x < plane.width; ++x) f(x, static_cast<int>(y));
                         });
}

template <class F>
void for_each_covered(const Plane& plane, F&& f) {
  for_each_pixel(plane, [&](int x, int y) {
    if (plane.guide[plane.at(x, y)].covered()) f(x, y);
  });
}

// The pixels of the square of `side` to every side of one.
template <class F>
void for_each_around(const Plane& plane, int x, int y, int side, F&& f) {
  for (int j = std::max(0, y - side); j <= std::min(plane.height - 1, y + side); ++j) {
    for (int i = std::max(0, x - side); i <= std::min(plane.width - 1, x + side); ++i) f(i, j);
  }
}

float luminance_of(const glm::vec3& c) { return luminance({c.x, c.y, c.z, 1.0F}); }

glm::vec3 colour_of(const image::RgbaF& c) { return {c.r, c.g, c.b}; }

glm::vec3 divisor(const Guide& guide) { return glm::max(guide.albedo, glm::vec3(kLeastAlbedo)); }

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

// How alike two pixels are, from 0 to 1, in what they show and in light, whose squared difference
// is given in terms of its noise; both ways the same.
float alike(const Guide& a, const Guide& b, float distance, float light) {
  float cosine = std::max(0.0F, glm::dot(a.normal, b.normal));
  for (int i = 0; i < 5; ++i) cosine *= cosine;  // to the 32nd power
  if (!(cosine > 0.0F)) return 0.0F;
  const glm::vec3 albedo = a.albedo - b.albedo;
  const float tint = glm::dot(albedo, albedo) * (1.0F / (kAlbedo * kAlbedo));
  const float slope = std::max(a.slope, b.slope) * distance;
  const float depth =
      std::abs(a.depth - b.depth) / (kDepth * std::min(a.depth, b.depth) + slope + 1e-30F);
  return cosine * shading::exp2(-tint - depth - light);
}

// One level: what pixels `step` and 2 * `step` apart exchange.
class Level {
 public:
  Level(const Plane& plane, const std::vector<Light>& light, int step, float strength)
      : plane_(plane),
        light_(light),
        step_(step),
        strength2_(strength * strength),
        variance_(light.size(), 0.0F),
        weight_(light.size(), 1.0F) {
    for_each_covered(plane_, [&](int x, int y) { variance_[plane_.at(x, y)] = blurred(x, y); });
    for_each_covered(plane_, [&](int x, int y) {
      float sum = kKernel[0] * kKernel[0];
      for_each_other(x, y, [&](std::size_t, float weight) { sum += weight; });
      weight_[plane_.at(x, y)] = 1.0F / sum;
    });
  }

  // The flux between two pixels of albedos a and b is the same both ways, a * change of a =
  // -b * change of b, and none gets more than a mean of all.
  Light smoothed(int x, int y) const {
    const std::size_t i = plane_.at(x, y);
    const Light& own = light_[i];
    const glm::vec3 mine = divisor(plane_.guide[i]), share = mine * weight_[i];
    glm::vec3 change(0.0F);
    float variance = 0.0F, rest = 1.0F;
    for_each_other(x, y, [&](std::size_t other, float weight) {
      const glm::vec3 theirs = divisor(plane_.guide[other]) * weight_[other];
      const glm::vec3 part = glm::min(share, theirs) * weight / mine;
      change += (light_[other].colour - own.colour) * part;
      const float luminance = luminance_of(part);
      variance += luminance * luminance * light_[other].variance;
      rest -= luminance;
    });
    return {own.colour + change, variance + rest * rest * own.variance, rest * own.own};
  }

 private:
  // The variance around a pixel, which says more than its own.
  float blurred(int x, int y) const {
    float sum = 0.0F, weights = 0.0F;
    for_each_around(plane_, x, y, 1, [&](int i, int j) {
      if (!plane_.guide[plane_.at(i, j)].covered()) return;
      const float weight = (i == x ? 2.0F : 1.0F) * (j == y ? 2.0F : 1.0F);
      sum += light_[plane_.at(i, j)].variance * weight;
      weights += weight;
    });
    return sum / weights;
  }

  template <class F>
  void for_each_other(int x, int y, F&& f) const {
    const std::size_t own = plane_.at(x, y);
    for (int dy = -2; dy <= 2; ++dy) {
      const int j = y + dy * step_;
      if (j < 0 || j >= plane_.height) continue;
      for (int dx = -2; dx <= 2; ++dx) {
        const int i = x + dx * step_;
        if (i < 0 || i >= plane_.width || (dx == 0 && dy == 0)) continue;
        const std::size_t other = plane_.at(i, j);
        // Twice the geometric mean: outliers share with others like them before the quiet ones.
        const float noise = 2.0F * std::sqrt(variance_[own] * variance_[other]);
        if (!plane_.guide[other].covered() || !(noise > 0.0F)) continue;
        const auto distance = static_cast<float>(step_ * std::max(std::abs(dx), std::abs(dy)));
        const glm::vec3 d = light_[own].colour - light_[other].colour;
        const float weight = kKernel[std::abs(dx)] * kKernel[std::abs(dy)] *
                             alike(plane_.guide[own], plane_.guide[other], distance,
                                   luminance_of(d * d) / (noise * strength2_));
        if (weight > 0.0F) f(other, weight);
      }
    }
  }

  const Plane& plane_;
  const std::vector<Light>& light_;
  int step_;
  float strength2_;
  std::vector<float> variance_;  // around each pixel
  std::vector<float> weight_;    // one over the sum of all weights of each pixel
};

// Half of the mean squared difference to neighbours that show the same: all of it is taken for
// noise.
void estimate_variances(const Plane& plane, std::vector<Light>& light) {
  for_each_covered(plane, [&](int x, int y) {
    const std::size_t own = plane.at(x, y);
    float sum = 0.0F, weights = 1e-6F;
    for_each_around(plane, x, y, 2, [&](int i, int j) {
      const std::size_t other = plane.at(i, j);
      if (other == own || !plane.guide[other].covered()) return;
      const float weight = alike(plane.guide[own], plane.guide[other], 1.0F, 0.0F);
      const float d = luminance_of(light[own].colour - light[other].colour);
      sum += weight * d * d;
      weights += weight;
    });
    light[own].variance = 0.5F * sum / weights;
  });
}

// How much of what the transform changed is kept in the picture, from 0 to 1: with a change of f
// and noise of variance v, of which a part p is left in the result, the expected squared error of
// keeping k of it is k^2 f^2 - 2 k v (1 - p) + v, the least with k = v (1 - p) / f^2. Below 1 its
// square is taken: variances come out too large rather than too small.
struct Change {
  float square = 0.0F, explained = 0.0F;
};
float kept(const Plane& plane, const std::vector<Change>& changes, int x, int y) {
  Change sum;
  for_each_around(plane, x, y, kJudged, [&](int i, int j) {
    sum.square += changes[plane.at(i, j)].square;
    sum.explained += changes[plane.at(i, j)].explained;
  });
  const float best = sum.square > sum.explained ? sum.explained / sum.square : 1.0F;
  return best * best;
}

// Gives back so much of all changes to one side, channel by channel, that the energy is what it
// was: what the range and the judgement took is missing on that side.
void balance(const Plane& plane, const image::ImageF& before, std::vector<Light>& after) {
  glm::dvec3 gained(0.0), lost(0.0);
  for (std::size_t i = 0; i < after.size(); ++i) {  // one after the other: sums have one order
    if (!plane.guide[i].covered()) continue;
    const glm::dvec3 change(after[i].colour - colour_of(before.colour[i]));
    gained += glm::max(change, 0.0);
    lost -= glm::min(change, 0.0);
  }
  glm::vec3 up(1.0F), down(1.0F);  // what is kept of changes
  for (int k = 0; k < 3; ++k) {
    if (gained[k] > lost[k]) up[k] = static_cast<float>(lost[k] / gained[k]);
    if (lost[k] > gained[k]) down[k] = static_cast<float>(gained[k] / lost[k]);
  }
  for_each_covered(plane, [&](int x, int y) {
    const std::size_t i = plane.at(x, y);
    const glm::vec3 own = colour_of(before.colour[i]), change = after[i].colour - own;
    after[i].colour = own + glm::max(change, 0.0F) * up + glm::min(change, 0.0F) * down;
  });
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
    const glm::vec3 by = divisor(plane.guide[i]);
    const float scale = 1.0F / luminance_of(by);
    light[i].colour = colour_of(picture.colour[i]) / by;
    light[i].variance = variance.empty() ? 0.0F : variance[i] * scale * scale;
  });
  for_each_pixel(plane,
                 [&](int x, int y) { plane.guide[plane.at(x, y)].slope = slope_at(plane, x, y); });
  if (variance.empty()) estimate_variances(plane, light);
  std::vector<Change> changes(picture.pixels());
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const float by = luminance_of(divisor(plane.guide[i]));
    changes[i].explained = light[i].variance * by * by;
  }
  for (int level = 0; level < options.levels; ++level) {
    const Level exchange(plane, light, 1 << level, options.strength);
    for_each_covered(plane, [&](int x, int y) { next[plane.at(x, y)] = exchange.smoothed(x, y); });
    std::swap(light, next);
  }
  for_each_covered(plane, [&](int x, int y) {
    const std::size_t i = plane.at(x, y);
    light[i].colour *= divisor(plane.guide[i]);
    const float change = luminance_of(light[i].colour - colour_of(picture.colour[i]));
    changes[i] = {change * change, changes[i].explained * (1.0F - light[i].own)};
  });
  for_each_covered(plane, [&](int x, int y) {
    const std::size_t i = plane.at(x, y);
    const glm::vec3 before = colour_of(picture.colour[i]);
    glm::vec3 low = before, high = before;
    for_each_around(plane, x, y, kRange, [&](int a, int b) {
      const glm::vec3 c = colour_of(picture.colour[plane.at(a, b)]);
      low = glm::min(low, c);
      high = glm::max(high, c);
    });
    const float part = kept(plane, changes, x, y);
    next[i].colour = glm::clamp(before + (light[i].colour - before) * part, low, high);
  });
  balance(plane, picture, next);
  for_each_covered(plane, [&](int x, int y) {
    const std::size_t i = plane.at(x, y);
    const glm::vec3& c = next[i].colour;
    picture.colour[i] = {c.x, c.y, c.z, picture.colour[i].a};
  });
}

}  // namespace delray::raytrace
