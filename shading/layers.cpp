// Clear coat and sheen: values by formula, what they reflect in all by tables.
#include "shading/layers.h"

#include "shading/lanes/specular_table.h"

namespace delray::shading {
namespace {

constexpr float kCoatReflectance = 0.04F;  // head-on, of index 1.5

// Fibres stand no straighter than this: the lobe would be a line along the horizon.
constexpr float kMinSheenRoughness = 0.07F;

float exponent_of(float roughness) {
  const float wide = std::max(roughness, kMinSheenRoughness);
  return 1.0F / (wide * wide);
}

// Of a white sheen, times the cosine to the light. `sum` is view + light.
float sheen_value(float exponent, float n_l, float n_v, const glm::vec3& normal,
                  const glm::vec3& sum) {
  const float length2 = std::max(glm::dot(sum, sum), kLeastSum);
  const float along = glm::dot(normal, sum);
  const float sine2 = std::max(length2 - along * along, 0.0F) / length2;
  const float distribution = (2.0F + exponent) * (0.5F * kInversePi) * pow(sine2, 0.5F * exponent);
  return distribution * n_l / (4.0F * (n_l + n_v - n_l * n_v));
}

// Element [i][j]: what a white sheen of roughness i / (kRoughnesses - 1) reflects of light from
// everywhere to a viewer at the j-th cosine of SpecularTable.
struct SheenTable {
  static constexpr int kRoughnesses = 32, kCosines = SpecularTable::kCosines;
  float albedo[kRoughnesses][kCosines];
};

float integrate_sheen(float exponent, float cosine) {
  constexpr int kRows = 64, kColumns = 16;
  const glm::vec3 normal(0, 0, 1), view(std::sqrt(1.0F - cosine * cosine), 0.0F, cosine);
  float sum = 0.0F;
  for (int i = 0; i < kRows; ++i) {
    // The lobe is strongest low over the horizon: rows lie dense there.
    const float x = (static_cast<float>(i) + 0.5F) / kRows;
    const float z = x * x, sine = std::sqrt(1.0F - z * z);
    for (int j = 0; j < kColumns; ++j) {
      const SinCos phi = sin_cos(kPi * (static_cast<float>(j) + 0.5F) / kColumns);
      const glm::vec3 light(sine * phi.cos, sine * phi.sin, z);
      sum += 2.0F * x * sheen_value(exponent, z, cosine, normal, view + light);
    }
  }
  return sum * (2.0F * kPi / (kRows * kColumns));
}

SheenTable make_sheen_table() {
  SheenTable table;
  for (int i = 0; i < SheenTable::kRoughnesses; ++i) {
    const float roughness = static_cast<float>(i) / (SheenTable::kRoughnesses - 1);
    for (int j = 0; j < SheenTable::kCosines; ++j) {
      const float x = static_cast<float>(j) / (SheenTable::kCosines - 1);
      const float cosine = std::max(x * x, 1e-3F);
      table.albedo[i][j] = integrate_sheen(exponent_of(roughness), cosine);
    }
  }
  return table;
}

float sheen_albedo(float roughness, float cosine) {
  static const SheenTable table = make_sheen_table();
  const float y = roughness * static_cast<float>(SheenTable::kRoughnesses - 1);
  const int i = std::min(static_cast<int>(y), SheenTable::kRoughnesses - 2);
  const float x = std::sqrt(cosine) * static_cast<float>(SheenTable::kCosines - 1);
  const int j = std::min(static_cast<int>(x), SheenTable::kCosines - 2);
  const float u = x - static_cast<float>(j), v = y - static_cast<float>(i);
  return mix(mix(table.albedo[i][j], table.albedo[i + 1][j], v),
             mix(table.albedo[i][j + 1], table.albedo[i + 1][j + 1], v), u);
}

void add_coat(const Surface& surface, const glm::vec3& view, Layers& layers) {
  const float roughness = clamp01(surface.clearcoat_roughness);
  const float weight = clamp01(surface.clearcoat);
  const float wide = std::max(roughness, kMinRoughness);
  layers.coat_alpha = wide * wide;
  layers.coat_roughness = roughness;
  layers.coat_normal = surface.coat_normal;
  const float cosine = clamp01(glm::dot(surface.coat_normal, view));
  const SpecularShares shares = specular_shares(roughness, cosine);
  const float once = kCoatReflectance * shares.normal + shares.grazing;
  const float white = shares.normal + shares.grazing;
  const float further = again(glm::vec3(kCoatReflectance), 1.0F, mean_albedo(roughness)).x;
  const float scale = 1.0F + further * ((1.0F - white) / white);
  layers.coat = weight * scale;
  layers.coat_albedo = weight * (once * scale);
  layers.below_coat = 1.0F - layers.coat_albedo;
}

void add_sheen(const Surface& surface, const glm::vec3& view, Layers& layers) {
  const float roughness = clamp01(surface.sheen_roughness);
  const float albedo = sheen_albedo(roughness, clamp01(glm::dot(surface.normal, view)));
  // The lobe would give more than it gets to some grazing viewers.
  const float most = std::max(albedo, 1.0F);
  layers.sheen_exponent = exponent_of(roughness);
  layers.sheen = surface.sheen_colour * (layers.below_coat / most);
  layers.sheen_albedo = layers.sheen * albedo;
  const glm::vec3& colour = surface.sheen_colour;
  const float brightest = std::max(std::max(colour.x, colour.y), colour.z);
  layers.below = layers.below_coat * (1.0F - clamp01(brightest) * (albedo / most));
}

}  // namespace

Layers layers(const Surface& surface, const glm::vec3& view) {
  Layers result;
  if (surface.clearcoat > 0.0F) add_coat(surface, view, result);
  result.below = result.below_coat;
  if (surface.sheen_colour != glm::vec3(0.0F)) add_sheen(surface, view, result);
  return result;
}

float coat_fresnel(float cosine) {
  return kCoatReflectance + (1.0F - kCoatReflectance) * pow5(1.0F - cosine);
}

float reflect_by_coat(const Layers& layers, const glm::vec3& view, const glm::vec3& light) {
  const float n_l = glm::dot(layers.coat_normal, light);
  if (!(layers.coat > 0.0F && n_l > 0.0F)) return 0.0F;
  const float n_v = std::max(glm::dot(layers.coat_normal, view), kLeastCosine);
  const glm::vec3 sum = view + light;
  const float along = std::max(glm::dot(layers.coat_normal, sum), 0.0F);
  const Peak peak = ggx_peak(layers.coat_alpha, n_l, n_v, sum, along);
  return layers.coat * coat_fresnel(peak.v_h) * peak.value * n_l;
}

glm::vec3 reflect_by_sheen(const Layers& layers, const glm::vec3& normal, const glm::vec3& view,
                           const glm::vec3& light) {
  const float n_l = glm::dot(normal, light);
  if (layers.sheen == glm::vec3(0.0F) || !(n_l > 0.0F)) return glm::vec3(0.0F);
  const float n_v = std::max(glm::dot(normal, view), kLeastCosine);
  return layers.sheen * sheen_value(layers.sheen_exponent, n_l, n_v, normal, view + light);
}

glm::vec3 reflect(const Layers& layers, const glm::vec3& normal, const glm::vec3& view,
                  const glm::vec3& light) {
  return glm::vec3(reflect_by_coat(layers, view, light)) +
         reflect_by_sheen(layers, normal, view, light);
}

}  // namespace delray::shading
