// Points as a scene: their triangulation, or some of them as spots.
#include "apps/input/coloured_points.h"

#include <vector>

#include "apps/input/colour_by.h"
#include "apps/input/relief.h"
#include "apps/input/show_as.h"
#include "apps/options/list.h"

namespace delray::apps {
namespace {

scenes::Scene coloured_around(const SceneInput& input, const delaunay::PointCloud& points,
                              const delaunay::Triangulation& triangulation,
                              const Inliers& inliers) {
  scenes::Scene scene = relief(points, triangulation, inliers, input.exaggeration);
  set_up_axis(input, scene);
  colour_by(scene, colouring(input, points, triangulation.size() == 0), &points);
  if (scenes::ColourScale* const scale = scene.colour_scale ? &*scene.colour_scale : nullptr;
      scale != nullptr && scale->title == "height") {
    const auto bottom = static_cast<float>(scene.origin.z);
    const auto stretched = static_cast<float>(input.exaggeration);
    for (float* const end : {&scale->low, &scale->high})
      *end = bottom + (*end - bottom) / stretched;
  }
  return scene;
}

// Row i of the part is row i * step of the whole.
template <class T>
std::vector<T> every_row(std::size_t step, const std::vector<T>& whole) {
  std::vector<T> part;
  for (std::size_t i = 0; i < whole.size(); i += step) part.push_back(whole[i]);
  return part;
}

}  // namespace

void set_up_axis(const SceneInput& input, scenes::Scene& scene) {
  if (!input.up.empty()) scene.z_up = input.up == "z";
}

scenes::Scene coloured(const SceneInput& input, const delaunay::PointCloud& points,
                       const delaunay::Triangulation& triangulation) {
  const Inliers inliers = find_inliers(points);
  check_reach(input, points.positions, inliers.box.centre());
  warn_of_outliers(input, inliers, points.size());
  return coloured_around(input, points, triangulation, inliers);
}

scenes::Scene coloured_preview(SceneInput input, const delaunay::PointCloud& points) {
  const std::size_t step = points.size() / kPointsOfPreview + 1;
  const delaunay::PointCloud part = {.has_z = points.has_z,
                                     .positions = every_row(step, points.positions),
                                     .colours = every_row(step, points.colours),
                                     .intensity = every_row(step, points.intensity),
                                     .intensity_unit = points.intensity_unit,
                                     .classification = every_row(step, points.classification),
                                     .returns = every_row(step, points.returns),
                                     .geographic = points.geographic,
                                     .warnings = {}};
  if (input.colour_by == "simplex") input.colour_by.clear();
  scenes::Scene scene = coloured_around(input, part, {}, find_inliers(points));
  show_points(find_entry(show_as(), "points", "--show-as"), size_of(input), scene);
  return scene;
}

}  // namespace delray::apps
