// Points and their triangulation as a scene with colours, and some of the points for a start.
#pragma once

#include <cstddef>

#include "apps/input/scene_input.h"
#include "delaunay/points.h"
#include "delaunay/triangulation.h"
#include "scenes/scene.h"

namespace delray::apps {

// Which way is up, where the input says so.
void set_up_axis(const SceneInput& input, scenes::Scene& scene);

// The points as vertices of the triangulation's triangles (none: of points), coloured as the input
// says. Outliers are told in the log. Throws FileError (check_reach).
scenes::Scene coloured(const SceneInput& input, const delaunay::PointCloud& points,
                       const delaunay::Triangulation& triangulation);

// A preview has about as many points; of no more than that none is worth while.
inline constexpr std::size_t kPointsOfPreview = 100'000;

// Every so many of the points, evenly over their rows, as spots that touch, where all of them will
// be: Scene::origin is that of all. O(n).
scenes::Scene coloured_preview(SceneInput input, const delaunay::PointCloud& points);

}  // namespace delray::apps
