// Light of a gradient in closed form, and of a texture by its mip levels and nine spherical
// harmonics (Ramamoorthi and Hanrahan 2001).
//
// The first level of the texture that is at most 128 texels wide is projected on the harmonics
// once, each texel weighted by its solid angle; degrees 0, 1 and 2 are multiplied by 1, 2/3 and
// 1/4, which convolves them with the cosine. A look-up then costs nine products. Rough lobes read a
// blurred level, and the roughest ones blend into the harmonics.
//
// Degenerate: a black environment returns 0 before any look-up; sums of harmonics below 0 count as
// 0.
#include "shading/environment.h"

#include <algorithm>
#include <cmath>

#include "shading/arithmetic.h"
#include "shading/lanes/gradient.h"

namespace delray::shading {
namespace {

// Real spherical harmonics up to degree 2, in the order (0,0) (1,-1) (1,0) (1,1) (2,-2) ... (2,2).
std::array<float, 9> basis(const glm::vec3& d) {
  return {0.282094792F,
          0.488602512F * d.y,
          0.488602512F * d.z,
          0.488602512F * d.x,
          1.09254843F * d.x * d.y,
          1.09254843F * d.y * d.z,
          0.315391565F * (3.0F * d.z * d.z - 1.0F),
          1.09254843F * d.x * d.z,
          0.546274215F * (d.x * d.x - d.y * d.y)};
}

// The first level narrow enough that adding up all of its texels costs next to nothing.
std::size_t projection_level(const Texture& texture) {
  constexpr int kWidth = 128;
  std::size_t level = 0;
  while (texture.levels[level].width > kWidth && level + 1 < texture.levels.size()) ++level;
  return level;
}

std::array<glm::vec3, 9> project(const Environment& environment, const Texture& texture) {
  const std::size_t level = projection_level(texture);
  const auto [first, width, height] = texture.levels[level];
  const float step_u = 1.0F / static_cast<float>(width);
  const float step_v = 1.0F / static_cast<float>(height);
  std::array<glm::vec3, 9> sums{};
  float total = 0.0F;
  for (int y = 0; y < height; ++y) {
    const float v = (static_cast<float>(y) + 0.5F) * step_v;
    const SinCos theta = sin_cos(v * kPi);
    for (int x = 0; x < width; ++x) {
      const float u = (static_cast<float>(x) + 0.5F) * step_u;
      const SinCos phi = sin_cos((u - 0.5F) * 2.0F * kPi);
      const glm::vec3 direction =
          environment.up * theta.cos +
          (environment.front * phi.cos + environment.right * phi.sin) * theta.sin;
      const glm::vec3 colour(sample(texture, {u, v}, static_cast<float>(level)));
      const std::array<float, 9> weights = basis(direction);
      for (int i = 0; i < 9; ++i) sums[i] += colour * (weights[i] * theta.sin);
      total += theta.sin;
    }
  }
  // The cosine kernel over pi multiplies degrees 0, 1, 2 by 1, 2/3, 1/4.
  const float solid_angle = 4.0F * kPi / total;
  for (int i = 0; i < 9; ++i) {
    sums[i] *= solid_angle * (i == 0 ? 1.0F : i < 4 ? 2.0F / 3.0F : 0.25F);
  }
  return sums;
}

glm::vec3 gradient(const Environment& environment, const GradientWeights& weights) {
  return environment.horizon * weights.horizon + environment.zenith * weights.zenith +
         environment.ground * weights.ground;
}

bool zero(const glm::vec3& v) { return v.x == 0.0F && v.y == 0.0F && v.z == 0.0F; }

}  // namespace

Environment make_environment(const scenes::Environment& environment,
                             std::span<const Texture> textures) {
  Environment result;
  const float length = glm::length(environment.up);
  if (length > 0.0F) result.up = environment.up / length;
  const glm::vec3 ahead = std::abs(result.up.z) < 0.9F ? glm::vec3(0, 0, -1) : glm::vec3(0, 1, 0);
  const glm::vec3 right = glm::normalize(glm::cross(ahead, result.up));
  const glm::vec3 front = glm::cross(result.up, right);
  const float turns = environment.rotation * (1.0F / 360.0F);
  const SinCos turn = sin_cos(2.0F * kPi * (turns - std::floor(turns)));
  result.right = right * turn.cos + front * turn.sin;
  result.front = front * turn.cos - right * turn.sin;
  result.zenith = environment.zenith;
  result.horizon = environment.horizon;
  result.ground = environment.ground;
  if (environment.texture < textures.size()) {
    result.texture = environment.texture;
    result.harmonics = project(result, textures[environment.texture]);
    result.black = false;
  } else {
    result.black = zero(result.zenith) && zero(result.horizon) && zero(result.ground);
  }
  return result;
}

glm::vec3 radiance(const Environment& environment, std::span<const Texture> textures,
                   const glm::vec3& direction, float roughness) {
  if (environment.black) return glm::vec3(0.0F);
  if (environment.texture == scenes::kNone) {
    const float height = glm::dot(direction, environment.up);
    return gradient(environment,
                    between(sharp_weights(height), diffuse_weights(height), roughness));
  }
  const Texture& texture = textures[environment.texture];
  const float u =
      atan2(glm::dot(direction, environment.right), glm::dot(direction, environment.front)) *
          (0.5F * kInversePi) +
      0.5F;
  const float v = acos(glm::dot(direction, environment.up)) * kInversePi;
  // The level whose height is 4 texels blurs about as much as the roughest lobe.
  const float roughest = std::max(0.0F, static_cast<float>(texture.levels.size()) - 4.0F);
  const glm::vec3 blurred(sample(texture, {u, v}, roughness * roughest));
  if (roughness <= 0.5F) return blurred;
  return blurred + (diffuse_radiance(environment, direction) - blurred) * (2.0F * roughness - 1.0F);
}

glm::vec3 diffuse_radiance(const Environment& environment, const glm::vec3& normal) {
  if (environment.black) return glm::vec3(0.0F);
  if (environment.texture != scenes::kNone) {
    const std::array<float, 9> weights = basis(normal);
    glm::vec3 sum(0.0F);
    for (int i = 0; i < 9; ++i) sum += environment.harmonics[i] * weights[i];
    return glm::max(sum, glm::vec3(0.0F));
  }
  return gradient(environment, diffuse_weights(glm::dot(normal, environment.up)));
}

}  // namespace delray::shading
