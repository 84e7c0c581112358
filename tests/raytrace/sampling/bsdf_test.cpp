#include "raytrace/sampling/bsdf.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <vector>

#include "raytrace/sampling/optics.h"
#include "raytrace/sampling/sampler.h"
#include "shading/shade.h"
#include "tests/support/targets.h"

namespace delray::raytrace {
namespace {

using shading::Surface;

struct Named {
  std::string name;
  Surface surface;
  bool thin = false;
};

Surface made_of(float metallic, float roughness, float transmission, float ior, bool front,
                const glm::vec3& colour) {
  Surface s;
  s.metallic = metallic;
  s.roughness = roughness;
  s.transmission = transmission;
  s.ior = ior;
  s.front = front;
  s.base_colour = colour;
  return s;
}

using shading::kBlockPoints;

// One surface, in all lanes of Bsdfs: as many directions are looked at at once.
struct Bsdf {
  Bsdfs all;
  float ratio() const { return all.ratio[0]; }
};

shading::Surfaces sixteen(const Surface& surface, const glm::vec3& view, bool thin = false) {
  const shading::Seen seen = shading::seen_from(surface, view);
  const shading::Lobes& lobes = seen.lobes;
  shading::Surfaces s;
  if (thin) s.thin = shading::kAllLanes;
  if (surface.clearcoat > 0 || surface.sheen_colour != glm::vec3(0.0F)) {
    s.layered = shading::kAllLanes;
  }
  for (int i = 0; i < kBlockPoints; ++i) {
    s.geometric_normal.set(i, surface.geometric_normal);
    s.normal.set(i, surface.normal);
    s.front[i] = surface.front ? -1 : 0;
    s.base_colour.set(i, surface.base_colour);
    s.metallic[i] = surface.metallic;
    s.roughness[i] = surface.roughness;
    s.transmission[i] = surface.transmission;
    s.ior[i] = surface.ior;
    s.diffuse.set(i, lobes.diffuse);
    s.entering[i] = seen.response.entering;
    s.scale.set(i, seen.response.scale);
    s.layers[i] = seen.layers;
    s.specular.set(i, lobes.specular);
    s.grazing[i] = lobes.grazing;
    s.lobe_alpha[i] = lobes.alpha;
    s.lobe_roughness[i] = lobes.roughness;
    s.mirrored.set(i, seen.response.specular);
  }
  return s;
}

Bsdf make_bsdf(const Surface& surface, const glm::vec3& view, bool thin = false) {
  shading::Vectors16 views;
  for (int i = 0; i < kBlockPoints; ++i) views.set(i, view);
  Bsdf bsdf;
  make_bsdfs(sixteen(surface, view, thin), views, shading::kAllLanes, bsdf.all);
  return bsdf;
}
Bsdf make_bsdf(const Named& m, const glm::vec3& view) { return make_bsdf(m.surface, view, m.thin); }

struct Value {
  glm::vec3 value{0.0F};
  float pdf = 0.0F;
};

Value evaluate(const Bsdf& bsdf, const glm::vec3& light) {
  shading::Vectors16 lights;
  lights.set(0, light);
  BsdfValues values;
  evaluate(bsdf.all, lights, 1, values);
  return {values.value.get(0), values.pdf[0]};
}

struct Sample {
  glm::vec3 direction{0.0F}, weight{0.0F};
  float pdf = 0.0F;
  bool delta = false, transmitted = false;
};

Sample sample(const Bsdf& bsdf, float lobe, const glm::vec2& u) {
  shading::Floats16 lobes, x, y;
  lobes[0] = lobe, x[0] = u.x, y[0] = u.y;
  BsdfSamples samples;
  sample(bsdf.all, lobes, x, y, 1, samples);
  const glm::vec3 weight = samples.weight.get(0);
  return {samples.direction.get(0), weight, samples.pdf[0],
          samples.pdf[0] == 0.0F && weight != glm::vec3(0.0F), (samples.transmitted & 1) != 0};
}

Surface coated(float clearcoat, float roughness, const glm::vec3& colour) {
  Surface s = made_of(0.5F, 0.6F, 0, 1.5F, true, colour);
  s.clearcoat = clearcoat;
  s.clearcoat_roughness = roughness;
  return s;
}

// Materials of every kind, their normals along z.
std::vector<Named> materials(const glm::vec3& colour) {
  std::vector<Named> all;
  for (const float roughness : {0.35F, 0.6F, 1.0F}) {
    const std::string r = " " + std::to_string(roughness);
    all.push_back({"plastic" + r, made_of(0, roughness, 0, 1.5F, true, colour)});
    all.push_back({"metal" + r, made_of(1, roughness, 0, 1.5F, true, colour)});
    all.push_back({"half metal" + r, made_of(0.5F, roughness, 0, 1.5F, true, colour)});
    all.push_back({"glass" + r, made_of(0, roughness, 1, 1.5F, true, colour)});
    all.push_back({"glass from inside" + r, made_of(0, roughness, 1, 1.5F, false, colour)});
    all.push_back({"half glass" + r, made_of(0.2F, roughness, 0.5F, 1.3F, true, colour)});
    all.push_back({"thin air" + r, made_of(0, roughness, 1, 1.0F, true, colour)});
    all.push_back({"pane" + r, made_of(0, roughness, 1, 1.5F, true, colour), true});
    all.push_back({"varnished" + r, coated(1.0F, roughness, colour)});
    all.push_back({"varnished by half" + r, coated(0.5F, 0.0F, colour)});
    Named cloth{"cloth" + r, made_of(0, 0.8F, 0, 1.5F, true, colour)};
    cloth.surface.sheen_colour = colour;
    cloth.surface.sheen_roughness = roughness;
    all.push_back(cloth);
  }
  return all;
}

glm::vec3 direction(float z, float phi) {
  const float r = std::sqrt(std::max(0.0F, 1.0F - z * z));
  return {r * std::cos(phi), r * std::sin(phi), z};
}

glm::vec3 uniform_direction(std::mt19937& random) {
  std::uniform_real_distribution<float> unit(0.0F, 1.0F);
  return direction(2.0F * unit(random) - 1.0F, 2.0F * static_cast<float>(M_PI) * unit(random));
}

TEST(Bsdf, IsWhatShadingReflectsWhereNothingIsGlass) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> unit(0.0F, 1.0F);
  for (int i = 0; i < 20000; ++i) {
    Surface s = made_of(unit(random), 0.09F + 0.91F * unit(random), 0.0F, 1.0F + unit(random), true,
                        {unit(random), unit(random), unit(random)});
    s.normal = s.geometric_normal = uniform_direction(random);
    glm::vec3 v = uniform_direction(random), l = uniform_direction(random);
    if (glm::dot(v, s.normal) < 0) v = -v;
    if (glm::dot(l, s.normal) < 0) l = -l;
    if (glm::dot(v, s.normal) < 0.01F || glm::dot(l, s.normal) < 0.01F) continue;
    if (i % 2 == 0) l = glm::normalize(mirrored(v, s.normal) + 0.05F * l);
    const glm::vec3 expected = shading::reflect(shading::lobes(s), s.normal, v, l);
    const Value got = evaluate(make_bsdf(s, v), l);
    for (int k = 0; k < 3; ++k) {
      ASSERT_NEAR(got.value[k], expected[k], 2e-3F * expected[k] + 1e-5F) << "seed 1, try " << i;
    }
  }
}

void leave_one_meeting(Bsdf& bsdf) {
  for (int i = 0; i < kBlockPoints; ++i) {
    bsdf.all.scale.set(i, glm::vec3(1.0F));
    bsdf.all.diffuse.set(i, glm::vec3(0.0F));
    bsdf.all.glass_scale[i] = 1.0F;
  }
}

// What compensates for further meetings looks at the viewer alone.
TEST(Bsdf, MeetingASurfaceOnceIsReciprocal) {
  std::mt19937 random(2);
  for (const Named& m : materials({0.9F, 0.5F, 0.2F})) {
    if (m.surface.clearcoat > 0 || m.surface.sheen_colour != glm::vec3(0.0F)) continue;
    for (int i = 0; i < 300; ++i) {
      glm::vec3 a = uniform_direction(random), b = uniform_direction(random);
      a.z = std::max(std::abs(a.z), 0.05F);
      a = glm::normalize(a);
      if (std::abs(b.z) < 0.05F) continue;
      Bsdf from_a = make_bsdf(m, a);
      const bool through = b.z < 0;
      Surface other = m.surface;
      if (through) {
        other.front = m.thin || !other.front;
        other.normal = other.geometric_normal = {0, 0, -1};
      }
      Bsdf from_b = make_bsdf(other, b, m.thin);
      leave_one_meeting(from_a);
      leave_one_meeting(from_b);
      const glm::vec3 ab = evaluate(from_a, b).value / std::abs(b.z);
      const glm::vec3 ba = evaluate(from_b, a).value / std::abs(a.z);
      // Over the squares of the indices on the light's sides.
      const float scale = through && !m.thin ? from_a.ratio() * from_a.ratio() : 1.0F;
      for (int k = 0; k < 3; ++k) {
        ASSERT_NEAR(ab[k] * scale, ba[k], 2e-3F * ba[k] + 1e-5F)
            << m.name << (through ? " through" : "") << ", seed 2, try " << i;
      }
    }
  }
}

constexpr int kBinRows = 16, kBinColumns = 24, kBins = kBinRows * kBinColumns;

int bin_of(const glm::vec3& d) {
  const int row = std::min(kBinRows - 1, static_cast<int>((d.z * 0.5F + 0.5F) * kBinRows));
  const double turn = std::atan2(d.y, d.x) / (2 * M_PI) + 0.5;
  return row * kBinColumns + std::min(kBinColumns - 1, static_cast<int>(turn * kBinColumns));
}

// What pdf says, bin by bin.
std::vector<double> expected_bins(const Bsdf& bsdf) {
  constexpr int kFine = 12;
  std::vector<double> bins(kBins, 0.0);
  for (int i = 0; i < kBinRows * kFine; ++i) {
    const auto z = static_cast<float>((i + 0.5) / (kBinRows * kFine) * 2 - 1);
    for (int first = 0; first < kBinColumns * kFine; first += kBlockPoints) {
      shading::Vectors16 lights;
      for (int k = 0; k < kBlockPoints; ++k) {
        const double turn = (first + k + 0.5) / (kBinColumns * kFine);
        lights.set(k, direction(z, static_cast<float>(turn * 2 * M_PI - M_PI)));
      }
      BsdfValues values;
      evaluate(bsdf.all, lights, shading::kAllLanes, values);
      for (int k = 0; k < kBlockPoints; ++k) {
        bins[static_cast<std::size_t>(i / kFine) * kBinColumns +
             static_cast<std::size_t>((first + k) / kFine)] +=
            values.pdf[k] * 4 * M_PI / (kBins * kFine * kFine);
      }
    }
  }
  return bins;
}

TEST(Bsdf, SamplesAreDistributedAsTheirDensitySays) {
  constexpr int kSamples = 20000;
  for (const Named& m : materials({0.9F, 0.5F, 0.2F})) {
    for (const float z : {0.9F, 0.3F}) {
      const Bsdf bsdf = make_bsdf(m, direction(z, 0.7F));
      const std::vector<double> expected = expected_bins(bsdf);
      std::vector<double> found(kBins, 0.0);
      std::mt19937 random(3);
      std::uniform_real_distribution<float> unit(0.0F, 1.0F);
      double lost = 0, deltas = 0;
      for (int i = 0; i < kSamples; ++i) {
        const Sample s = sample(bsdf, unit(random), {unit(random), unit(random)});
        if (s.delta) {
          ++deltas;
        } else if (s.pdf > 0) {
          ASSERT_NEAR(glm::length(s.direction), 1.0F, 1e-4F);
          ASSERT_NEAR(s.pdf / evaluate(bsdf, s.direction).pdf, 1.0F, 1e-3F);
          found[static_cast<std::size_t>(bin_of(s.direction))] += 1;
        } else {
          ++lost;
        }
      }
      double chi2 = 0, mass = 0, rest_found = 0, rest_expected = 0;
      int freedom = 0;
      for (int b = 0; b < kBins; ++b) {
        const double e = expected[static_cast<std::size_t>(b)] * kSamples;
        mass += e / kSamples;
        if (e < 10) {
          rest_found += found[static_cast<std::size_t>(b)], rest_expected += e;
          continue;
        }
        chi2 += std::pow(found[static_cast<std::size_t>(b)] - e, 2) / e;
        ++freedom;
      }
      if (rest_expected > 10) {
        chi2 += std::pow(rest_found - rest_expected, 2) / rest_expected;
        ++freedom;
      }
      // What is not drawn is what is reflected below the horizon.
      const double missing = (lost + deltas) / kSamples;
      EXPECT_NEAR(mass, 1.0 - missing, 0.02) << m.name << " " << z;
      EXPECT_LT(missing - deltas / kSamples, 0.5) << m.name << " " << z;
      if (freedom == 0) continue;  // nothing but deltas
      EXPECT_LT(chi2, freedom + 5 * std::sqrt(2.0 * freedom)) << m.name << " " << z;
    }
  }
}

glm::dvec3 albedo(const Bsdf& bsdf, std::uint32_t samples) {
  const std::uint64_t pixel = pixel_key(5, 0, 0);
  glm::dvec3 sum(0);
  for (std::uint32_t i = 0; i < samples; ++i) {
    Sampler sampler(pixel, i);
    const float lobe = sampler.one();
    sum += glm::dvec3(sample(bsdf, lobe, sampler.two()).weight);
  }
  return sum / static_cast<double>(samples);
}

TEST(Bsdf, SamplesIntegrateToWhatQuadratureSays) {
  for (const Named& m : materials({0.9F, 0.5F, 0.2F})) {
    for (const float z : {1.0F, 0.4F}) {
      const Bsdf bsdf = make_bsdf(m, direction(z, 0.7F));
      const bool varnished = m.surface.clearcoat > 0;
      const bool delta = varnished && m.surface.clearcoat_roughness < shading::kMinRoughness;
      if (bsdf.all.straight != 0 || delta) continue;
      glm::dvec3 integral(0);
      // Rings of equal width: what passes head-on is a narrow lobe.
      constexpr int kFine = 400, kAround = 208;
      for (int i = 0; i < kFine; ++i) {
        const double theta = (i + 0.5) / kFine * M_PI;
        for (int first = 0; first < kAround; first += kBlockPoints) {
          shading::Vectors16 lights;
          for (int k = 0; k < kBlockPoints; ++k) {
            const double turn = (first + k + 0.5) / kAround;
            lights.set(k, direction(static_cast<float>(std::cos(theta)),
                                    static_cast<float>(turn * 2 * M_PI)));
          }
          BsdfValues values;
          evaluate(bsdf.all, lights, shading::kAllLanes, values);
          for (int k = 0; k < kBlockPoints; ++k) {
            integral += glm::dvec3(values.value.get(k)) * std::sin(theta);
          }
        }
      }
      integral *= M_PI / kFine * 2 * M_PI / kAround;
      const glm::dvec3 sampled = albedo(bsdf, 16384);
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(sampled[k], integral[k], 0.01) << m.name << " " << z;
    }
  }
}

TEST(Bsdf, WhiteMaterialsReturnWhatTheyGet) {
  std::vector<Named> all = materials(glm::vec3(1.0F));
  for (const bool front : {true, false}) {
    all.push_back({"mirror", made_of(1, 0, 0, 1.5F, front, glm::vec3(1.0F))});
    all.push_back({"clear glass", made_of(0, 0, 1, 1.5F, front, glm::vec3(1.0F))});
    all.push_back({"varnish", made_of(0, 0, 0, 1.5F, front, glm::vec3(1.0F))});
    all.push_back({"narrow metal", made_of(1, 0.1F, 0, 1.5F, front, glm::vec3(1.0F))});
  }
  for (const Named& m : all) {
    for (const float z : {1.0F, 0.7F, 0.3F, 0.05F}) {
      const double a = albedo(make_bsdf(m, direction(z, 0.7F)), 8192).x;
      EXPECT_LT(a, 1.02) << m.name << " " << z;
      EXPECT_GT(a, m.surface.metallic * m.surface.transmission > 0 ? 0.9 : 0.98)
          << m.name << " " << z;
      if (m.surface.roughness == 0.0F && (m.surface.metallic == 1 || m.surface.transmission == 1)) {
        EXPECT_NEAR(a, 1.0, 1e-3) << m.name << " " << z;  // neither loses anything
      }
    }
  }
}

TEST(Bsdf, SmoothGlassHasTwoDirections) {
  const glm::vec3 view = direction(0.6F, 1.0F), normal(0, 0, 1);
  for (const bool front : {true, false}) {
    const Bsdf bsdf = make_bsdf(made_of(0, 0, 1, 1.5F, front, {0.9F, 0.5F, 0.2F}), view);
    const Refraction bent = refracted(view, normal, front ? 1 / 1.5F : 1.5F);
    int reflections = 0;
    for (int i = 0; i < 1000; ++i) {
      const Sample s = sample(bsdf, (static_cast<float>(i) + 0.5F) / 1000, {0.3F, 0.8F});
      ASSERT_TRUE(s.delta);
      ASSERT_EQ(s.pdf, 0.0F);
      reflections += s.transmitted ? 0 : 1;
      const glm::vec3 expected = s.transmitted ? bent.direction : mirrored(view, normal);
      ASSERT_LT(glm::length(s.direction - expected), 1e-5F);
      ASSERT_EQ(evaluate(bsdf, s.direction).value, glm::vec3(0.0F));
    }
    if (front) {
      const float passed = 1.6F / 3 * (1 - bent.reflected);
      EXPECT_NEAR(reflections, 1000 * bent.reflected / (bent.reflected + passed), 3);
    } else {
      EXPECT_EQ(reflections, 1000);  // beyond the critical angle
    }
  }
}

TEST(Bsdf, NoLightLeaksThroughTheGeometricSurface) {
  std::mt19937 random(4);
  std::uniform_real_distribution<float> unit(0.0F, 1.0F);
  for (int i = 0; i < 20000; ++i) {
    Surface s = made_of(unit(random), unit(random), i % 2 == 0 ? 1.0F : 0.0F, 1.5F, i % 3 == 0,
                        glm::vec3(0.8F));
    s.normal = glm::normalize(s.geometric_normal + 0.9F * uniform_direction(random));
    glm::vec3 view = uniform_direction(random);
    if (view.z < 0) view = -view;  // on the geometric side, perhaps below the shading normal
    const Bsdf bsdf = make_bsdf(s, view);
    ASSERT_GT(bsdf.all.view.z[0], 0.0F);
    const Sample got = sample(bsdf, unit(random), {unit(random), unit(random)});
    for (int k = 0; k < 3; ++k) ASSERT_TRUE(got.weight[k] >= 0.0F && got.weight[k] < 100.0F);
    if (got.weight == glm::vec3(0.0F)) continue;
    ASSERT_EQ(got.direction.z < 0, got.transmitted) << "seed 4, try " << i;
  }
}

void copy_lane(const shading::Surfaces& from, int i, shading::Surfaces& to) {
  // Up to the masks there is nothing but arrays of 16.
  constexpr std::size_t kArrays = offsetof(shading::Surfaces, thin) / sizeof(shading::Floats16);
  for (std::size_t f = 0; f < kArrays; ++f) {
    reinterpret_cast<shading::Floats16*>(&to)[f][i] =
        reinterpret_cast<const shading::Floats16*>(&from)[f][i];
  }
  to.thin |= from.thin & 1U << i;
  to.layered |= from.layered & 1U << i;
  to.layers[i] = from.layers[i];
}

TEST(Bsdf, IsTheSameOnEveryInstructionSetInEveryLane) {
  std::mt19937 random(6);
  std::uniform_real_distribution<float> unit(0.0F, 1.0F);
  std::vector<Named> all = materials({0.9F, 0.5F, 0.2F});
  all.push_back({"clear glass", made_of(0, 0, 1, 1.5F, true, glm::vec3(1.0F))});
  for (int attempt = 0; attempt < 200; ++attempt) {
    shading::Surfaces surfaces;
    shading::Vectors16 views, lights;
    shading::Floats16 lobes, x, y;
    for (int i = 0; i < kBlockPoints; ++i) {
      glm::vec3 view = uniform_direction(random);
      view.z = std::abs(view.z);
      const Named& m = all[random() % all.size()];
      Surface s = m.surface;
      s.normal = glm::normalize(s.geometric_normal + 0.5F * uniform_direction(random));
      copy_lane(sixteen(s, view, m.thin), i, surfaces);
      views.set(i, view);
      lights.set(i, uniform_direction(random));
      lobes[i] = unit(random), x[i] = unit(random), y[i] = unit(random);
    }
    const auto found = [&](shading::LaneMask lanes) {
      Bsdfs bsdfs;
      BsdfValues values;
      BsdfSamples samples;
      make_bsdfs(surfaces, views, lanes, bsdfs);
      evaluate(bsdfs, lights, lanes, values);
      sample(bsdfs, lobes, x, y, lanes, samples);
      std::vector<std::array<float, 12>> all_of;
      for (int i = 0; i < kBlockPoints; ++i) {
        if ((lanes >> i & 1) == 0) continue;
        const glm::vec3 v = values.value.get(i), w = samples.weight.get(i);
        // Where nothing comes of a sample its direction does not count.
        const glm::vec3 d = w != glm::vec3(0.0F) ? samples.direction.get(i) : glm::vec3(0.0F);
        all_of.push_back({v.x, v.y, v.z, values.pdf[i], d.x, d.y, d.z, w.x, w.y, w.z,
                          samples.pdf[i], (samples.transmitted >> i & 1) != 0 ? 1.0F : 0.0F});
      }
      return all_of;
    };
    const auto expected = found(shading::kAllLanes);
    tests::for_each_target([&] {
      ASSERT_EQ(found(shading::kAllLanes), expected) << "seed 6, try " << attempt;
      for (const int i : {0, 5, 15}) {
        ASSERT_EQ(found(1U << i)[0], expected[static_cast<std::size_t>(i)]) << attempt;
      }
    });
  }
}

TEST(Bsdf, BlackReturnsNothing) {
  const Bsdf bsdf = make_bsdf(made_of(1, 0.5F, 0, 1.5F, true, glm::vec3(0.0F)), {0, 0, 1});
  EXPECT_EQ(sample(bsdf, 0.5F, {0.5F, 0.5F}).weight, glm::vec3(0.0F));
  EXPECT_EQ(evaluate(bsdf, {0, 0, 1}).value, glm::vec3(0.0F));
}

}  // namespace
}  // namespace delray::raytrace
