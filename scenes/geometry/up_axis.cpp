// Adds up the area of flat triangles at the low end of y and of z and compares both with the
// footprint. Degenerate: a scene with both bases or neither, or without extent along an axis, keeps
// the usual axis of its format.
#include "scenes/geometry/up_axis.h"

#include <algorithm>
#include <cmath>

namespace delray::scenes::internal {
namespace {

constexpr double kLowest = 0.01;        // part of the height that counts as the base
constexpr double kFootprint = 1.0 / 7;  // part of the footprint that a base covers
constexpr double kFacing = 0.9;         // cosine to the axis of a triangle that faces along it

// The part of the box's footprint that lies flat at the low end of `axis`. Triangles that face up
// count too: not every file winds them the same way.
double flat_base(const Scene& scene, const geometry::Box3& box, int axis) {
  const glm::dvec3 size(box.size());
  const double limit = static_cast<double>(box.low[axis]) + kLowest * size[axis];
  double area = 0;
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    for (const glm::uvec3& t : mesh.triangles) {
      glm::dvec3 p[3];
      for (int k = 0; k < 3; ++k) {
        p[k] = instance.transform * glm::vec4(mesh.positions[t[k]], 1.0F);
      }
      if (std::max({p[0][axis], p[1][axis], p[2][axis]}) > limit) continue;
      const glm::dvec3 twice = glm::cross(p[1] - p[0], p[2] - p[0]);
      const double along = std::abs(twice[axis]);
      if (along >= kFacing * glm::length(twice)) area += 0.5 * along;
    }
  }
  const double footprint = size[(axis + 1) % 3] * size[(axis + 2) % 3];
  return footprint > 0 && size[axis] > 0 ? area / footprint : 0;
}

}  // namespace

bool guess_z_up(const Scene& scene, bool usual) {
  const geometry::Box3 box = bounds(scene);
  const bool on_y = flat_base(scene, box, 1) > kFootprint;
  const bool on_z = flat_base(scene, box, 2) > kFootprint;
  return on_y == on_z ? usual : on_z;
}

}  // namespace delray::scenes::internal
