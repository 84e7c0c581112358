// The directional albedo of rough dielectric interfaces (Walter et al. 2007), tabulated as Turquin
// (2019) does: scaled by its inverse they lose nothing. Microscopic normals are drawn as the viewer
// sees them; each gives its share of masking and shadowing.
#include "raytrace/sampling/glass_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>

#include "raytrace/sampling/optics.h"
#include "shading/brdf.h"
#include "shading/microfacets.h"

namespace delray::raytrace {
namespace {

using shading::masking;
using shading::mix;

// Of (ratio - 1) / (ratio + 1), which is the root of the reflectance head-on.
constexpr float kReach = 0.5F;

constexpr int kRatios = 33, kRoughnesses = 16, kCosines = 17;

// The cosine is the square of j / (kCosines - 1).
using Sheet = std::array<std::array<float, kCosines>, kRoughnesses>;

struct Sheets {
  Sheet glass, pane;
};

// The fractions that glass of a ratio, and a pane, leave.
struct Albedos {
  float glass = 0.0F, pane = 0.0F;
};

Albedos integrate(float ratio, float roughness, float cosine) {
  constexpr int kRows = 16, kColumns = 16;
  const float alpha = roughness * roughness, a2 = alpha * alpha;
  const glm::vec3 view(std::sqrt(1.0F - cosine * cosine), 0.0F, cosine);
  const float seen = masking(cosine, a2);
  Albedos sum;
  for (int i = 0; i < kRows; ++i) {
    for (int j = 0; j < kColumns; ++j) {
      const glm::vec3 half =
          shading::visible_normal(view, alpha, (static_cast<float>(j) + 0.5F) / (2 * kColumns),
                                  (static_cast<float>(i) + 0.5F) / kRows);
      const Refraction bent = refracted(view, half, ratio);
      const float up = mirrored(view, half).z;
      if (up > 0.0F) {
        const float left = seen / (seen + masking(up, a2) - 1.0F);
        sum.glass += bent.reflected * left;
        sum.pane += left;
      }
      const float down = -bent.direction.z;
      if (bent.reflected < 1.0F && down > 0.0F) {
        sum.glass += (1.0F - bent.reflected) * seen / (seen + masking(down, a2) - 1.0F);
      }
    }
  }
  return {sum.glass / (kRows * kColumns), sum.pane / (kRows * kColumns)};
}

Sheets make_sheets(float ratio) {
  Sheets sheets;
  for (int i = 0; i < kRoughnesses; ++i) {
    const float roughness = static_cast<float>(i) / (kRoughnesses - 1);
    for (int j = 0; j < kCosines; ++j) {
      const float root = static_cast<float>(j) / (kCosines - 1);
      const Albedos albedos = integrate(ratio, std::max(roughness, shading::kMinRoughness),
                                        std::max(root * root, 1e-3F));
      sheets.glass[i][j] = albedos.glass;
      sheets.pane[i][j] = albedos.pane;
    }
  }
  return sheets;
}

// Of the k-th of kRatios ratios from 1/3 to 3, in equal steps of (ratio - 1) / (ratio + 1). Made
// when they are asked for: few scenes have glass of more than one kind.
const Sheets& sheets(int k) {
  static std::array<std::once_flag, kRatios> made;
  static std::array<Sheets, kRatios> all;
  std::call_once(made[k], [k] {
    const float x = kReach * (2.0F * static_cast<float>(k) / (kRatios - 1) - 1.0F);
    all[k] = make_sheets((1.0F + x) / (1.0F - x));
  });
  return all[k];
}

// A place between two elements of a dimension.
struct Place {
  int low;
  float rest;
};

Place place(float x, int count) {
  const float at = shading::clamp01(x) * static_cast<float>(count - 1);
  const int low = std::min(static_cast<int>(at), count - 2);
  return {low, at - static_cast<float>(low)};
}

float between(const Sheet& sheet, const Place& roughness, const Place& cosine) {
  const auto row = [&](int i) {
    return mix(sheet[i][cosine.low], sheet[i][cosine.low + 1], cosine.rest);
  };
  return mix(row(roughness.low), row(roughness.low + 1), roughness.rest);
}

}  // namespace

float glass_albedo(float ratio, float roughness, float cosine) {
  const float x = (ratio - 1.0F) / (ratio + 1.0F);
  const Place z = place(0.5F * (x / kReach + 1.0F), kRatios);
  const Place r = place(roughness, kRoughnesses);
  const Place c = place(std::sqrt(cosine), kCosines);
  return mix(between(sheets(z.low).glass, r, c), between(sheets(z.low + 1).glass, r, c), z.rest);
}

float pane_albedo(float roughness, float cosine) {
  return between(sheets(kRatios / 2).pane, place(roughness, kRoughnesses),
                 place(std::sqrt(cosine), kCosines));
}

}  // namespace delray::raytrace
