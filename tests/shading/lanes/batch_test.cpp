#include "shading/batch.h"

#include <gtest/gtest.h>

#include <bit>
#include <vector>

#include "shading/shade.h"
#include "tests/shading/random_scene.h"
#include "tests/support/targets.h"

namespace delray::shading {
namespace {

constexpr std::uint32_t kSeeds = 400;

// One number as good as the other if both are NaN, of which some machines set the sign.
bool same(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b) || (a != a && b != b);
}
bool same(const glm::vec3& a, const glm::vec3& b) {
  return same(a.x, b.x) && same(a.y, b.y) && same(a.z, b.z);
}
testing::AssertionResult equal(const glm::vec3& a, const glm::vec3& b) {
  if (same(a, b)) return testing::AssertionSuccess();
  return testing::AssertionFailure()
         << std::hexfloat << a.x << " " << a.y << " " << a.z << " is not " << b.x << " " << b.y
         << " " << b.z << std::defaultfloat << " (" << a.x << " " << b.x << ")";
}

// A scene, and a block of points in it with its scalar counterpart.
struct Case {
  explicit Case(std::uint32_t seed)
      : random(seed), shader(make_shader(random.scene())), batch(make_batch_shader(shader)) {
    points.coloured = random.one_in(2);
    for (int i = 0; i < kBlockPoints; ++i) {
      Point p = random.point();
      if (!points.coloured) p.colour = glm::vec4(1.0F);
      // A light at the point itself.
      if (!shader.lights.empty() && random.one_in(20)) p.position = shader.lights[0].position;
      point.push_back(p);
      set_point(points, i, p);
      view.push_back(random.direction());
      views.set(i, view.back());
      for (std::size_t l = 0; l < shader.lights.size(); ++l) {
        if (i == 0) visibility.emplace_back();
        visibility[l].set(
            i, random.one_in(3) ? glm::vec3(0.0F) : glm::vec3(random.unit(), random.unit(), 1.0F));
      }
    }
  }

  Surface surface(std::uint32_t material, int i) const {
    return shading::evaluate(shader, shader.materials[material], point[i], view[i]);
  }

  RandomScene random;
  Shader shader;
  BatchShader batch;
  std::vector<Point> point;
  std::vector<glm::vec3> view;
  Points points;
  Vectors16 views;
  std::vector<Vectors16> visibility;
};

TEST(Batch, ShadesAsTheScalarFunctionsDo) {
  tests::for_each_target([] {
    for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) {
      const Case c(seed);
      for (std::uint32_t m = 0; m < c.shader.materials.size(); ++m) {
        Shaded all, some;
        shade(c.batch, m, c.points, c.views, kAllLanes, {}, all);
        shade(c.batch, m, c.points, c.views, kAllLanes, c.visibility, some);
        for (int i = 0; i < kBlockPoints; ++i) {
          const Surface surface = c.surface(m, i);
          ASSERT_TRUE(
              equal(all.colour.get(i), shade(c.shader, surface, c.view[i],
                                             [](std::size_t, const Incident&) { return 1.0F; })))
              << "seed " << seed << " material " << m << " lane " << i;
          ASSERT_TRUE(equal(some.colour.get(i), shade(c.shader, surface, c.view[i],
                                                      [&](std::size_t l, const Incident&) {
                                                        return c.visibility[l].get(i);
                                                      })))
              << "seed " << seed << " material " << m << " lane " << i;
          ASSERT_TRUE(same(all.alpha[i], surface.alpha)) << "seed " << seed;
        }
      }
    }
  });
}

TEST(Batch, PartsAreThoseOfTheScalarFunctions) {
  tests::for_each_target([] {
    for (std::uint32_t seed = 1; seed <= kSeeds / 2; ++seed) {
      const Case c(seed);
      const std::uint32_t m = seed % 3;
      Surfaces surfaces;
      evaluate(c.batch, m, c.points, c.views, kAllLanes, surfaces);
      Vectors16 diffuse, specular, coat, transmitted, around, reflected, directions;
      ambient_diffuse(c.batch, surfaces, c.views, kAllLanes, diffuse);
      ambient_specular(c.batch, surfaces, c.views, kAllLanes, specular);
      ambient_coat(c.batch, surfaces, c.views, kAllLanes, coat);
      ambient_transmitted(c.batch, surfaces, c.views, kAllLanes, transmitted);
      environment_radiance(c.batch, c.views, 0.3F, kAllLanes, around);
      for (int i = 0; i < kBlockPoints; ++i) directions.set(i, c.view[(i + 5) % kBlockPoints]);
      reflect(surfaces, c.views, directions, kAllLanes, reflected);
      for (int i = 0; i < kBlockPoints; ++i) {
        SCOPED_TRACE(testing::Message() << "seed " << seed << " lane " << i);
        const Surface expected = c.surface(m, i), got = surface_at(surfaces, i);
        ASSERT_TRUE(equal(got.position, expected.position));
        ASSERT_TRUE(equal(got.geometric_normal, expected.geometric_normal));
        ASSERT_TRUE(equal(got.normal, expected.normal));
        ASSERT_EQ(got.front, expected.front);
        ASSERT_TRUE(equal(got.base_colour, expected.base_colour));
        ASSERT_TRUE(equal({got.alpha, got.metallic, got.roughness},
                          {expected.alpha, expected.metallic, expected.roughness}));
        ASSERT_TRUE(
            equal({got.transmission, got.ior, 0}, {expected.transmission, expected.ior, 0}));
        const glm::vec3& view = c.view[i];
        const Seen seen = seen_from(expected, view);
        ASSERT_TRUE(equal(got.emission, expected.emission * seen.layers.below_coat));
        const Lobes& lobe = seen.lobes;
        const Lobes got_lobe = lobes_at(surfaces, i);
        ASSERT_TRUE(equal(got_lobe.diffuse, lobe.diffuse));
        ASSERT_TRUE(equal(surfaces.scale.get(i), seen.response.scale));
        ASSERT_TRUE(equal(surfaces.mirrored.get(i), seen.response.specular));
        ASSERT_TRUE(same(surfaces.entering[i], seen.response.entering));
        ASSERT_TRUE(equal(got_lobe.specular, lobe.specular));
        ASSERT_TRUE(equal({got_lobe.grazing, got_lobe.alpha, got_lobe.roughness},
                          {lobe.grazing, lobe.alpha, lobe.roughness}));
        ASSERT_TRUE(equal(diffuse.get(i), ambient_diffuse(c.shader, expected, seen)));
        ASSERT_TRUE(equal(specular.get(i), ambient_specular(c.shader, expected, seen)));
        ASSERT_TRUE(equal(coat.get(i), ambient_coat(c.shader, seen)));
        ASSERT_TRUE(equal(transmitted.get(i), ambient_transmitted(c.shader, expected, seen)));
        ASSERT_TRUE(
            equal(reflected.get(i), reflect(expected, seen, c.view[(i + 5) % kBlockPoints])));
        ASSERT_TRUE(
            equal(around.get(i), radiance(c.shader.environment, c.shader.textures, view, 0.3F)));
      }
    }
  });
}

TEST(Batch, LightsComeOneByOne) {
  tests::for_each_target([] {
    for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) {
      const Case c(seed);
      const std::uint32_t m = seed % 3;
      Surfaces surfaces;
      evaluate(c.batch, m, c.points, c.views, kAllLanes, surfaces);
      std::vector<LaneMask> mattering;
      std::vector<Arriving> arriving(c.shader.lights.size());
      for (std::size_t l = 0; l < c.shader.lights.size(); ++l) {
        mattering.push_back(
            reflect_light(c.batch, l, surfaces, c.views, kAllLanes & ~1U, arriving[l]));
      }
      for (int i = 1; i < kBlockPoints; ++i) {
        const Surface surface = c.surface(m, i);
        std::vector<LaneMask> asked(c.shader.lights.size());
        glm::vec3 sum(0.0F);
        const glm::vec3 all =
            direct(c.shader, surface, seen_from(surface, c.view[i]),
                   [&](std::size_t l, const Incident& light) {
                     asked[l] = 1U << i;
                     EXPECT_TRUE(equal(arriving[l].direction.get(i), light.direction));
                     EXPECT_TRUE(same(arriving[l].distance[i], light.distance));
                     sum += arriving[l].reflected.get(i);
                     return 1.0F;
                   });
        ASSERT_TRUE(equal(sum, all)) << "seed " << seed << " lane " << i;
        for (std::size_t l = 0; l < asked.size(); ++l) {
          ASSERT_EQ(mattering[l] & (1U << i), asked[l]) << "seed " << seed << " light " << l;
          ASSERT_EQ(mattering[l] & 1U, 0U);
        }
      }
    }
  });
}

TEST(Batch, LanesThatAreNotMeantMakeNoDifference) {
  tests::for_each_target([] {
    for (std::uint32_t seed = 1; seed <= kSeeds / 4; ++seed) {
      Case c(seed);
      const std::uint32_t m = seed % 3;
      Shaded all;
      shade(c.batch, m, c.points, c.views, kAllLanes, {}, all);
      const auto mask = static_cast<LaneMask>(c.random.below(1 << kBlockPoints));
      Points others = c.points;
      Vectors16 views = c.views;
      const glm::vec3 nothing(std::numeric_limits<float>::quiet_NaN());
      for (int i = 0; i < kBlockPoints; ++i) {
        if ((mask >> i & 1U) != 0) continue;
        views.set(i, nothing);
        others.position.set(i, nothing);
        others.normal.set(i, nothing);
        others.uvs[0].dx_u[i] = others.uvs[1].dx_u[i] = nothing.x;
        others.colour.set(i, nothing);
      }
      Shaded some;
      for (int i = 0; i < kBlockPoints; ++i) some.alpha[i] = some.colour.y[i] = -7.0F;
      shade(c.batch, m, others, views, mask, {}, some);
      for (int i = 0; i < kBlockPoints; ++i) {
        if ((mask >> i & 1U) != 0) {
          ASSERT_TRUE(equal(some.colour.get(i), all.colour.get(i))) << "seed " << seed;
          ASSERT_TRUE(same(some.alpha[i], all.alpha[i])) << "seed " << seed;
        } else {
          ASSERT_EQ(some.colour.y[i], -7.0F) << "seed " << seed << " lane " << i;
          ASSERT_EQ(some.alpha[i], -7.0F) << "seed " << seed << " lane " << i;
        }
      }
    }
  });
}

TEST(Batch, TexturesAndCoverageAreThoseOfTheScalarFunctions) {
  tests::for_each_target([] {
    for (std::uint32_t seed = 1; seed <= kSeeds / 2; ++seed) {
      const Case c(seed);
      const std::uint32_t m = seed % 3;
      Floats16 alpha;
      coverage(c.batch, m, c.points, kAllLanes, alpha);
      for (int i = 0; i < kBlockPoints; ++i) {
        const Point& p = c.point[i];
        ASSERT_TRUE(same(alpha[i], coverage(c.shader, c.shader.materials[m], p)))
            << "seed " << seed << " lane " << i;
      }
      for (const Texture& texture : c.shader.textures) {
        Shaded texels;
        sample(texture, c.points, kAllLanes, texels);
        for (int i = 0; i < kBlockPoints; ++i) {
          const Point& p = c.point[i];
          const TexturePoint at = texture.set == 0 ? TexturePoint{p.uv, p.footprint} : p.second;
          const glm::vec4 texel = sample(texture, p);
          ASSERT_EQ(texel.x, sample(texture, at.uv, at.footprint).x) << "seed " << seed;
          ASSERT_TRUE(equal(texels.colour.get(i), glm::vec3(texel))) << "seed " << seed;
          ASSERT_TRUE(same(texels.alpha[i], texel.w)) << "seed " << seed << " lane " << i;
          ASSERT_TRUE(same(sample_alpha(texture, at.uv, at.footprint), texel.w))
              << "seed " << seed << " lane " << i;
        }
      }
    }
  });
}

TEST(Batch, WhatCoversHasAnAlphaOfOne) {
  scenes::Scene scene;
  RandomScene random(8);
  for (const std::uint8_t least : {255, 254}) {
    scenes::Texture texture;
    texture.width = texture.height = 5;
    for (int i = 0; i < 25; ++i) texture.texels.push_back({1, 2, 3, 255});
    texture.texels[7].a = least;
    scene.textures.push_back(texture);
  }
  using Alpha = scenes::Material::Alpha;
  const auto add = [&](Alpha alpha, float factor, std::uint32_t texture) {
    scenes::Material& material = scene.materials.emplace_back();
    material.alpha = alpha;
    material.base_colour.w = factor;
    material.base_colour_texture = texture;
  };
  for (const Alpha alpha : {Alpha::opaque, Alpha::mask, Alpha::blend}) {
    for (const float factor : {1.0F, 0.75F}) {
      for (const std::uint32_t texture : {scenes::kNone, 0U, 1U}) add(alpha, factor, texture);
    }
  }
  const Shader shader = make_shader(scene);
  const BatchShader batch = make_batch_shader(shader);
  int covering = 0;
  for (std::uint32_t m = 0; m < scene.materials.size(); ++m) {
    if (!batch.material(m).covers) continue;
    ++covering;
    for (int turn = 0; turn < 20; ++turn) {
      Points points;
      for (int i = 0; i < kBlockPoints; ++i) set_point(points, i, random.point());
      Floats16 alpha;
      coverage(batch, m, points, kAllLanes, alpha);
      for (int i = 0; i < kBlockPoints; ++i) ASSERT_EQ(alpha[i], 1.0F) << m << " lane " << i;
    }
  }
  // Opaque; masked, without the texture that has a hole; blended, without a factor either.
  EXPECT_EQ(covering, 6 + 4 + 2);
}

TEST(Batch, DirectionsLeadToTheEye) {
  tests::for_each_target([] {
    const glm::vec3 eye(1, 2, 3), otherwise(0, 0, 1);
    RandomScene random(5);
    Vectors16 positions, views;
    for (int i = 0; i < kBlockPoints; ++i) positions.set(i, i == 3 ? eye : random.vector(9.0F));
    directions_to(eye, otherwise, positions, views);
    for (int i = 0; i < kBlockPoints; ++i) {
      const glm::vec3 way = eye - positions.get(i);
      const glm::vec3 unit = way * (1.0F / std::sqrt(glm::dot(way, way)));
      EXPECT_TRUE(equal(views.get(i), i == 3 ? otherwise : unit)) << "seed 5, lane " << i;
    }
  });
}

TEST(Batch, UnknownMaterialsAreTheFirst) {
  const Case c(3);
  Shaded first, unknown;
  shade(c.batch, 0, c.points, c.views, kAllLanes, {}, first);
  shade(c.batch, 1000, c.points, c.views, kAllLanes, {}, unknown);
  for (int i = 0; i < kBlockPoints; ++i)
    EXPECT_TRUE(equal(unknown.colour.get(i), first.colour.get(i)));
}

}  // namespace
}  // namespace delray::shading
