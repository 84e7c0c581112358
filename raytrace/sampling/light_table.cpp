// Builds tables of all emitters by power, and draws from them: lights, triangles that glow, the
// environment.
//
// Emitters, and triangles of a mesh that glows, are drawn from alias tables; points of a triangle
// uniformly (Heitz 2019), of a parallelogram as rectangle.h does. A small part of the choice is
// even, so that weak lights nearby are found. An area light that an instance covers with what it
// emits is one emitter. O(triangles) to build, O(1) to draw.
//
// Degenerate: without power there is nothing to draw; points seen edge-on have no density.
#include "raytrace/sampling/light_table.h"

#include <algorithm>
#include <bit>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/sampling/light_table.cpp"
#include <hwy/foreach_target.h>
// Code that is compiled per target comes after it.
#include <hwy/highway.h>

#include "raytrace/sampling/alias_lanes.h"
#include "raytrace/scene/opaque_triangles.h"
#include "shading/arithmetic.h"
#include "shading/batch.h"
#include "shading/lighting.h"
#include "shading/surface.h"

HWY_BEFORE_NAMESPACE();
namespace delray::raytrace {
namespace HWY_NAMESPACE {

void pick_emitters(const AliasTable& table, const Pairs16& choices, std::uint32_t* emitters,
                   shading::Floats16& chances) {
  for (int i = 0; i < shading::kBlockPoints; i += lanes()) {
    const I emitter = pick(table, load(choices.x, i), load(choices.y, i));
    hn::Store(emitter, IntTag(), reinterpret_cast<std::int32_t*>(emitters) + i);
    hn::Store(looked_up(table.probabilities(), emitter), FloatTag(), chances.lane + i);
  }
}

void set_sky_samples(const shading::Vectors16& directions, const shading::Floats16& pdfs,
                     const shading::Floats16& chances, const shading::Vectors16& radiance,
                     shading::LaneMask mask, LightSamples& samples) {
  for (int i = 0; i < shading::kBlockPoints; i += lanes()) {
    const M active = mask_of(mask, i);
    const F pdf = load(pdfs, i) * load(chances, i);
    store(load(directions, i), active, i, samples.direction);
    store(set(std::numeric_limits<float>::infinity()), active, i, samples.distance);
    store(load(radiance, i) * (set(1.0F) / pdf), active, i, samples.weight);
    store(pdf, active, i, samples.pdf);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::raytrace
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace delray::raytrace {
namespace {

HWY_EXPORT(pick_emitters);
HWY_EXPORT(set_sky_samples);

using scenes::kNone;
using scenes::Light;
using shading::kPi;

// Of all choices, the part that does not go by power: what is weak but close should be found too.
constexpr float kEvenly = 0.1F;

// A lamp may differ so much from its light, as a part of its size or radiance, and cover so much
// less of it.
constexpr float kLampTolerance = 1e-3F;

float mean(const glm::vec3& v) { return (v.x + v.y + v.z) * (1.0F / 3.0F); }

float length(const glm::vec3& v) { return std::sqrt(glm::dot(v, v)); }

Parallelogram shape_of(const Light& light) { return {light.position, light.edge_u, light.edge_v}; }

glm::vec3 point(const glm::mat4x3& transform, const glm::vec3& p) {
  return transform * glm::vec4(p, 1.0F);
}

glm::vec3 vector(const glm::mat4x3& transform, const glm::vec3& v) {
  return transform * glm::vec4(v, 0.0F);
}

// From the square to barycentric coordinates, uniformly, without a fold (Heitz 2019).
glm::vec2 triangle_point(const glm::vec2& u) {
  glm::vec2 b = u * 0.5F;
  const float offset = b.y - b.x;
  if (offset > 0.0F) {
    b.y += offset;
  } else {
    b.x -= offset;
  }
  return b;
}

// How many times larger areas become.
double area_scale(const glm::mat4x3& m) {
  const double det = std::abs(glm::dot(glm::cross(m[0], m[1]), m[2]));
  return std::cbrt(det * det);
}

// Where a mesh's corners lie in a texture of the shader.
const std::vector<glm::vec2>& uvs_of(const shading::Shader& shader, const scenes::Mesh& mesh,
                                     std::uint32_t texture) {
  return mesh.uvs_of(texture == kNone ? 0 : shader.textures[texture].set);
}

float area_pdf(const glm::vec3& normal, const glm::vec3& way) {
  const float distance2 = glm::dot(way, way);
  const float facing = std::abs(glm::dot(normal, way));  // times twice the area and the distance
  return facing > 0.0F ? 2.0F * distance2 * std::sqrt(distance2) / facing : 0.0F;
}

}  // namespace

void LightSamples::set(int i, const LightSample& sample) {
  direction.set(i, sample.direction);
  distance[i] = sample.distance;
  weight.set(i, sample.weight);
  pdf[i] = sample.pdf;
}

void LightTable::add_glowing(const scenes::Scene& scene, const shading::Shader& shader) {
  std::vector<std::uint32_t> number(scene.meshes.size(), kNone);
  const std::vector<LeastAlpha> alphas = least_alphas(shader);
  for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
    const scenes::Mesh& mesh = scene.meshes[m];
    const scenes::Material& material = shading::material(shader, mesh.material);
    if (!(mean(material.emission) > 0.0F) || mesh.triangles.empty() || !mesh.has_triangles())
      continue;
    const std::vector<glm::vec2>& uvs = uvs_of(shader, mesh, material.emission_texture);
    const std::vector<glm::vec2>& alpha_uvs = uvs_of(shader, mesh, material.base_colour_texture);
    const bool textured = material.emission_texture != kNone && !uvs.empty();
    EmissiveMesh emissive;
    emissive.material = mesh.material;
    const std::vector<std::uint64_t> solid = opaque_triangles(mesh, material, alphas);
    emissive.slots.assign(mesh.triangles.size(), kNone);
    std::vector<float> weights;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const glm::uvec3 c = mesh.triangles[t];
      Triangle triangle{};
      triangle.a = mesh.positions[c.x];
      triangle.ab = mesh.positions[c.y] - triangle.a;
      triangle.ac = mesh.positions[c.z] - triangle.a;
      triangle.solid = !solid.empty() && (solid[t / 64] >> (t % 64) & 1) != 0;
      for (int k = 0; k < 3; ++k) {
        if (!uvs.empty()) triangle.uv[k] = uvs[c[k]];
        if (!alpha_uvs.empty()) triangle.alpha_uv[k] = alpha_uvs[c[k]];
        triangle.alpha[k] = mesh.colours.empty() ? 1.0F : mesh.colours[c[k]].w;
      }
      float brightness = mean(material.emission);
      if (textured) {
        // The texture's mean around the middle and half way to the corners.
        const shading::Texture& texture = shader.textures[material.emission_texture];
        const glm::vec2 middle = (triangle.uv[0] + triangle.uv[1] + triangle.uv[2]) * (1.0F / 3);
        const shading::Footprint footprint{(triangle.uv[1] - triangle.uv[0]) * 0.5F,
                                           (triangle.uv[2] - triangle.uv[0]) * 0.5F};
        glm::vec3 sum = glm::vec3(shading::sample(texture, middle, footprint));
        for (const glm::vec2& corner : triangle.uv)
          sum += glm::vec3(shading::sample(texture, (middle + corner) * 0.5F, footprint));
        brightness = mean(material.emission * sum) * 0.25F;
      }
      const float weight = brightness * 0.5F * length(glm::cross(triangle.ab, triangle.ac));
      if (!(weight > 0.0F) || !std::isfinite(weight)) continue;
      emissive.slots[t] = static_cast<std::uint32_t>(emissive.triangles.size());
      emissive.triangles.push_back(triangle);
      weights.push_back(weight);
      emissive.power += static_cast<double>(weight) * 2.0 * kPi;  // on both sides
    }
    if (weights.empty()) continue;
    emissive.table = AliasTable(weights);
    number[m] = static_cast<std::uint32_t>(meshes_.size());
    meshes_.push_back(std::move(emissive));
  }
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const std::uint32_t mesh = scene.instances[i].mesh;
    if (mesh >= number.size() || number[mesh] == kNone) continue;
    EmissiveInstance instance{static_cast<std::uint32_t>(i), number[mesh], kNone,
                              scene.instances[i].transform};
    const scenes::Material& material = shading::material(shader, meshes_[instance.mesh].material);
    if (material.emission_texture == kNone) {
      instance.light = lamp_of(instance, material.emission);
      if (instance.light != kNone) has_lamp_[instance.light] = true;
    }
    instances_.push_back(instance);
  }
}

std::uint32_t LightTable::lamp_of(const EmissiveInstance& instance,
                                  const glm::vec3& emission) const {
  const EmissiveMesh& mesh = meshes_[instance.mesh];
  for (std::size_t i = 0; i < lights_.size(); ++i) {
    const Light& light = lights_[i];
    if (light.kind != Light::Kind::area) continue;
    if (length(light.colour - emission) > kLampTolerance * length(light.colour)) continue;
    const glm::vec3 normal = glm::cross(light.edge_u, light.edge_v);
    const float area = length(normal), size = std::sqrt(area);
    if (!(area > 0.0F)) continue;
    const auto inside = [&](const glm::vec3& p) {
      const glm::vec3 d = p - light.position;
      const float s = glm::dot(glm::cross(d, light.edge_v), normal) / (area * area);
      const float t = glm::dot(glm::cross(light.edge_u, d), normal) / (area * area);
      return std::abs(glm::dot(d, normal)) <= kLampTolerance * size * area &&
             s >= -kLampTolerance && s <= 1.0F + kLampTolerance && t >= -kLampTolerance &&
             t <= 1.0F + kLampTolerance;
    };
    double covered = 0.0;
    bool all = true;
    for (const Triangle& triangle : mesh.triangles) {
      const glm::vec3 a = point(instance.transform, triangle.a);
      const glm::vec3 ab = vector(instance.transform, triangle.ab);
      const glm::vec3 ac = vector(instance.transform, triangle.ac);
      all = inside(a) && inside(a + ab) && inside(a + ac);
      if (!all) break;
      covered += 0.5 * length(glm::cross(ab, ac));
    }
    if (all && covered >= (1.0 - 4.0 * kLampTolerance) * area) return static_cast<std::uint32_t>(i);
  }
  return kNone;
}

void LightTable::weigh(const scenes::Scene& scene) {
  std::vector<double> power;
  const geometry::Box3 box = scenes::bounds(scene);
  const double radius =
      box.empty() ? 1.0
                  : 0.5 * static_cast<double>(length(glm::vec3(box.high) - glm::vec3(box.low)));
  const double disc = kPi * std::max(radius * radius, 1e-30);
  for (const Light& light : lights_) {
    const double colour = mean(light.colour);
    switch (light.kind) {
      case Light::Kind::point:
        power.push_back(4.0 * kPi * colour);
        break;
      case Light::Kind::directional:
        power.push_back(glm::dot(light.direction, light.direction) > 0.0F ? disc * colour : 0.0);
        break;
      case Light::Kind::area:
        power.push_back(kPi * colour * length(glm::cross(light.edge_u, light.edge_v)));
        break;
    }
  }
  power.push_back(has_sky_ ? disc * sky_.integral() : 0.0);
  for (const EmissiveInstance& instance : instances_) {
    power.push_back(instance.light != kNone
                        ? 0.0
                        : meshes_[instance.mesh].power * area_scale(instance.transform));
  }
  double sum = 0.0;
  int count = 0;
  for (double& p : power) {
    if (!(p > 0.0) || !std::isfinite(p)) p = 0.0;
    sum += p;
    count += p > 0.0 ? 1 : 0;
  }
  if (count == 0) return;
  std::vector<float> weights;
  for (const double p : power) {
    weights.push_back(p > 0.0 ? static_cast<float>((1.0 - kEvenly) * p / sum + kEvenly / count)
                              : 0.0F);
  }
  emitters_ = AliasTable(weights);
  const auto first = weights.begin() + static_cast<std::ptrdiff_t>(lights_.size()) + 1;
  if (std::any_of(first, weights.end(), [](float weight) { return weight > 0.0F; })) {
    emission_ = AliasTable(std::span(first, weights.end()));
  }
}

LightTable::LightTable(const scenes::Scene& scene, const shading::Shader& shader)
    : lights_(shader.lights), has_lamp_(shader.lights.size(), false) {
  has_sky_ = !shader.environment.black;
  if (has_sky_) sky_ = SkyTable(shader.environment, shader.textures);
  add_glowing(scene, shader);
  weigh(scene);
}

LightSample LightTable::draw_light(std::uint32_t number, const glm::vec3& from, float chance,
                                   const glm::vec2& place) const {
  const Light& light = lights_[number];
  LightSample result;
  if (light.kind != Light::Kind::area) {
    const shading::Incident incident = shading::incident(light, from);
    result.direction = incident.direction;
    result.distance = incident.distance;
    result.weight = incident.irradiance / chance;
    return result;
  }
  const SurfacePoint drawn = raytrace::sample(shape_of(light), from, place);
  const glm::vec3 way = drawn.position - from;
  const glm::vec3 normal = glm::cross(light.edge_u, light.edge_v);
  if (!(drawn.pdf > 0.0F) || !(glm::dot(normal, way) < 0.0F)) return result;
  result.distance = length(way);
  result.direction = way * (1.0F / result.distance);
  result.weight = light.colour / (drawn.pdf * chance);
  if (has_lamp_[number]) result.pdf = drawn.pdf * chance;
  return result;
}

LightSample LightTable::draw_emission(const shading::Shader& shader,
                                      const EmissiveInstance& instance, const glm::vec3& from,
                                      float chance, const glm::vec2& element,
                                      const glm::vec2& place) const {
  const EmissiveMesh& mesh = meshes_[instance.mesh];
  const std::uint32_t slot = mesh.table.pick(element.x, element.y);
  const Triangle& triangle = mesh.triangles[slot];
  const glm::vec2 b = triangle_point(place);
  const glm::vec3 ab = vector(instance.transform, triangle.ab);
  const glm::vec3 ac = vector(instance.transform, triangle.ac);
  const glm::vec3 way = point(instance.transform, triangle.a) + ab * b.x + ac * b.y - from;
  LightSample result;
  const float pdf = chance * mesh.table.probability(slot) * area_pdf(glm::cross(ab, ac), way);
  if (!(pdf > 0.0F) || !std::isfinite(pdf)) return result;
  const scenes::Material& material = shading::material(shader, mesh.material);
  const float rest = 1.0F - b.x - b.y;
  const auto interpolated = [&](const glm::vec2(&uv)[3]) {
    return uv[0] * rest + uv[1] * b.x + uv[2] * b.y;
  };
  glm::vec3 radiance = material.emission;
  if (material.emission_texture != kNone) {
    radiance *= glm::vec3(shading::sample(shader.textures[material.emission_texture],
                                          interpolated(triangle.uv), shading::Footprint{}));
  }
  if (material.alpha != scenes::Material::Alpha::opaque && !triangle.solid) {
    const float alpha =
        triangle.alpha[0] * rest + triangle.alpha[1] * b.x + triangle.alpha[2] * b.y;
    radiance *= shading::coverage(shader, material, interpolated(triangle.alpha_uv),
                                  shading::Footprint{}, alpha);
  }
  result.distance = length(way);
  result.direction = way * (1.0F / result.distance);
  result.weight = radiance / pdf;
  result.pdf = pdf;
  return result;
}

LightSample LightTable::sample_emission(const shading::Shader& shader, const glm::vec3& from,
                                        const glm::vec2& instance, const glm::vec2& element,
                                        const glm::vec2& place) const {
  const std::uint32_t number = emission_.pick(instance.x, instance.y);
  return draw_emission(shader, instances_[number], from, emission_.probability(number), element,
                       place);
}

void LightTable::sample(const shading::BatchShader& shader, const shading::Vectors16& from,
                        shading::LaneMask lanes, std::span<const Pairs16, kPairs> numbers,
                        LightSamples& samples) const {
  if (empty()) {
    samples = {};
    return;
  }
  alignas(64) std::uint32_t emitters[shading::kBlockPoints];
  shading::Floats16 chances;
  HWY_DYNAMIC_DISPATCH(pick_emitters)(emitters_, numbers[0], emitters, chances);
  const std::size_t lights = lights_.size();
  shading::LaneMask sky = 0;
  for (shading::LaneMask rest = lanes; rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    const std::uint32_t emitter = emitters[i];
    const glm::vec2 place(numbers[2].x[i], numbers[2].y[i]);
    if (emitter == lights) {
      sky |= 1U << i;
    } else if (emitter < lights) {
      samples.set(i, draw_light(emitter, from.get(i), chances[i], place));
    } else {
      const glm::vec2 element(numbers[1].x[i], numbers[1].y[i]);
      samples.set(i, draw_emission(*shader.shader, instances_[emitter - lights - 1], from.get(i),
                                   chances[i], element, place));
    }
  }
  if (sky == 0) return;
  shading::Vectors16 directions, radiance;
  shading::Floats16 pdfs;
  sky_.sample(numbers[1], numbers[2], directions, pdfs);
  shading::environment_radiance(shader, directions, 0.0F, sky, radiance);
  HWY_DYNAMIC_DISPATCH(set_sky_samples)(directions, pdfs, chances, radiance, sky, samples);
}

float LightTable::pdf_of_hit(std::uint32_t instance, std::uint32_t triangle, const glm::vec3& from,
                             const glm::vec3& position) const {
  const auto found = std::lower_bound(
      instances_.begin(), instances_.end(), instance,
      [](const EmissiveInstance& a, std::uint32_t number) { return a.instance < number; });
  if (found == instances_.end() || found->instance != instance) return 0.0F;
  const EmissiveMesh& mesh = meshes_[found->mesh];
  const std::uint32_t slot = mesh.slots[triangle];
  if (slot == kNone) return 0.0F;
  const glm::vec3 way = position - from;
  if (found->light != kNone) {
    const Light& light = lights_[found->light];
    if (!(glm::dot(glm::cross(light.edge_u, light.edge_v), way) < 0.0F)) return 0.0F;
    return raytrace::pdf(shape_of(light), from, position) * chance_of(found->light);
  }
  const auto emitter = static_cast<std::uint32_t>(
      lights_.size() + 1 + static_cast<std::size_t>(found - instances_.begin()));
  const glm::vec3 normal = glm::cross(vector(found->transform, mesh.triangles[slot].ab),
                                      vector(found->transform, mesh.triangles[slot].ac));
  const float pdf = chance_of(emitter) * mesh.table.probability(slot) * area_pdf(normal, way);
  return std::isfinite(pdf) ? pdf : 0.0F;
}

void LightTable::pdf_of_sky(const shading::Vectors16& directions, shading::Floats16& pdfs) const {
  if (!has_sky_) {
    pdfs = {};
    return;
  }
  sky_.pdf(directions, pdfs);
  const float chance = chance_of(static_cast<std::uint32_t>(lights_.size()));
  for (float& pdf : pdfs.lane) pdf *= chance;
}

std::uint64_t LightTable::emissive_triangles() const {
  std::uint64_t sum = 0;
  for (const EmissiveInstance& instance : instances_) {
    if (instance.light == kNone) sum += meshes_[instance.mesh].triangles.size();
  }
  return sum;
}

}  // namespace delray::raytrace
#endif
