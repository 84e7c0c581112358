// Shading of sixteen points at a time by vector instructions chosen at run time: bit for bit what
// evaluate(), lobes() and shade() give for each of them alone, whatever its lane and whatever the
// other lanes hold, on every instruction set.
//
// All functions write the lanes in `lanes` and leave the others of their results as they were.
// `views` are unit vectors to the viewer. REQUIRES (all): what the lanes in `lanes` hold is finite,
// except for `uvs`.
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "shading/batch_shader.h"
#include "shading/layers.h"
#include "shading/points.h"

namespace delray::shading {

// Unit vectors from positions to `eye`; `otherwise` from eye itself.
void directions_to(const glm::vec3& eye, const glm::vec3& otherwise, const Vectors16& positions,
                   Vectors16& views);

// Colours and alphas of a block of points.
struct Shaded {
  Vectors16 colour;  // linear RGB radiance, as shade() gives it: not multiplied by alpha
  Floats16 alpha;
};

// Everything at once, for points of one material (a number out of range is that of the first).
// visibility[l] says how much of light l arrives at each lane, channel by channel; without any,
// all of it does. The way to go for renderers without shadows: some 5 to 15 ns a point where the
// material has no textures.
// REQUIRES: visibility is empty or has one element per light.
void shade(const BatchShader& shader, std::uint32_t material, const Points& points,
           const Vectors16& views, LaneMask lanes, std::span<const Vectors16> visibility,
           Shaded& shaded);

// Surface::alpha alone, as coverage() gives it. Reads colours' alpha and uvs of points.
void coverage(const BatchShader& shader, std::uint32_t material, const Points& points,
              LaneMask lanes, Floats16& alpha);

// A texture at the points.
void sample(const Texture& texture, const Points& points, LaneMask lanes, Shaded& texels);

// In parts, for renderers that send rays in between. What Surface and Lobes say of one point; lanes
// may belong to different materials, each evaluated with a mask of its own.
struct Surfaces {
  Vectors16 position;
  Vectors16 geometric_normal, normal;
  alignas(64) std::int32_t front[kBlockPoints] = {};  // -1: yes, 0: no
  Vectors16 base_colour;
  Floats16 alpha;
  Floats16 metallic, roughness, transmission, ior;
  Vectors16 emission;
  Vectors16 diffuse, specular;  // of Lobes, as the next three
  Floats16 grazing, lobe_alpha, lobe_roughness;
  Vectors16 mirrored, scale;  // Response::specular and the others, below the layers
  Floats16 entering;
  Vectors16 tint;        // base colour times attenuation; read where the material transmits
  LaneMask thin = 0;     // what is transmitted passes straight
  LaneMask layered = 0;  // these have layers, and emission is what the coat leaves of it
  Layers layers[kBlockPoints];
};

void evaluate(const BatchShader& shader, std::uint32_t material, const Points& points,
              const Vectors16& views, LaneMask lanes, Surfaces& surfaces);

// Takes from a lane all lobes that scatter diffusely, or all others.
void remove_diffuse(Surfaces& surfaces, int lane);
void keep_diffuse(Surfaces& surfaces, int lane);

// As far as Surfaces and its lobes say.
Surface surface_at(const Surfaces& surfaces, int lane);
Lobes lobes_at(const Surfaces& surfaces, int lane);

void ambient_diffuse(const BatchShader& shader, const Surfaces& surfaces, const Vectors16& views,
                     LaneMask lanes, Vectors16& colours);
void ambient_specular(const BatchShader& shader, const Surfaces& surfaces, const Vectors16& views,
                      LaneMask lanes, Vectors16& colours);
void ambient_coat(const BatchShader& shader, const Surfaces& surfaces, const Vectors16& views,
                  LaneMask lanes, Vectors16& colours);
void ambient_transmitted(const BatchShader& shader, const Surfaces& surfaces,
                         const Vectors16& views, LaneMask lanes, Vectors16& colours);

// What one light would add if nothing were in its way.
struct Arriving {
  Vectors16 direction;  // unit vectors to the light
  Floats16 distance;    // infinity for directional lights
  Vectors16 reflected;
};

// Returns the lanes for which the light matters; only they are written. direct() is the sum, over
// lights in ascending order, of `reflected` times what arrives.
LaneMask reflect_light(const BatchShader& shader, std::size_t light, const Surfaces& surfaces,
                       const Vectors16& views, LaneMask lanes, Arriving& arriving);

// reflect(), of layers too, with a direction of each lane's own.
void reflect(const Surfaces& surfaces, const Vectors16& views, const Vectors16& directions,
             LaneMask lanes, Vectors16& reflected);

// radiance() of the environment along unit vectors, for rays that met nothing.
void environment_radiance(const BatchShader& shader, const Vectors16& directions, float roughness,
                          LaneMask lanes, Vectors16& colours);

}  // namespace delray::shading
