// The share of light that a GGX lobe reflects at the first meeting, tabulated over roughness and
// viewer, and the lobes and responses that follow from it. Papers: see the header.
//
// Schlick's term is linear in the reflectances at normal and at grazing incidence, so an entry
// keeps two numbers and serves every colour. An entry is the mean over half vectors that the viewer
// sees, one from each cell of a grid. The table is made at the first use (kRoughnesses x kCosines
// entries); a look-up is bilinear in the roughness and in the root of the cosine.
//
// Degenerate: the row of roughness 0 is a mirror's, in closed form; viewers at the horizon count as
// slightly above it (kLeastSeen); unlit surfaces get lobes that reflect nothing.
#include "shading/brdf.h"

#include "shading/lanes/specular_table.h"
#include "shading/microfacets.h"

namespace delray::shading {
namespace {

// The table's lowest viewer.
constexpr float kLeastSeen = 1e-3F;

float roughness_at(int i) {
  return std::max(static_cast<float>(i) / static_cast<float>(SpecularTable::kRoughnesses - 1),
                  kMinRoughness);
}

SpecularShares smooth(float cosine) {
  const float grazing = pow5(1.0F - cosine);
  return {1.0F - grazing, grazing};
}

// Half vectors are drawn as the viewer sees them, stratified; those of one half of the directions
// around the normal stand for both.
SpecularShares integrate(float roughness, float cosine) {
  constexpr int kRows = 32, kColumns = 8;
  const float alpha = roughness * roughness, a2 = alpha * alpha;
  const glm::vec3 view(std::sqrt(1.0F - cosine * cosine), 0.0F, cosine);
  const float seen = masking(cosine, a2);
  SpecularShares sum{0.0F, 0.0F};
  for (int i = 0; i < kRows; ++i) {
    for (int j = 0; j < kColumns; ++j) {
      const glm::vec3 half =
          visible_normal(view, alpha, (static_cast<float>(j) + 0.5F) / (2 * kColumns),
                         (static_cast<float>(i) + 0.5F) / kRows);
      const float v_h = glm::dot(view, half);
      const float n_l = 2.0F * v_h * half.z - cosine;
      if (!(n_l > 0.0F && v_h > 0.0F)) continue;
      const float weight = seen / (seen + masking(n_l, a2) - 1.0F);
      const float grazing = pow5(1.0F - std::min(v_h, 1.0F));
      sum.normal += weight * (1.0F - grazing);
      sum.grazing += weight * grazing;
    }
  }
  constexpr float kScale = 1.0F / (kRows * kColumns);
  return {sum.normal * kScale, sum.grazing * kScale};
}

// Of a row of the table: the integral of 4 x^3 f(x), x the root of the cosine, of straight pieces.
float mean(const float (&row)[SpecularTable::kCosines]) {
  constexpr float kStep = 1.0F / (SpecularTable::kCosines - 1);
  float sum = 0.0F;
  for (int j = 0; j + 1 < SpecularTable::kCosines; ++j) {
    const float a = static_cast<float>(j) * kStep, b = a + kStep;
    const float a4 = a * a * a * a, b4 = b * b * b * b;
    const float slope = (row[j + 1] - row[j]) / kStep;
    sum += (row[j] - slope * a) * (b4 - a4) + slope * 0.8F * (b4 * b - a4 * a);
  }
  return sum;
}

SpecularTable make_table() {
  SpecularTable table;
  for (int i = 0; i < SpecularTable::kRoughnesses; ++i) {
    for (int j = 0; j < SpecularTable::kCosines; ++j) {
      const float x = static_cast<float>(j) / static_cast<float>(SpecularTable::kCosines - 1);
      const float cosine = std::max(x * x, kLeastSeen);
      const SpecularShares shares = i == 0 ? smooth(cosine) : integrate(roughness_at(i), cosine);
      table.normal[i][j] = shares.normal;
      table.grazing[i][j] = shares.grazing;
    }
    table.mean[i] = mean(table.normal[i]) + mean(table.grazing[i]);
  }
  return table;
}

}  // namespace

const SpecularTable& specular_table() {
  static const SpecularTable table = make_table();
  return table;
}

SpecularShares specular_shares_at(float roughness, int j) {
  const SpecularTable& table = specular_table();
  const float y = roughness * static_cast<float>(SpecularTable::kRoughnesses - 1);
  const int i = std::min(static_cast<int>(y), SpecularTable::kRoughnesses - 2);
  const float v = y - static_cast<float>(i);
  return {mix(table.normal[i][j], table.normal[i + 1][j], v),
          mix(table.grazing[i][j], table.grazing[i + 1][j], v)};
}

SpecularShares specular_shares(float roughness, float cosine) {
  const float x = std::sqrt(cosine) * static_cast<float>(SpecularTable::kCosines - 1);
  const int j = std::min(static_cast<int>(x), SpecularTable::kCosines - 2);
  const float u = x - static_cast<float>(j);
  const SpecularShares low = specular_shares_at(roughness, j);
  const SpecularShares high = specular_shares_at(roughness, j + 1);
  return {mix(low.normal, high.normal, u), mix(low.grazing, high.grazing, u)};
}

float mean_albedo(float roughness) {
  const SpecularTable& table = specular_table();
  const float y = roughness * static_cast<float>(SpecularTable::kRoughnesses - 1);
  const int i = std::min(static_cast<int>(y), SpecularTable::kRoughnesses - 2);
  return mix(table.mean[i], table.mean[i + 1], y - static_cast<float>(i));
}

glm::vec3 again(const glm::vec3& normal, float grazing, float mean_albedo) {
  const glm::vec3 mean =
      glm::min(normal + (glm::vec3(grazing) - normal) * (1.0F / 21.0F), glm::vec3(1.0F));
  return mean * mean_albedo / (glm::vec3(1.0F) - mean * (1.0F - mean_albedo));
}

Lobes lobes(const Surface& surface) {
  Lobes result;
  const float roughness = clamp01(surface.roughness);
  const float wide = std::max(roughness, kMinRoughness);
  result.alpha = wide * wide;
  result.roughness = roughness;
  if (surface.unlit) {
    result.grazing = result.dielectric_grazing = result.metal_grazing = 0.0F;
    return result;
  }
  const float metallic = clamp01(surface.metallic);
  result.metallic = metallic;
  result.diffuse =
      surface.base_colour * ((1.0F - metallic) * (1.0F - clamp01(surface.transmission)));
  result.dielectric = dielectric_of(surface);
  result.dielectric_grazing = grazing_of(result.dielectric) * surface.specular;
  result.metal = surface.base_colour;
  result.metal_grazing = grazing_of(result.metal);
  result.specular = result.dielectric + (result.metal - result.dielectric) * metallic;
  result.grazing = mix(result.dielectric_grazing, result.metal_grazing, metallic);
  const float mean = mean_albedo(roughness);
  result.dielectric_again = again(result.dielectric, result.dielectric_grazing, mean);
  result.metal_again = again(result.metal, result.metal_grazing, mean);
  return result;
}

Response response(const Lobes& l, float cosine) {
  const SpecularShares shares = specular_shares(l.roughness, cosine);
  const float white = shares.normal + shares.grazing;
  const float lost = (1.0F - white) / white;
  const auto once = [&](const glm::vec3& normal, float grazing) {
    return normal * shares.normal + glm::vec3(grazing * shares.grazing);
  };
  const glm::vec3 dielectric_scale = glm::vec3(1.0F) + l.dielectric_again * lost;
  const glm::vec3 metal_scale = glm::vec3(1.0F) + l.metal_again * lost;
  const glm::vec3 below = once(l.dielectric, l.dielectric_grazing) * dielectric_scale;
  const glm::vec3 metal = once(l.metal, l.metal_grazing);
  const glm::vec3 all = once(l.specular, l.grazing);
  const glm::vec3 share = metal * l.metallic / glm::max(all, glm::vec3(kLeastReflectance));
  Response result;
  result.entering = 1.0F - std::max(std::max(below.x, below.y), below.z);
  result.scale = dielectric_scale + (metal_scale - dielectric_scale) * share;
  result.specular = all * result.scale;
  return result;
}

}  // namespace delray::shading
