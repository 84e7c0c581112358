#include "raytrace/bsdf.h"

#include "raytrace/optics.h"

namespace delray::raytrace {
namespace {

using shading::clamp01;
using shading::kInversePi;
using shading::kPi;

// The least height of the viewer over the shading normal's horizon.
constexpr float kLowest = 1e-3F;

// Within this of 1 a ratio of indices bends light by less than a pixel.
constexpr float kSameDensity = 1e-3F;

// Directions closer than this to the plane of a normal belong to neither side.
constexpr float kLeastHeight = 1e-6F;

float mean(const glm::vec3& v) { return (v.x + v.y + v.z) * (1.0F / 3.0F); }

// The unit normal, or one between it and the viewer from which the viewer is above the horizon.
glm::vec3 towards(const glm::vec3& normal, const glm::vec3& view) {
  const float cosine = glm::dot(normal, view);
  if (cosine >= kLowest) return normal;
  const glm::vec3 turned = normal + view * (2.0F * kLowest - cosine);
  return turned * (1.0F / std::sqrt(glm::dot(turned, turned)));
}

// What the interface does to light that meets it at a microscopic normal.
struct Interface {
  glm::vec3 reflected{0.0F}, transmitted{0.0F};
  float reflection_share = 1.0F;  // with which a ray is drawn that is reflected
};

Interface interface_at(const Bsdf& b, float cosine) {
  Interface result;
  result.reflected = shading::fresnel(b.lobes, clamp01(cosine));
  if (b.glass <= 0.0F) return result;
  const float f = refracted({0.0F, 0.0F, 1.0F}, {0.0F, 0.0F, cosine}, b.ratio).reflected;
  result.reflected += (glm::vec3(f) - result.reflected) * b.glass;
  result.transmitted = b.transmitted * (1.0F - f);
  const float r = mean(result.reflected), t = mean(result.transmitted);
  result.reflection_share = t > 0.0F ? r / (r + t) : 1.0F;
  return result;
}

// The share of light along v that a rough surface does not hide (Smith), times 2 over it:
// 1 + lambda.
float masking(float cosine, float a2) {
  return 0.5F + 0.5F * std::sqrt(1.0F + a2 * (1.0F / (cosine * cosine) - 1.0F));
}

// The distribution of microscopic normals (GGX).
float distribution(const glm::vec3& half, float a2) {
  // half.z^2 (a2 - 1) + 1, with the digits that are left when half.z is close to 1.
  const float spread = half.x * half.x + half.y * half.y + half.z * half.z * a2;
  return a2 * kInversePi / (spread * spread);
}

// A microscopic normal with density distribution * dot(view, half) / (view.z * masking).
glm::vec3 visible_normal(const glm::vec3& view, float alpha, const glm::vec2& u) {
  glm::vec3 stretched(alpha * view.x, alpha * view.y, view.z);
  stretched *= 1.0F / std::sqrt(glm::dot(stretched, stretched));
  const float z = (1.0F - u.y) * (1.0F + stretched.z) - stretched.z;
  const float sine = std::sqrt(std::max(0.0F, 1.0F - z * z));
  const shading::SinCos phi = shading::sin_cos(2.0F * kPi * u.x);
  const glm::vec3 cap(sine * phi.cos, sine * phi.sin, z);
  const glm::vec3 sum = cap + stretched;
  const glm::vec3 half(alpha * sum.x, alpha * sum.y, std::max(sum.z, 1e-7F));
  return half * (1.0F / std::sqrt(glm::dot(half, half)));
}

// `light` in the frame, above it.
BsdfValue reflected_value(const Bsdf& b, const glm::vec3& light) {
  BsdfValue result;
  const float n_l = light.z, n_v = b.view.z;
  const glm::vec3 in = glm::vec3(1.0F) - shading::fresnel(b.lobes, std::min(n_l, 1.0F));
  const glm::vec3 out = glm::vec3(1.0F) - shading::fresnel(b.lobes, std::min(n_v, 1.0F));
  result.value = b.lobes.diffuse * (b.lobes.entering * kInversePi) * (in * out) * n_l;
  result.pdf = b.diffuse_share * n_l * kInversePi;
  if (b.smooth) return result;
  const glm::vec3 sum = b.view + light;
  const float length2 = std::max(glm::dot(sum, sum), shading::kLeastSum);
  const glm::vec3 half = sum * (1.0F / std::sqrt(length2));
  const float cosine = std::min(0.5F * std::sqrt(length2), 1.0F);
  const float a2 = b.lobes.alpha * b.lobes.alpha;
  const Interface at = interface_at(b, cosine);
  const float d = distribution(half, a2);
  const float seen = masking(n_v, a2), lit = masking(n_l, a2);
  result.value += at.reflected * (d / (4.0F * n_v * (seen + lit - 1.0F)));
  result.pdf += (1.0F - b.diffuse_share) * at.reflection_share * d / (4.0F * n_v * seen);
  return result;
}

// `light` in the frame, below it. The viewer's index of refraction is taken as `ratio`, the other
// as 1.
BsdfValue transmitted_value(const Bsdf& b, const glm::vec3& light) {
  if (b.smooth || b.straight || b.glass <= 0.0F) return {};
  glm::vec3 half = b.view * b.ratio + light;
  const float length2 = glm::dot(half, half);
  if (!(length2 > shading::kLeastSum * kSameDensity)) return {};
  // On the viewer's side of the surface.
  half *= std::copysign(1.0F / std::sqrt(length2), half.z);
  const float v_h = glm::dot(b.view, half), l_h = -glm::dot(light, half);
  if (!(v_h > 0.0F && l_h > 0.0F)) return {};
  const float a2 = b.lobes.alpha * b.lobes.alpha;
  const Interface at = interface_at(b, v_h);
  const float seen = masking(b.view.z, a2), lit = masking(-light.z, a2);
  // Density of the normal, as seen, times how fast it turns with the direction.
  const float density = distribution(half, a2) * v_h * l_h / (b.view.z * length2);
  return {at.transmitted * (density / (seen + lit - 1.0F)),
          (1.0F - b.diffuse_share) * (1.0F - at.reflection_share) * density / seen};
}

BsdfValue value(const Bsdf& b, const glm::vec3& light) {
  if (light.z > kLeastHeight) return reflected_value(b, light);
  if (light.z < -kLeastHeight) return transmitted_value(b, light);
  return {};
}

// Whether a direction lies on the same side of both normals.
bool fits(const Bsdf& b, const glm::vec3& world, float local_z) {
  return glm::dot(world, b.geometric_normal) * local_z > 0.0F;
}

// From a microscopic normal to a direction, or to none.
BsdfSample through_interface(const Bsdf& b, float choice, const glm::vec3& half) {
  const float v_h = glm::dot(b.view, half);
  if (!(v_h > 0.0F)) return {};
  const Interface at = interface_at(b, v_h);
  const float interface_share = 1.0F - b.diffuse_share;
  BsdfSample result;
  glm::vec3 light;
  if (choice < at.reflection_share) {
    light = half * (2.0F * v_h) - b.view;
    if (light.z <= kLeastHeight) return {};
    result.delta = b.smooth;
    if (b.smooth) result.weight = at.reflected / (at.reflection_share * interface_share);
  } else {
    result.transmitted = true;
    light = b.straight ? -b.view : refracted(b.view, half, b.ratio).direction;
    if (light.z >= -kLeastHeight) return {};
    result.delta = b.smooth || b.straight;
    if (result.delta) {
      result.weight = at.transmitted / ((1.0F - at.reflection_share) * interface_share);
    }
  }
  result.direction = b.frame.to_world(light);
  if (result.delta) {
    if (!fits(b, result.direction, light.z)) return {};
    return result;
  }
  return result;
}

}  // namespace

Bsdf make_bsdf(const shading::Surface& surface, const glm::vec3& view) {
  Bsdf b;
  b.frame = Frame(towards(surface.normal, view));
  b.geometric_normal = surface.geometric_normal;
  b.view = b.frame.to_local(view);
  b.view.z = std::max(b.view.z, 0.5F * kLowest);
  b.lobes = shading::lobes(surface);
  b.glass = clamp01(surface.transmission) * (1.0F - clamp01(surface.metallic));
  b.transmitted = surface.base_colour * b.glass;
  b.ratio = surface.front ? 1.0F / surface.ior : surface.ior;
  b.smooth = b.lobes.roughness < shading::kMinRoughness;
  b.straight = std::abs(b.ratio - 1.0F) < kSameDensity;
  const float diffuse = mean(b.lobes.diffuse);
  const glm::vec3 specular =
      b.smooth ? shading::fresnel(b.lobes, b.view.z) : shading::specular_albedo(b.lobes, b.view.z);
  const float others = mean(specular) * (1.0F - b.glass) + std::max(b.glass, mean(b.transmitted));
  b.black = !(diffuse + others > 0.0F);
  b.diffuse_share = b.black ? 1.0F : diffuse / (diffuse + others);
  return b;
}

BsdfValue evaluate(const Bsdf& bsdf, const glm::vec3& light) {
  const glm::vec3 local = bsdf.frame.to_local(light);
  return fits(bsdf, light, local.z) ? value(bsdf, local) : BsdfValue{};
}

BsdfSample sample(const Bsdf& bsdf, float lobe, const glm::vec2& u) {
  if (bsdf.black) return {};
  BsdfSample result;
  if (lobe < bsdf.diffuse_share) {
    result.direction = bsdf.frame.to_world(cosine_direction(u));
  } else {
    const float choice =
        std::min((lobe - bsdf.diffuse_share) / (1.0F - bsdf.diffuse_share), 1.0F - 0x1p-24F);
    const glm::vec3 half =
        bsdf.smooth ? glm::vec3(0, 0, 1) : visible_normal(bsdf.view, bsdf.lobes.alpha, u);
    result = through_interface(bsdf, choice, half);
    if (result.delta || result.direction == glm::vec3(0.0F)) return result;
  }
  const BsdfValue found = evaluate(bsdf, result.direction);
  result.pdf = found.pdf;
  if (found.pdf > 0.0F) result.weight = found.value / found.pdf;
  return result;
}

}  // namespace delray::raytrace
