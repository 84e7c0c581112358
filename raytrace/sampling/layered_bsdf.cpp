// Coats and sheens over the lobes of bsdf.cpp. Rarely met, so lane by lane: the same arithmetic on
// every instruction set without further ado.
#include <algorithm>
#include <bit>

#include "raytrace/sampling/base_bsdf.h"
#include "raytrace/sampling/glass_table.h"
#include "raytrace/sampling/warp.h"
#include "shading/microfacets.h"

namespace delray::raytrace {
namespace {

float mean(const glm::vec3& v) { return (v.x + v.y + v.z) * (1.0F / 3.0F); }

// A coat takes its share of the samples, and the diffuse lobe those of the sheen.
void add_layers(const shading::Surfaces& s, const glm::vec3& view, int i, Bsdfs& b) {
  const shading::Layers& layers = b.layers[i] = s.layers[i];
  b.to_viewer.set(i, view);
  const float base = mean(s.diffuse.get(i)) * s.entering[i] + mean(s.mirrored.get(i)) +
                     mean(b.transmitted.get(i)) * layers.below;
  const float sheen = mean(layers.sheen_albedo), coat = layers.coat_albedo;
  if (!(base + sheen + coat > 0.0F)) return;
  b.black &= ~(1U << i);
  b.layered |= 1U << i;
  b.coat_share[i] = coat / (base + sheen + coat);
  if (base + sheen > 0.0F) {
    b.diffuse_share[i] += (1.0F - b.diffuse_share[i]) * (sheen / (base + sheen));
  }
}

// Above the coat and the geometric surface.
bool meets_coat(const Bsdfs& b, int i, const glm::vec3& light) {
  return glm::dot(light, b.layers[i].coat_normal) > 0.0F &&
         glm::dot(light, b.geometric_normal.get(i)) > 0.0F;
}

bool is_smooth_coat(const shading::Layers& layers) {
  return layers.coat_roughness < shading::kMinRoughness;
}

// With which `light` is drawn as mirrored by the coat.
float coat_pdf(const Bsdfs& b, int i, const glm::vec3& light) {
  if (!meets_coat(b, i, light)) return 0.0F;
  const shading::Layers& layers = b.layers[i];
  const glm::vec3 sum = b.to_viewer.get(i) + light;
  const float n_v =
      std::max(glm::dot(layers.coat_normal, b.to_viewer.get(i)), shading::kLeastCosine);
  const float n_l = glm::dot(layers.coat_normal, light), a2 = layers.coat_alpha * layers.coat_alpha;
  const float along = std::max(glm::dot(layers.coat_normal, sum), 0.0F);
  const float peak = shading::ggx_peak(layers.coat_alpha, n_l, n_v, sum, along).value;
  const float seen = shading::masking(n_v, a2), lit = shading::masking(n_l, a2);
  return peak * n_l * ((seen + lit - 1.0F) / seen);
}

// Adds the layers to what lies below them.
void add_layers_value(const Bsdfs& b, int i, const glm::vec3& light, BsdfValues& values) {
  const shading::Layers& layers = b.layers[i];
  const glm::vec3 view = b.to_viewer.get(i);
  const float share = b.coat_share[i];
  glm::vec3 value = values.value.get(i);
  float pdf = values.pdf[i] * (1.0F - share);
  if (!is_smooth_coat(layers) && meets_coat(b, i, light)) {
    value += glm::vec3(shading::reflect_by_coat(layers, view, light));
    pdf += share * coat_pdf(b, i, light);
  }
  if (glm::dot(light, b.geometric_normal.get(i)) > 0.0F) {
    value += shading::reflect_by_sheen(layers, b.z.get(i), view, light);
  }
  values.value.set(i, value);
  values.pdf[i] = pdf;
}

// A direction that the coat mirrors light from.
glm::vec3 sample_coat(const Bsdfs& b, int i, float u, float v) {
  const Frame frame(b.layers[i].coat_normal);
  glm::vec3 view = frame.to_local(b.to_viewer.get(i));
  view.z = std::max(view.z, shading::kLeastCosine);
  const glm::vec3 half = is_smooth_coat(b.layers[i])
                             ? glm::vec3(0, 0, 1)
                             : shading::visible_normal(view, b.layers[i].coat_alpha, u, v);
  return frame.to_world(half * (2.0F * glm::dot(view, half)) - view);
}

}  // namespace

void make_bsdfs(const shading::Surfaces& surfaces, const shading::Vectors16& views,
                shading::LaneMask lanes, Bsdfs& bsdfs) {
  shading::LaneMask rough = make_base_bsdfs(surfaces, views, lanes, bsdfs);
  for (; rough != 0; rough &= rough - 1) {
    const int i = std::countr_zero(rough);
    const float roughness = surfaces.lobe_roughness[i], cosine = std::min(bsdfs.view.z[i], 1.0F);
    bsdfs.glass_scale[i] =
        1.0F / ((bsdfs.thin >> i & 1) != 0 ? pane_albedo(roughness, cosine)
                                           : glass_albedo(bsdfs.ratio[i], roughness, cosine));
  }
  bsdfs.layered = 0;
  for (shading::LaneMask rest = surfaces.layered & lanes; rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    bsdfs.glass_scale[i] *= surfaces.layers[i].below;
    add_layers(surfaces, views.get(i), i, bsdfs);
  }
}

void evaluate(const Bsdfs& bsdfs, const shading::Vectors16& lights, shading::LaneMask lanes,
              BsdfValues& values) {
  evaluate_base(bsdfs, lights, lanes, values);
  for (shading::LaneMask rest = bsdfs.layered & lanes; rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    add_layers_value(bsdfs, i, lights.get(i), values);
  }
}

namespace {

// Of lanes that have layers, with samples of what lies below them where they took none themselves.
void add_layered_samples(const Bsdfs& bsdfs, shading::LaneMask layered, shading::LaneMask coated,
                         BsdfSamples& samples) {
  BsdfValues values;
  evaluate(bsdfs, samples.direction, layered, values);
  for (; layered != 0; layered &= layered - 1) {
    const int i = std::countr_zero(layered);
    const bool by_coat = (coated >> i & 1) != 0;
    const glm::vec3 light = samples.direction.get(i), weight = samples.weight.get(i);
    const float share = bsdfs.coat_share[i];
    const bool nothing = by_coat ? !meets_coat(bsdfs, i, light) : weight == glm::vec3(0.0F);
    const bool delta = by_coat ? is_smooth_coat(bsdfs.layers[i]) : samples.pdf[i] == 0.0F;
    samples.pdf[i] = 0.0F;
    if (nothing || (!delta && !(values.pdf[i] > 0.0F))) {
      samples.weight.set(i, glm::vec3(0.0F));
    } else if (!delta) {
      samples.weight.set(i, values.value.get(i) * (1.0F / values.pdf[i]));
      samples.pdf[i] = values.pdf[i];
    } else if (by_coat) {
      const float cosine = shading::clamp01(glm::dot(bsdfs.layers[i].coat_normal, light));
      samples.weight.set(i,
                         glm::vec3(bsdfs.layers[i].coat * shading::coat_fresnel(cosine) / share));
    } else {
      samples.weight.set(i, weight * (1.0F / (1.0F - share)));
    }
  }
}

}  // namespace

void sample(const Bsdfs& bsdfs, const shading::Floats16& lobe, const shading::Floats16& u,
            const shading::Floats16& v, shading::LaneMask lanes, BsdfSamples& samples) {
  const shading::LaneMask layered = bsdfs.layered & lanes;
  if (layered == 0) {
    sample_base(bsdfs, lobe, u, v, lanes, samples);
    return;
  }
  // The coat takes the end of the numbers; the rest is stretched to all of them.
  shading::Floats16 below = lobe;
  shading::LaneMask coated = 0;
  for (shading::LaneMask rest = layered; rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    const float others = 1.0F - bsdfs.coat_share[i];
    coated |= lobe[i] >= others ? 1U << i : 0U;
    below[i] = std::min(lobe[i] / others, 0x1.fffffep-1F);
  }
  sample_base(bsdfs, below, u, v, lanes, samples);
  samples.transmitted &= ~coated;
  samples.diffuse &= ~coated;
  for (shading::LaneMask rest = coated; rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    samples.direction.set(i, sample_coat(bsdfs, i, u[i], v[i]));
  }
  add_layered_samples(bsdfs, layered, coated, samples);
}

}  // namespace delray::raytrace
