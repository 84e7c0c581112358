// Random materials, lights, environments and points, degenerate ones among them.
#pragma once

#include <random>

#include "shading/surface.h"

namespace delray::shading {

class RandomScene {
 public:
  explicit RandomScene(std::uint32_t seed) : random_(seed) {}

  float unit() { return std::uniform_real_distribution<float>(0.0F, 1.0F)(random_); }
  float between(float a, float b) { return a + (b - a) * unit(); }
  bool one_in(int n) { return random_() % static_cast<std::uint32_t>(n) == 0; }
  int below(int n) { return static_cast<int>(random_() % static_cast<std::uint32_t>(n)); }

  glm::vec3 vector(float reach = 1.0F) {
    return {between(-reach, reach), between(-reach, reach), between(-reach, reach)};
  }

  glm::vec3 direction() {
    if (one_in(8)) {
      glm::vec3 axis(0.0F);
      axis[below(3)] = one_in(2) ? 1.0F : -1.0F;
      return axis;
    }
    for (;;) {
      const glm::vec3 v = vector();
      const float squared = glm::dot(v, v);
      if (squared > 1e-3F) return v * (1.0F / std::sqrt(squared));
    }
  }

  scenes::Scene scene() {
    scenes::Scene scene;
    const int textures = below(4);
    for (int i = 0; i < textures; ++i) scene.textures.push_back(texture());
    for (int i = 0; i < 3; ++i) scene.materials.push_back(material(textures));
    const int lights = below(5);
    for (int i = 0; i < lights; ++i) scene.lights.push_back(light());
    if (!one_in(5)) {
      scene.environment.zenith = {unit(), unit(), unit()};
      scene.environment.horizon = {unit(), unit(), unit()};
      scene.environment.ground = {unit(), unit(), unit()};
      if (one_in(2)) scene.environment.up = direction();
      if (textures > 0 && one_in(3)) scene.environment.texture = 0;
      if (one_in(4)) {
        scene.environment.texture = static_cast<std::uint32_t>(scene.textures.size());
        scene.environment.rotation = between(-400.0F, 400.0F);
        scene.textures.push_back(texture());
        scenes::Texture& light = scene.textures.back();
        for (std::size_t i = 0; i < light.texels.size(); ++i)
          light.radiance.push_back(glm::abs(vector(1000.0F)));
      }
    }
    return scene;
  }

  Point point() {
    Point point;
    point.position = vector(3.0F);
    point.geometric_normal = one_in(40) ? glm::vec3(0.0F) : direction();
    point.normal = one_in(4) ? point.geometric_normal : one_in(40) ? glm::vec3(0.0F) : direction();
    if (!one_in(4)) point.tangent = glm::vec4(direction(), one_in(2) ? 1.0F : -1.0F);
    point.uv = {coordinate(), coordinate()};
    if (!one_in(4)) {
      const float size = 1.0F / static_cast<float>(1 << below(9));
      point.footprint.dx = {between(-size, size), between(-size, size)};
      point.footprint.dy = {between(-size, size), between(-size, size)};
    }
    if (one_in(30)) point.footprint.dx.x = odd_number();
    point.second.uv = {coordinate(), coordinate()};
    point.second.footprint.dy = point.footprint.dx * 3.0F;
    point.colour = {unit(), unit(), unit(), unit()};
    return point;
  }

 private:
  float odd_number() {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    const float odd[] = {0.0F,   -0.0F,     1.0F,       1e20F,
                         -1e20F, kInfinity, -kInfinity, std::numeric_limits<float>::quiet_NaN()};
    return odd[below(8)];
  }

  float coordinate() {
    if (one_in(12)) return odd_number();
    if (one_in(6)) return static_cast<float>(below(33) - 16) / 8.0F;
    return between(-2.0F, 2.0F);
  }

  float share() { return one_in(3) ? 0.0F : one_in(3) ? 1.0F : unit(); }

  scenes::Texture texture() {
    using Wrap = scenes::Texture::Wrap;
    scenes::Texture texture;
    texture.width = 1 + below(21);
    texture.height = 1 + below(21);
    texture.srgb = one_in(2);
    texture.wrap_u = static_cast<Wrap>(below(3));
    texture.wrap_v = static_cast<Wrap>(below(3));
    texture.set = static_cast<std::uint8_t>(below(2));
    texture.texels.resize(static_cast<std::size_t>(texture.width * texture.height));
    for (image::Rgba8& t : texture.texels) {
      t = {static_cast<std::uint8_t>(random_()), static_cast<std::uint8_t>(random_()),
           static_cast<std::uint8_t>(random_()), static_cast<std::uint8_t>(random_())};
    }
    return texture;
  }

  std::uint32_t texture_or_none(int textures) {
    if (textures == 0 || one_in(2)) return scenes::kNone;
    return static_cast<std::uint32_t>(below(textures));
  }

  scenes::Material material(int textures) {
    scenes::Material material;
    material.base_colour = {unit(), unit(), unit(), unit()};
    if (one_in(6)) material.base_colour = glm::vec4(0, 0, 0, 1);
    material.metallic = share();
    material.roughness = share();
    material.transmission = share();
    material.ior = one_in(4) ? 1.0F : between(1.0F, 2.5F);
    if (one_in(3)) material.emission = {unit(), unit(), unit()};
    material.normal_scale = between(0.0F, 2.0F);
    material.alpha = static_cast<scenes::Material::Alpha>(below(3));
    material.base_colour_texture = texture_or_none(textures);
    material.metallic_roughness_texture = texture_or_none(textures);
    material.normal_texture = texture_or_none(textures);
    material.emission_texture = texture_or_none(textures);
    if (one_in(2)) add_extensions(material, textures);
    return material;
  }

  void add_extensions(scenes::Material& material, int textures) {
    material.unlit = one_in(8);
    if (one_in(2)) material.specular = share();
    if (one_in(3)) material.specular_colour = {unit(), 1.5F * unit(), unit()};
    if (one_in(3)) {
      material.clearcoat = share();
      material.clearcoat_roughness = share();
    }
    if (one_in(3)) {
      material.sheen_colour = {unit(), unit(), unit()};
      material.sheen_roughness = share();
    }
    material.thickness = one_in(3) ? 0.0F : unit();
    if (one_in(2)) {
      material.attenuation_colour = {unit(), unit(), one_in(3) ? 0.0F : 1.0F};
      material.attenuation_distance = unit();
    }
    if (one_in(2)) return;
    for (std::uint32_t* const texture : material.textures()) *texture = texture_or_none(textures);
  }

  scenes::Light light() {
    scenes::Light light;
    light.kind = static_cast<scenes::Light::Kind>(below(3));
    light.colour = {unit(), unit(), unit()};
    if (one_in(8)) light.colour = glm::vec3(0.0F);
    light.position = vector(4.0F);
    light.direction = one_in(10) ? glm::vec3(0.0F) : vector();
    light.edge_u = vector();
    light.edge_v = one_in(10) ? light.edge_u : vector();
    return light;
  }

  std::mt19937 random_;
};

}  // namespace delray::shading
