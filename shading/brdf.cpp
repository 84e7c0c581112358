#include "shading/brdf.h"

#include <array>

namespace delray::shading {
namespace {

constexpr int kSide = 24;

// Of a lobe whose reflectance at normal and grazing incidence are 1 and 0, and 0 and 1.
struct Shares {
  float normal = 0.0F, grazing = 0.0F;
};

float roughness_at(int i) {
  return std::max(static_cast<float>(i) / static_cast<float>(kSide - 1), kMinRoughness);
}

// Half vectors are drawn with the density of the GGX distribution, stratified.
Shares integrate(float roughness, float cosine) {
  constexpr int kRows = 32, kColumns = 16;
  const float a2 = roughness * roughness * roughness * roughness;
  const glm::vec3 view(std::sqrt(1.0F - cosine * cosine), 0.0F, cosine);
  Shares sum;
  for (int i = 0; i < kRows; ++i) {
    const float x = (static_cast<float>(i) + 0.5F) / kRows;
    const float n_h = std::sqrt((1.0F - x) / (1.0F + (a2 - 1.0F) * x));
    const float sine = std::sqrt(std::max(0.0F, 1.0F - n_h * n_h));
    for (int j = 0; j < kColumns; ++j) {
      const SinCos phi = sin_cos(kPi * (static_cast<float>(j) + 0.5F) / kColumns);
      const glm::vec3 half(sine * phi.cos, sine * phi.sin, n_h);
      const float v_h = glm::dot(view, half);
      const float n_l = 2.0F * v_h * n_h - cosine;
      if (n_l <= 0.0F || v_h <= 0.0F) continue;
      const float shadowing = n_l * std::sqrt(cosine * cosine * (1.0F - a2) + a2) +
                              cosine * std::sqrt(n_l * n_l * (1.0F - a2) + a2);
      const float weight = 2.0F * n_l * v_h / (shadowing * n_h);
      const float grazing = pow5(1.0F - v_h);
      sum.normal += weight * (1.0F - grazing);
      sum.grazing += weight * grazing;
    }
  }
  constexpr float kScale = 1.0F / (kRows * kColumns);
  return {sum.normal * kScale, sum.grazing * kScale};
}

using Table = std::array<std::array<Shares, kSide>, kSide>;

Table make_table() {
  Table table;
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j) {
      const float cosine = static_cast<float>(j) / static_cast<float>(kSide - 1);
      table[i][j] = integrate(roughness_at(i), std::max(cosine, 0.01F));
    }
  }
  return table;
}

}  // namespace

glm::vec3 specular_albedo(const Lobes& lobes, float cosine) {
  static const Table table = make_table();
  const float y = lobes.roughness * static_cast<float>(kSide - 1);
  const float x = clamp01(cosine) * static_cast<float>(kSide - 1);
  const int i = std::min(static_cast<int>(y), kSide - 2);
  const int j = std::min(static_cast<int>(x), kSide - 2);
  const float v = y - static_cast<float>(i), u = x - static_cast<float>(j);
  const auto between = [&](float Shares::*share) {
    return mix(mix(table[i][j].*share, table[i][j + 1].*share, u),
               mix(table[i + 1][j].*share, table[i + 1][j + 1].*share, u), v);
  };
  return lobes.specular * between(&Shares::normal) +
         glm::vec3(lobes.grazing * between(&Shares::grazing));
}

}  // namespace delray::shading
