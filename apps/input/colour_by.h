// --color-by: what the colour of a surface tells.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

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

// What colour_by does, for who has meshes in parts: colours of heights between the ends of their
// usual range (usual_range), of triangles numbered from `first` on, which get vertices of their
// own, and materials that do not tint them.
std::vector<glm::vec4> height_colours(std::span<const float> heights,
                                      std::pair<float, float> range);
// The legend of them, in heights of the file: those of the scene are relative to `origin`, and
// stretched.
scenes::ColourScale height_scale(std::pair<float, float> range, double origin,
                                 double exaggeration = 1);
void colour_simplices(std::uint64_t first, scenes::Mesh& mesh);
void whiten(scenes::Scene& scene);

}  // namespace delray::apps
