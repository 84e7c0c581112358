// Asks Embree for the matrices by which it brings rays to the space of instances, which it tells
// nobody: instances of one box that every ray meets, of which a function is told the ray in the
// box's space: a ray from the origin along an axis arrives with the matrix's columns, unrounded,
// since every product that takes part is with 0 or 1.
//
// Degenerate: boxes of singular transforms are met by no ray, or the ray is not finite.
#include <glm/glm.hpp>
#include <limits>

#include "raytrace/scene/embree_filters.h"
#include "raytrace/scene/embree_objects.h"

namespace delray::raytrace {
namespace {

// Half the side of the box: the world's origin lies in it unless a transform moves further than so
// many times its scale.
constexpr float kFar = 1e9F;

// A query that is told of every instance on the way.
struct Asked {
  Context context;
  int axis = 0;
  std::span<glm::mat4x3> matrices = {};
};

void bound(const RTCBoundsFunctionArguments* arguments) {
  *arguments->bounds_o = {-kFar, -kFar, -kFar, 0.0F, kFar, kFar, kFar, 0.0F};
}

// Notes the ray and reports no hit, so that all instances are met.
void note_ray(const RTCIntersectFunctionNArguments* arguments) {
  const auto* asked = reinterpret_cast<const Asked*>(arguments->context);
  const unsigned n = arguments->N, instance = asked->context.instID[0];
  RTCRayN* ray = RTCRayHitN_RayN(arguments->rayhit, n);
  for (unsigned i = 0; i < n; ++i) {
    if (arguments->valid[i] == 0 || instance >= asked->matrices.size()) continue;
    glm::mat4x3& matrix = asked->matrices[instance];
    matrix[asked->axis] = {RTCRayN_dir_x(ray, n, i), RTCRayN_dir_y(ray, n, i),
                           RTCRayN_dir_z(ray, n, i)};
    matrix[3] = {RTCRayN_org_x(ray, n, i), RTCRayN_org_y(ray, n, i), RTCRayN_org_z(ray, n, i)};
  }
}

void ask(RTCScene tree, Asked& asked) {
  RTCRayHit hit{};
  hit.ray.dir_x = asked.axis == 0 ? 1.0F : 0.0F;
  hit.ray.dir_y = asked.axis == 1 ? 1.0F : 0.0F;
  hit.ray.dir_z = asked.axis == 2 ? 1.0F : 0.0F;
  hit.ray.tfar = std::numeric_limits<float>::infinity();
  hit.ray.mask = 0xFFFFFFFFU;
  hit.hit.geomID = hit.hit.primID = hit.hit.instID[0] = kMiss;
#if RTC_VERSION_MAJOR >= 4
  rtcInitRayQueryContext(&asked.context);
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &asked.context;
  rtcIntersect1(tree, &hit, &arguments);
#else
  rtcInitIntersectContext(&asked.context);
  rtcIntersect1(tree, &asked.context, &hit);
#endif
}

Tree box_tree(RTCDevice device) {
  Tree tree(rtcNewScene(device));
  RTCGeometry box = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(box, 1);
  rtcSetGeometryBoundsFunction(box, bound, nullptr);
  rtcSetGeometryIntersectFunction(box, note_ray);
  rtcCommitGeometry(box);
  rtcAttachGeometryByID(tree.get(), box, 0);
  rtcReleaseGeometry(box);
  commit(device, tree.get());
  return tree;
}

}  // namespace

std::vector<glm::mat4x3> EmbreeScene::to_local(std::span<const GeometryInstance> instances) const {
  std::vector<glm::mat4x3> matrices(instances.size(), glm::mat4x3(1.0F));
  RTCDevice device = state_->device;
  Tree box, top;
  for (std::uint32_t i = 0; i < instances.size(); ++i) {
    if (!instances[i].instanced || instances[i].mesh == nullptr) continue;
    if (!top) {
      box = box_tree(device);
      top.reset(rtcNewScene(device));
    }
    matrices[i] = glm::mat4x3(std::numeric_limits<float>::quiet_NaN());
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, box.get());
    rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, &instances[i].to_world);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(top.get(), geometry, i);
    rtcReleaseGeometry(geometry);
  }
  if (!top) return matrices;
  commit(device, top.get());
  for (int axis = 0; axis < 3; ++axis) {
    Asked asked;
    asked.axis = axis;
    asked.matrices = matrices;
    ask(top.get(), asked);
  }
  return matrices;
}

}  // namespace delray::raytrace
