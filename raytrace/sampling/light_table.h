// All that gives light in a scene, and how to draw from it: its lights, its environment and the
// triangles that glow.
//
// Which one is drawn goes by power, as far as it can be told beforehand. A light of no size can
// only be found by drawing it; the environment and what glows are met by rays that a surface
// scatters as well, and weighted against that (multiple importance sampling; Veach 1997). An area
// light whose parallelogram is covered by the triangles of an instance that glow the same is met
// there; one without such a lamp is met by no ray. What glows does so on both sides, an area light
// on one.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <span>
#include <vector>

#include "raytrace/sampling/alias_table.h"
#include "raytrace/sampling/rectangle.h"
#include "raytrace/sampling/sampler.h"
#include "raytrace/sampling/sky_table.h"
#include "scenes/scene.h"
#include "shading/batch_shader.h"
#include "shading/points.h"
#include "shading/shader.h"

namespace delray::raytrace {

struct LightSample {
  glm::vec3 direction{0, 0, 1};  // unit vector to the light
  float distance = std::numeric_limits<float>::infinity();
  glm::vec3 weight{0.0F};  // what arrives, over the density: the value of a Bsdf times this is an
                           // estimate of all light, if nothing is in the way. Zero: none
  float pdf = 0.0F;        // per steradian; 0: scattered rays never find it, it counts in full
};

// Lights drawn for sixteen lanes.
struct LightSamples {
  shading::Vectors16 direction;
  shading::Floats16 distance;
  shading::Vectors16 weight;
  shading::Floats16 pdf;

  void set(int i, const LightSample& sample);
};

class LightTable {
 public:
  // Pairs of numbers that `sample` takes.
  static constexpr std::size_t kPairs = 3;

  LightTable() = default;
  // The shader is that of the scene. Keeps emissive triangles of its own, once for each mesh.
  // O(emissive triangles + vertices of the scene). REQUIRES: indices of the scene are in range.
  LightTable(const scenes::Scene& scene, const shading::Shader& shader);

  bool empty() const { return emitters_.size() == 0; }

  // Draws a light for each lane in `lanes`; of the results, other lanes hold anything.
  void sample(const shading::BatchShader& shader, const shading::Vectors16& from,
              shading::LaneMask lanes, std::span<const Pairs16, kPairs> numbers,
              LightSamples& samples) const;

  // One at a time, for renderers that ask them all. Nothing else has a chance: weights are what
  // arrives over the density of the point. REQUIRES: the light is an area light; emits().
  LightSample sample_area(std::uint32_t light, const glm::vec3& from,
                          const glm::vec2& place) const {
    return draw_light(light, from, 1.0F, place);
  }
  // Whether a lamp shows it, which rays meet.
  bool has_lamp(std::uint32_t light) const { return has_lamp_[light]; }
  // Of triangles that glow and are no lamp of an area light.
  bool emits() const { return emission_.size() > 0; }
  LightSample sample_emission(const shading::Shader& shader, const glm::vec3& from,
                              const glm::vec2& instance, const glm::vec2& element,
                              const glm::vec2& place) const;

  // The density with which `sample` would have drawn what a ray from `from` met: a point of a
  // triangle, or the environment. 0 for what does not glow.
  float pdf_of_hit(std::uint32_t instance, std::uint32_t triangle, const glm::vec3& from,
                   const glm::vec3& position) const;
  // The density with which `sample` would have drawn the sky, for lanes that look along unit
  // vectors.
  void pdf_of_sky(const shading::Vectors16& directions, shading::Floats16& pdfs) const;

  std::uint64_t emissive_triangles() const;  // that can be drawn, of all instances

 private:
  // In space of the mesh.
  struct Triangle {
    glm::vec3 a, ab, ac;
    glm::vec2 uv[3], alpha_uv[3];  // for the textures of emission and of alpha
    float alpha[3];
    bool solid;  // covered everywhere
  };
  struct EmissiveMesh {
    std::vector<Triangle> triangles;
    AliasTable table;
    std::vector<std::uint32_t> slots;  // of the mesh's triangles in `triangles`; kNone: dark
    std::uint32_t material = 0;
    double power = 0.0;
  };
  struct EmissiveInstance {
    std::uint32_t instance = 0;  // of the scene; ascending
    std::uint32_t mesh = 0;      // in meshes_
    std::uint32_t light = 0;     // the area light that this is the lamp of; kNone
    glm::mat4x3 transform{1.0F};
  };

  void add_glowing(const scenes::Scene& scene, const shading::Shader& shader);
  // How likely `sample` draws an emitter: 0 where none has power, such as a sky that is a black
  // picture.
  float chance_of(std::uint32_t emitter) const {
    return empty() ? 0.0F : emitters_.probability(emitter);
  }
  std::uint32_t lamp_of(const EmissiveInstance& instance, const glm::vec3& emission) const;
  void weigh(const scenes::Scene& scene);
  LightSample draw_light(std::uint32_t light, const glm::vec3& from, float chance,
                         const glm::vec2& place) const;
  LightSample draw_emission(const shading::Shader& shader, const EmissiveInstance& instance,
                            const glm::vec3& from, float chance, const glm::vec2& element,
                            const glm::vec2& place) const;

  std::vector<scenes::Light> lights_;
  std::vector<bool> has_lamp_;  // of lights
  std::vector<EmissiveMesh> meshes_;
  std::vector<EmissiveInstance> instances_;
  SkyTable sky_;
  bool has_sky_ = false;
  AliasTable emitters_;  // lights, the sky, emissive instances
  AliasTable emission_;  // emissive instances alone; empty where there is nothing to draw
};

}  // namespace delray::raytrace
