// Keeps the least hit by distance, instance and triangle, and collects what shadow rays pass.
// Degenerate: a shadow ray through too many layers is occluded.
#include "raytrace/scene/embree_filters.h"

namespace delray::raytrace {
namespace {

Hit hit_of(const EmbreeScene::State& scene, const RTCFilterFunctionNArguments* arguments,
           unsigned i) {
  const unsigned n = arguments->N;
  const unsigned instance = RTCHitN_instID(arguments->hit, n, i, 0);
  const unsigned geometry = RTCHitN_geomID(arguments->hit, n, i);
  return {RTCRayN_tfar(arguments->ray, n, i),
          instance != kMiss ? scene.instance_of(instance, geometry) : geometry,
          RTCHitN_primID(arguments->hit, n, i), RTCHitN_u(arguments->hit, n, i),
          RTCHitN_v(arguments->hit, n, i)};
}

}  // namespace

void find_least(const RTCFilterFunctionNArguments* arguments) {
  const auto* query = reinterpret_cast<const Query*>(arguments->context);
  const unsigned n = arguments->N;
  for (unsigned i = 0; i < n; ++i) {
    if (arguments->valid[i] == 0) continue;
    arguments->valid[i] = 0;
    const Hit hit = hit_of(*query->scene, arguments, i);
    Nearest& least = query->nearest[RTCRayN_id(arguments->ray, n, i)];
    const std::span<const GeometryNumbers> numbers = query->scene->numbers;
    if (least.hit.triangle != kMiss &&
        !is_nearer(in_whole_scene(hit, numbers), in_whole_scene(least.hit, numbers)))
      continue;
    least = {hit, RTCHitN_Ng_x(arguments->hit, n, i), RTCHitN_Ng_y(arguments->hit, n, i),
             RTCHitN_Ng_z(arguments->hit, n, i), RTCHitN_instID(arguments->hit, n, i, 0) != kMiss};
  }
}

void note_and_pass(const RTCFilterFunctionNArguments* arguments) {
  auto* query = reinterpret_cast<Query*>(arguments->context);
  const auto* opaque = static_cast<const std::uint64_t*>(arguments->geometryUserPtr);
  const unsigned n = arguments->N;
  for (unsigned i = 0; i < n; ++i) {
    if (arguments->valid[i] == 0) continue;
    const unsigned triangle = RTCHitN_primID(arguments->hit, n, i);
    if (opaque != nullptr && (opaque[triangle / 64] >> (triangle % 64) & 1) != 0) continue;
    const Hit hit = hit_of(*query->scene, arguments, i);
    SeeThrough& passed = query->passed[RTCRayN_id(arguments->ray, n, i)];
    bool known = false;
    for (int j = 0; j < passed.count; ++j) {
      known = known ||
              (passed.hits[j].instance == hit.instance && passed.hits[j].triangle == hit.triangle);
    }
    if (!known) {
      if (passed.count == SeeThrough::kMost) continue;  // stays valid: ends the ray
      passed.hits[passed.count++] = hit;
    }
    arguments->valid[i] = 0;
  }
}

}  // namespace delray::raytrace
