#include "shading/brdf.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace delray::shading {
namespace {

const glm::vec3 kNormal(0, 0, 1);

glm::vec3 above(float z, float phi) {
  const float r = std::sqrt(1.0F - z * z);
  return {r * std::cos(phi), r * std::sin(phi), z};
}

Surface random_surface(std::mt19937& random) {
  std::uniform_real_distribution<float> unit(0.0F, 1.0F);
  Surface surface;
  surface.base_colour = {unit(random), unit(random), unit(random)};
  surface.metallic = unit(random);
  surface.roughness = unit(random);
  surface.ior = 1.0F + unit(random);
  return surface;
}

double schlick(double normal, double grazing, double cosine) {
  return normal + (grazing - normal) * std::pow(1.0 - cosine, 5);
}

// GGX with height-correlated shadowing, as the papers write it, over the reflectance.
double microfacets(double alpha, const glm::dvec3& v, const glm::dvec3& l) {
  const double n_l = l.z, n_v = v.z, n_h = glm::normalize(v + l).z, a2 = alpha * alpha;
  const double distribution = a2 / (M_PI * std::pow(n_h * n_h * (a2 - 1.0) + 1.0, 2));
  const auto lambda = [&](double c) {
    return (std::sqrt(1.0 + a2 * (1.0 / (c * c) - 1.0)) - 1.0) / 2;
  };
  return distribution / (1.0 + lambda(n_l) + lambda(n_v)) / (4.0 * n_l * n_v);
}

// The integral over the hemisphere of a function of the light times its cosine, in rings that are
// narrow around the mirrored direction's height.
template <class Function>
double integral(const glm::dvec3& view, double alpha, const Function& f) {
  constexpr int kRows = 200, kColumns = 100;
  double sum = 0;
  const double top = std::acos(view.z);
  for (int i = 0; i < kRows; ++i) {
    // Steps that grow with the distance from the mirrored direction.
    const double s = 2 * (i + 0.5) / kRows - 1, width = std::max(alpha, 0.02);
    const double reach = s < 0 ? top : M_PI / 2 - top;
    const double k = std::asinh(reach / width);
    const double theta = top + width * std::sinh(k * s);
    const double step = width * k * std::cosh(k * s) * 2 / kRows;
    for (int j = 0; j < kColumns; ++j) {
      const double t = (j + 0.5) / kColumns, phi = M_PI - M_PI * t * t;  // dense there too
      const glm::dvec3 light(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                             std::cos(theta));
      sum += f(light) * light.z * std::sin(theta) * step * 2 * M_PI * t / kColumns;
    }
  }
  return 2 * sum;
}

glm::dvec3 viewer(double cosine) { return {std::sqrt(1 - cosine * cosine), 0, cosine}; }

constexpr double kRoughnesses[] = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0};
constexpr double kCosines[] = {1.0, 0.7, 0.4, 0.1};

// What a viewer gets from all directions, each of radiance 1, by reflect().
double directional_albedo(const Surface& surface, double cosine, int channel) {
  const Lobes l = lobes(surface);
  const glm::dvec3 view = viewer(cosine);
  return integral(view, l.alpha, [&](const glm::dvec3& light) {
    return reflect(l, kNormal, view, light)[channel] / light.z;
  });
}

Surface made_of(float metallic, double roughness, const glm::vec3& colour) {
  Surface surface;
  surface.base_colour = colour;
  surface.metallic = metallic;
  surface.roughness = static_cast<float>(roughness);
  return surface;
}

TEST(Brdf, MeetingASurfaceOnceIsAsThePapersSay) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> unit(0.02F, 1.0F);
  for (int i = 0; i < 20000; ++i) {
    const Surface surface = random_surface(random);
    const Lobes l = lobes(surface);
    const glm::vec3 v = above(unit(random), 6.0F * unit(random));
    // Near the mirrored direction too, where the highlight is.
    glm::vec3 light = above(unit(random), 6.0F * unit(random));
    if (i % 2 == 0) light = glm::normalize(glm::vec3(-v.x, -v.y, v.z) + light * 0.05F);
    Response once = response(l, v.z);
    once.scale = glm::vec3(1.0F);
    const glm::vec3 got = reflect(l, once, kNormal, v, light);
    const double v_h = glm::dot(v, glm::normalize(v + light));
    for (int k = 0; k < 3; ++k) {
      const double specular =
          schlick(l.specular[k], l.grazing, v_h) * microfacets(l.alpha, v, light);
      const double expected = (l.diffuse[k] * once.entering / M_PI + specular) * light.z;
      ASSERT_NEAR(got[k], expected, 2e-3 * expected + 1e-6) << "seed 2, try " << i;
    }
  }
}

TEST(Brdf, WhiteSurfacesLoseNothing) {
  for (const double roughness : kRoughnesses) {
    for (const double cosine : kCosines) {
      for (const float metallic : {0.0F, 0.5F, 1.0F}) {
        const Surface surface = made_of(metallic, roughness, glm::vec3(1.0F));
        EXPECT_NEAR(directional_albedo(surface, cosine, 0), 1.0, 0.02)
            << metallic << " " << roughness << " " << cosine;
      }
    }
  }
}

// The reference adds a lobe for all further meetings (Kulla and Conty 2017).
TEST(Brdf, EachLobeReflectsWhatTheSeriesOfMeetingsSays) {
  const glm::vec3 colours[] = {{1.0F, 0.78F, 0.34F}, {0.8F, 0.5F, 0.2F}};
  for (const double roughness : kRoughnesses) {
    const double alpha = roughness * roughness;
    const auto once = [&](double cosine, double normal, double grazing) {
      const glm::dvec3 view = viewer(cosine);
      return integral(view, alpha, [&](const glm::dvec3& light) {
        const double v_h = std::min(1.0, glm::dot(view, glm::normalize(view + light)));
        return schlick(normal, grazing, v_h) * microfacets(alpha, view, light);
      });
    };
    double mean_albedo = 0;  // of a white lobe, over all viewers
    for (int i = 0; i < 12; ++i) mean_albedo += once((i + 0.5) / 12, 1, 1) * 2 * (i + 0.5) / 144;
    const auto albedo = [&](double cosine, double normal, double grazing) {
      const double f = normal + (grazing - normal) / 21;
      const double again =
          f * f * mean_albedo / (1 - f * (1 - mean_albedo)) * (1 - once(cosine, 1, 1));
      return once(cosine, normal, grazing) + again;
    };
    for (const double cosine : kCosines) {
      for (const glm::vec3& colour : colours) {
        Surface metal = made_of(1.0F, roughness, colour);
        const double f90 = lobes(metal).grazing;
        for (int k = 0; k < 3; ++k) {
          EXPECT_NEAR(directional_albedo(metal, cosine, k), albedo(cosine, colour[k], f90), 0.02)
              << roughness << " " << cosine << " " << colour[k];
        }
        // Under a dielectric lobe what is left of the colour.
        const Surface plastic = made_of(0.0F, roughness, colour);
        const double mirrored = albedo(cosine, 0.04, 1);
        for (int k = 0; k < 3; ++k) {
          EXPECT_NEAR(directional_albedo(plastic, cosine, k), mirrored + (1 - mirrored) * colour[k],
                      0.02)
              << roughness << " " << cosine << " " << colour[k];
        }
      }
    }
  }
}

TEST(Brdf, ResponseIsWhatReflectAddsUpTo) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(0.02F, 1.0F);
  for (int i = 0; i < 60; ++i) {
    Surface surface = random_surface(random);
    surface.roughness = 0.1F + 0.9F * unit(random);
    const double cosine = unit(random);
    const Response all = response(lobes(surface), static_cast<float>(cosine));
    for (int k = 0; k < 3; ++k) {
      const double expected = all.specular[k] + lobes(surface).diffuse[k] * all.entering;
      EXPECT_NEAR(directional_albedo(surface, cosine, k), expected, 0.02) << "seed 3, try " << i;
      EXPECT_LE(expected, 1.001);
    }
  }
}

TEST(Brdf, LambertianLimitIsAlbedoOverPi) {
  Surface surface;
  surface.base_colour = {0.5F, 0.25F, 1.0F};
  surface.ior = 1.0F;
  const glm::vec3 got = reflect(lobes(surface), kNormal, above(0.4F, 1.0F), above(0.8F, 2.0F));
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(got[k], surface.base_colour[k] / M_PI * 0.8, 1e-6);
}

TEST(Brdf, BelowTheHorizonIsDark) {
  const Lobes l = lobes(Surface{});
  EXPECT_EQ(reflect(l, kNormal, kNormal, {0, 0, -1}), glm::vec3(0.0F));
  EXPECT_EQ(reflect(l, kNormal, kNormal, {1, 0, 0}), glm::vec3(0.0F));
  const glm::vec3 grazing = reflect(l, kNormal, {1, 0, 0}, {-1, 0, 1e-4F});
  for (int k = 0; k < 3; ++k) EXPECT_TRUE(std::isfinite(grazing[k]));
  const glm::vec3 opposite = reflect(l, kNormal, {0, 0, -1}, {0, 0, 1});
  for (int k = 0; k < 3; ++k) EXPECT_TRUE(std::isfinite(opposite[k]));
}

TEST(Brdf, BlackMetalAndMatchedGlassReflectNothing) {
  Surface metal;
  metal.base_colour = glm::vec3(0.0F);
  metal.metallic = 1.0F;
  EXPECT_EQ(reflect(lobes(metal), kNormal, kNormal, above(0.3F, 0)), glm::vec3(0.0F));
  Surface glass;
  glass.ior = 1.0F;
  glass.transmission = 1.0F;
  EXPECT_EQ(reflect(lobes(glass), kNormal, above(0.1F, 0), above(0.1F, 3.14F)), glm::vec3(0.0F));
}

}  // namespace
}  // namespace delray::shading
