// Finds the space of every instance: Embree's matrix for rays, the camera's axes in it, and how far
// Embree's rounding may put rays there from those in the world.
#include "raytrace/first_hits/ray_space.h"

#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/first_hits/ray_space.cpp"
#include <hwy/foreach_target.h>
// Highway's own header comes after it.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace delray::raytrace {
namespace HWY_NAMESPACE {

// A point in the space of an instance, rounded as Embree's transforms of rays are.
glm::vec3 local_point(const glm::mat4x3& m, const glm::vec3& p) {
  namespace hn = hwy::HWY_NAMESPACE;
  const HWY_CAPPED(float, 1) d;
  const auto set = [&](float x) { return hn::Set(d, x); };
  glm::vec3 result;
  for (int k = 0; k < 3; ++k) {
    result[k] = hn::GetLane(hn::MulAdd(
        set(p.x), set(m[0][k]),
        hn::MulAdd(set(p.y), set(m[1][k]), hn::MulAdd(set(p.z), set(m[2][k]), set(m[3][k])))));
  }
  return result;
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::raytrace
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace delray::raytrace {

HWY_EXPORT(local_point);

namespace {

double largest_stretch(const glm::dmat3& m) {  // at least
  return std::sqrt(glm::dot(m[0], m[0]) + glm::dot(m[1], m[1]) + glm::dot(m[2], m[2]));
}

RaySpace world_space(const scenes::View& view, float longest) {
  RaySpace space;
  space.origin = view.eye;
  space.right = view.right;
  space.up = view.up;
  space.forward = view.forward;
  space.longest = longest;
  return space;
}

RaySpace local_space(const GeometryInstance& instance, const glm::mat4x3& to_local,
                     const scenes::View& view, float longest) {
  RaySpace space;
  space.is_world = false;
  space.to_local = to_local;
  space.origin = HWY_DYNAMIC_DISPATCH(local_point)(to_local, view.eye);
  const glm::dmat3 out(glm::mat3(instance.to_world)), in(glm::mat3{to_local});
  const glm::dmat3 across = glm::transpose(out);
  space.right = across * glm::dvec3(view.right);
  space.up = across * glm::dvec3(view.up);
  space.forward = across * glm::dvec3(view.forward);
  const double stretch = largest_stretch(out), shrink = largest_stretch(in);
  space.longest = static_cast<float>(1.001 * shrink * longest);
  space.volume = static_cast<float>(0.99 * std::abs(glm::determinant(in)));
  // The inverse is rounded, and so is what it makes of rays: by four roundings of its terms.
  constexpr double kRounding = 0x1p-22;
  const double condition = stretch * shrink;
  const double inverse = largest_stretch(in * out - glm::dmat3(1.0)) + 2 * kRounding * condition;
  const glm::dvec3 eye(view.eye), moved(to_local[3]);
  const glm::dvec3 back = out * glm::dvec3(space.origin) + glm::dvec3(instance.to_world[3]) - eye;
  // Boxes of instances in the world are rounded as well.
  const double box = kRounding * (instance.transform_scale + glm::length(eye));
  const double length = shrink * (glm::length(back) + box) +
                        kRounding * (shrink * glm::length(eye) + glm::length(moved));
  space.off_angle = static_cast<float>(condition * inverse);
  space.off_length = static_cast<float>(length);
  space.forward_length = glm::length(space.forward);
  const bool fine = std::isfinite(space.longest) && std::isfinite(space.off_angle) &&
                    std::isfinite(space.off_length) && space.forward_length > 0.0F;
  if (!fine) space.forward_length = 0.0F;
  return space;
}

}  // namespace

RaySpaces ray_spaces(const EmbreeScene& tree, std::span<const GeometryInstance> instances,
                     const scenes::View& view, float longest) {
  const std::vector<glm::mat4x3> to_local = tree.to_local(instances);
  RaySpaces result{instances, {world_space(view, longest)}, {}};
  result.numbers.assign(instances.size(), 0);
  for (std::size_t i = 0; i < instances.size(); ++i) {
    if (!instances[i].instanced || instances[i].mesh == nullptr) continue;
    result.numbers[i] = static_cast<std::uint32_t>(result.spaces.size());
    result.spaces.push_back(local_space(instances[i], to_local[i], view, longest));
    result.spaces.back().box = tree.local_bounds(static_cast<std::uint32_t>(i));
  }
  return result;
}

}  // namespace delray::raytrace
#endif
