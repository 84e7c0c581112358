// The extent of a scene, which cameras are fitted to.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "geometry/box.h"
#include "scenes/scene.h"

namespace delray::scenes {

// For each direction the point farthest along it, of several the one that is lexicographically
// greatest; no points at all if there are none. The result depends on no order: the farthest of the
// results for all parts of a scene, on whatever ranks they are, is the result for the scene.
using FarthestPoints =
    std::function<std::vector<glm::dvec3>(std::span<const glm::dvec3> directions)>;

// Replaces farthest[i] by candidates[i] where that is farther along directions[i], or is the
// greater of two equally far.
// REQUIRES: the sizes are equal, or one of `farthest` and `candidates` is empty, for no points.
void keep_farthest(std::span<const glm::dvec3> directions,
                   const std::vector<glm::dvec3>& candidates, std::vector<glm::dvec3>& farthest);

// The corners of a box; an empty box has none.
std::vector<glm::dvec3> farthest_corners(const geometry::Box3& box,
                                         std::span<const glm::dvec3> directions);

// The box of all points.
geometry::Box3 bounds(const FarthestPoints& farthest);

// The corners of a scene's triangles, of those in Scene::framed where that is not empty. Refers to
// the scene.
class Extent {
 public:
  // O(triangles), parallel over meshes.
  explicit Extent(const Scene& scene);

  // As FarthestPoints. O(vertices * directions) for a single instance; of many, only those are
  // looked into whose boxes reach far enough. Parallel.
  std::vector<glm::dvec3> operator()(std::span<const glm::dvec3> directions) const;

 private:
  struct Corners {
    geometry::Box3 box;               // of the vertices that triangles have
    std::vector<std::uint8_t> drawn;  // whether triangles have vertex i; empty: all of them
  };

  std::vector<glm::dvec3> within(const Instance& instance,
                                 std::span<const glm::dvec3> directions) const;

  const Scene& scene_;
  std::vector<Corners> meshes_;
};

// An Extent that is made when it is first asked. Refers to the scene.
FarthestPoints farthest_points(const Scene& scene);

}  // namespace delray::scenes
