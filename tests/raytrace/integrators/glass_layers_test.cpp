#include "raytrace/integrators/glass_layers.h"

#include <gtest/gtest.h>

#include <bit>
#include <random>

#include "raytrace/integrators/intersect.h"
#include "raytrace/tracer.h"
#include "scenes/generate.h"
#include "tests/support/targets.h"

namespace delray::raytrace {
namespace {

bool same(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}

TEST(GlassLayers, ManyLeaveWhatEachLeavesAlone) {
  scenes::Scene scene = scenes::generate("gen:spheres:2000:3");
  for (std::size_t m = 0; m < scene.materials.size(); ++m) {
    scenes::Material& material = scene.materials[m];
    material.transmission = 0.25F + 0.75F * static_cast<float>(m % 2);
    material.metallic = m % 3 == 0 ? 0.5F : 0.0F;
    material.ior = m % 5 == 0 ? 1.0F : 1.3F + 0.1F * static_cast<float>(m % 5);
    if (m % 4 == 1) {
      material.alpha = scenes::Material::Alpha::blend;
      material.base_colour.w = 0.75F;
    }
  }
  const Tracer tracer = make_tracer(scene);
  const shading::BatchShader shader = shading::make_batch_shader(tracer.shader);
  std::mt19937 random(1);
  const auto unit = [&] { return std::uniform_real_distribution<float>(0.0F, 1.0F)(random); };
  for (const std::size_t count : {1, 15, 16, 17, 190}) {
    std::vector<glm::vec3> transmittance(count, glm::vec3(-1.0F));
    std::vector<PaneHit> panes(count);
    for (std::size_t i = 0; i < count; ++i) {
      Hit& hit = panes[i].hit;
      hit.distance = unit();
      hit.instance = static_cast<std::uint32_t>(random() % tracer.instances.size());
      const scenes::Mesh& mesh = *tracer.instances[hit.instance].mesh;
      hit.triangle = static_cast<std::uint32_t>(random() % mesh.triangles.size());
      hit.u = unit(), hit.v = unit() * (1.0F - hit.u);
      const glm::vec3 way(unit() - 0.5F, unit() - 0.5F, unit() - 0.5F);
      panes[i].direction = way * (1.0F / std::sqrt(glm::dot(way, way)));
      panes[i].transmittance = &transmittance[i];
    }
    tests::for_each_target([&] {
      std::fill(transmittance.begin(), transmittance.end(), glm::vec3(-1.0F));
      find_transmittances(tracer.instances, shader, panes);
      for (std::size_t i = 0; i < count; ++i) {
        const glm::vec3 alone =
            layer_of(tracer.instances, tracer.shader, panes[i].hit, panes[i].direction, true)
                .transmittance;
        for (int k = 0; k < 3; ++k)
          ASSERT_TRUE(same(transmittance[i][k], alone[k])) << i << " of " << count;
      }
    });
  }
}

}  // namespace
}  // namespace delray::raytrace
