// Makes one mesh of the points: the triangulation's triangles in 2D, the facets of the hull in 3D.
#include "apps/input/relief.h"

#include <algorithm>
#include <vector>

#include "delaunay/write_mesh.h"

namespace delray::apps {
namespace {

std::vector<glm::uvec3> surface_of(const delaunay::Triangulation& triangulation) {
  const std::vector<std::uint32_t> hull =
      triangulation.dim == 3 ? hull_facets(triangulation) : std::vector<std::uint32_t>{};
  const std::vector<std::uint32_t>& corners =
      triangulation.dim == 3 ? hull : triangulation.vertices;
  std::vector<glm::uvec3> triangles(corners.size() / 3);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    triangles[i] = from_lowest_row({corners[3 * i], corners[3 * i + 1], corners[3 * i + 2]},
                                   [](std::uint32_t row) { return row; });
  }
  return triangles;
}

// values[i] for each i that is kept, of an attribute that there may be.
template <class T>
void keep(const std::vector<bool>& kept, std::vector<T>& values) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (kept[i]) values[count++] = values[i];
  values.resize(count);
}

}  // namespace

scenes::Scene around_relief(const Inliers& inliers, double exaggeration) {
  scenes::Scene scene;
  scene.z_up = true;
  scene.origin = inliers.box.centre();
  if (inliers.outside > 0) {
    scene.framed.include(in_relief(inliers.box.low, scene.origin, exaggeration));
    scene.framed.include(in_relief(inliers.box.high, scene.origin, exaggeration));
  }
  scene.instances.push_back({});
  scene.materials.emplace_back();
  scene.materials.back().roughness = 0.9F;
  return scene;
}

scenes::Scene relief(const delaunay::PointCloud& points,
                     const delaunay::Triangulation& triangulation, const Inliers& inliers,
                     double exaggeration) {
  scenes::Scene scene = around_relief(inliers, exaggeration);
  scenes::Mesh mesh;
  mesh.name = kReliefName;
  mesh.positions.reserve(points.size());
  for (const glm::dvec3& p : points.positions)
    mesh.positions.push_back(in_relief(p, scene.origin, exaggeration));
  mesh.triangles = surface_of(triangulation);
  scene.meshes.push_back(std::move(mesh));
  return scene;
}

void keep_corners(delaunay::PointCloud& points, delaunay::Triangulation& triangulation) {
  std::vector<bool> kept(points.size());
  for (const std::uint32_t corner : triangulation.vertices) kept[corner] = true;
  if (std::find(kept.begin(), kept.end(), false) == kept.end()) return;
  std::vector<std::uint32_t> number(points.size());
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    number[i] = count;
    count += kept[i] ? 1 : 0;
  }
  for (std::uint32_t& corner : triangulation.vertices) corner = number[corner];
  keep(kept, points.positions);
  keep(kept, points.colours);
  keep(kept, points.intensity);
  keep(kept, points.classification);
  keep(kept, points.returns);
}

}  // namespace delray::apps
