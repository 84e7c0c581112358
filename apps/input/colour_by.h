// --color-by: what the colour of a surface tells.
#pragma once

#include <span>
#include <string_view>

#include "delaunay/points.h"
#include "scenes/scene.h"

namespace delray::apps {

struct ColourBy {
  const char* name;
  const char* description;
  // Gives every mesh vertex colours; see colour_by.
  void (*apply)(scenes::Scene& scene, const delaunay::PointCloud* points);
};

std::span<const ColourBy> colour_bys();

// The colouring that makes a good first picture of these points.
std::string_view default_colour_by(const delaunay::PointCloud& points);

// Gives every mesh of the scene vertex colours. `points` are those that meshes[0] has as vertices,
// or null for a scene that does not come from points. Throws UsageError for a name that is not in
// the table and for attributes that the points do not have.
void colour_by(scenes::Scene& scene, std::string_view name, const delaunay::PointCloud* points);

}  // namespace delray::apps
