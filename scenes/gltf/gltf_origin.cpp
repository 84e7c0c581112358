// Compares how far vertices, nodes and the placed scene reach from 0 with the scene's diagonal, and
// moves meshes to their own centres if any of these is far.
#include "scenes/gltf/gltf_origin.h"

#include <algorithm>
#include <vector>

#include "scenes/animation/followers.h"
#include "scenes/files/vertex_values.h"
#include "scenes/geometry/origin.h"

namespace delray::scenes::internal {
namespace {

// Around the corners of `box`, placed by `world`.
geometry::Box3d placed(const geometry::Box3d& box, const glm::dmat4& world) {
  geometry::Box3d result;
  for (int corner = 0; corner < 8 && !box.empty(); ++corner) {
    const glm::dvec3 p(corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
                       corner & 4 ? box.high.z : box.low.z);
    result.include(glm::dvec3(world * glm::dvec4(p, 1.0)));
  }
  return result;
}

// The reach of things from 0 before and after they are placed.
struct Reach {
  geometry::Box3d box;  // of all instances
  double vertices = 0;  // without the translation
  double nodes = 0;     // the translation
};

Reach reach_of(const Scene& scene, std::span<const glm::dmat4> worlds,
               std::span<const geometry::Box3d> boxes) {
  Reach reach;
  for (std::size_t i = 0; i < worlds.size(); ++i) {
    const geometry::Box3d& box = boxes[scene.instances[i].mesh];
    const glm::dmat4 linear{glm::dmat3(worlds[i])};
    const glm::dvec3 translation(worlds[i][3]);
    reach.box.include(placed(box, worlds[i]));
    reach.vertices = std::max(reach.vertices, internal::reach_of(placed(box, linear)));
    reach.nodes = std::max(reach.nodes, internal::reach_of({translation, translation}));
  }
  return reach;
}

// False also for what is not finite, or too large.
bool exceeds(double distance, double limit) {
  return distance > limit && distance <= kLargestCoordinate;
}

bool reaches_far(const Reach& reach) {
  return exceeds(std::max({internal::reach_of(reach.box), reach.vertices, reach.nodes}),
                 kFar * glm::length(reach.box.size()));
}

}  // namespace

bool is_far(const Scene& scene, std::span<const glm::dmat4> worlds,
            std::span<const geometry::Box3d> boxes) {
  return reaches_far(reach_of(scene, worlds, boxes));
}

std::vector<glm::dvec3> place_instances(const Source& source, std::span<const glm::dmat4> worlds,
                                        Scene& scene) {
  std::vector<geometry::Box3d> boxes;
  for (const Mesh& mesh : scene.meshes) boxes.push_back(box_of(mesh.positions));
  const Reach reach = reach_of(scene, worlds, boxes);
  const bool far = reaches_far(reach);
  if (far) warn_if_coarse(source, reach.vertices, glm::length(reach.box.size()));
  if (far) scene.origin = origin_of(reach.box);
  for (std::size_t i = 0; i < worlds.size(); ++i) {
    Instance& instance = scene.instances[i];
    const glm::dvec3 centre = far ? boxes[instance.mesh].centre() : glm::dvec3(0);
    instance.transform = placed_at(worlds[i], centre, scene.origin);
  }
  for (std::size_t m = 0; far && m < boxes.size(); ++m) {
    make_relative_to(boxes[m].centre(), scene.meshes[m].positions);
  }
  std::vector<glm::dvec3> centres(boxes.size(), glm::dvec3(0));
  for (std::size_t m = 0; far && m < boxes.size(); ++m) centres[m] = boxes[m].centre();
  return centres;
}

}  // namespace delray::scenes::internal
