#include "shading/brdf.h"

#include "shading/internal/specular_table.h"

namespace delray::shading {
namespace {

// Of a lobe whose reflectance at normal and grazing incidence are 1 and 0, and 0 and 1.
struct Shares {
  float normal = 0.0F, grazing = 0.0F;
};

float roughness_at(int i) {
  return std::max(static_cast<float>(i) / static_cast<float>(SpecularTable::kRoughnesses - 1),
                  kMinRoughness);
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

SpecularTable make_table() {
  SpecularTable table;
  for (int i = 0; i < SpecularTable::kRoughnesses; ++i) {
    for (int j = 0; j < SpecularTable::kCosines; ++j) {
      const float x = static_cast<float>(j) / static_cast<float>(SpecularTable::kCosines - 1);
      const float cosine = 1.0F - std::sqrt(1.0F - x);
      const Shares shares = integrate(roughness_at(i), std::max(cosine, 0.01F));
      table.normal[i][j] = shares.normal;
      table.grazing[i][j] = shares.grazing;
    }
  }
  return table;
}

}  // namespace

const SpecularTable& specular_table() {
  static const SpecularTable table = make_table();
  return table;
}

glm::vec3 specular_albedo_at(const Lobes& lobes, int j) {
  const SpecularTable& table = specular_table();
  const float y = lobes.roughness * static_cast<float>(SpecularTable::kRoughnesses - 1);
  const int i = std::min(static_cast<int>(y), SpecularTable::kRoughnesses - 2);
  const float v = y - static_cast<float>(i);
  return lobes.specular * mix(table.normal[i][j], table.normal[i + 1][j], v) +
         glm::vec3(lobes.grazing * mix(table.grazing[i][j], table.grazing[i + 1][j], v));
}

glm::vec3 specular_albedo(const Lobes& lobes, float cosine) {
  const float c = clamp01(cosine);
  const float x = c * (2.0F - c) * static_cast<float>(SpecularTable::kCosines - 1);
  const int j = std::min(static_cast<int>(x), SpecularTable::kCosines - 2);
  const float u = x - static_cast<float>(j);
  const glm::vec3 low = specular_albedo_at(lobes, j);
  return low + (specular_albedo_at(lobes, j + 1) - low) * u;
}

}  // namespace delray::shading
