// Meshes of points.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "scenes/scene.h"

namespace delray::scenes {

// Makes points of all vertices: neighbours follow each other (point_order.h), vertices and
// attributes with them. O(n log n), parallel. `most` is a box around nearly all of them, where some
// are far off: otherwise the curve would not tell the others apart.
void make_points(Mesh& mesh, const Shape& shape, const geometry::Box3& most = {});

// How far neighbours of a cloud are from each other, were they a square lattice on a surface: the
// root of the area that each has, as the distances to eighth neighbours tell (of n in a disc of
// radius r each has r^2 pi / n). The median over some hundred runs of points, so that lines of a
// scanner, gaps and strays hardly matter; 0 where most points coincide, or there is one only.
//
// REQUIRES: make_points made the mesh.
float point_spacing(const Mesh& mesh);

// The same of points that come in parts, in the order of the mesh.
class PointSpacing {
 public:
  explicit PointSpacing(std::size_t n) : n_(n) {}  // points in all
  void add(std::span<const glm::vec3> points);
  float spacing();  // after the last

 private:
  std::size_t step() const;  // from the first point of a run to that of the next
  void end_run();

  std::size_t n_, next_ = 0;
  std::vector<glm::vec3> run_;    // the one at hand
  std::vector<float> distances_;  // of runs, squared
};

// Makes radii in units of the world of those in pixels, for renderers of rays: what a pixel of a
// frame of this height is where the camera looks at. Of a mesh, as its first instance places it.
void set_radii_in_units(Scene& scene, const Camera& camera, int height);

}  // namespace delray::scenes
