// Adds up the area of flat triangles at the low end of y and of z and compares both with the
// footprint. Degenerate: a scene with both bases or neither, or without extent along an axis, keeps
// the usual axis of its format.
#include "scenes/geometry/up_axis.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "parallel/parallel_for.h"

namespace delray::scenes::internal {
namespace {

constexpr double kLowest = 0.01;                     // part of the height that counts as the base
constexpr double kFootprint = 1.0 / 7;               // part of the footprint that a base covers
constexpr std::size_t kTrianglesPerBlock = 1 << 14;  // tens of microseconds
constexpr double kFacing = 0.9;  // cosine to the axis of a triangle that faces along it

// Triangles that face up count too: not every file winds them the same way.
FlatAreas flat_areas(const Scene& scene, const Instance& instance, double low_y, double low_z) {
  const Mesh& mesh = scene.meshes[instance.mesh];
  return parallel::parallel_reduce(
      0, mesh.triangles.size(), kTrianglesPerBlock, FlatAreas{},
      [&](std::size_t first, std::size_t last) {
        FlatAreas areas;
        for (std::size_t t = first; t < last; ++t) {
          glm::dvec3 p[3];
          for (int k = 0; k < 3; ++k) {
            const glm::vec3& position = mesh.positions[mesh.triangles[t][k]];
            p[k] = instance.transform * glm::vec4(position, 1.0F);
          }
          const bool on_y = std::max({p[0].y, p[1].y, p[2].y}) <= low_y;
          const bool on_z = std::max({p[0].z, p[1].z, p[2].z}) <= low_z;
          if (!on_y && !on_z) continue;
          const glm::dvec3 twice = glm::cross(p[1] - p[0], p[2] - p[0]);
          const double least = kFacing * glm::length(twice);
          if (on_y && std::abs(twice.y) >= least) areas.y += 0.5 * std::abs(twice.y);
          if (on_z && std::abs(twice.z) >= least) areas.z += 0.5 * std::abs(twice.z);
        }
        return areas;
      },
      std::plus<>());
}

// Whether so much area at the low end of `axis` is a base.
bool is_base(double area, const glm::dvec3& size, int axis) {
  const double footprint = size[(axis + 1) % 3] * size[(axis + 2) % 3];
  return footprint > 0 && size[axis] > 0 && area / footprint > kFootprint;
}

}  // namespace

FlatAreas flat_areas(const Scene& scene, const geometry::Box3& box) {
  const glm::dvec3 low(box.low), size(box.size());
  FlatAreas areas;
  for (const Instance& instance : scene.instances) {
    areas = areas + flat_areas(scene, instance, low.y + kLowest * size.y, low.z + kLowest * size.z);
  }
  return areas;
}

bool guess_z_up(const geometry::Box3& box, const FlatAreas& areas, bool usual) {
  const glm::dvec3 size(box.size());
  const bool on_y = is_base(areas.y, size, 1), on_z = is_base(areas.z, size, 2);
  return on_y == on_z ? usual : on_z;
}

bool guess_z_up(const Scene& scene, bool usual) {
  const geometry::Box3 box = bounds(scene);
  return guess_z_up(box, flat_areas(scene, box), usual);
}

}  // namespace delray::scenes::internal
