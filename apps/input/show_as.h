// --show-as: what is drawn of points.
#pragma once

#include <cstddef>
#include <functional>
#include <span>

#include "scenes/scene.h"

namespace delray::apps {

// A row of the table.
struct ShowAs {
  const char* name;
  const char* description;
  scenes::Shape::Kind kind;
  bool lit;  // else points keep their colour whatever the light

  bool is_points() const { return kind != scenes::Shape::Kind::triangle; }
};
// The first is the relief.
std::span<const ShowAs> show_as();

struct PointSize {
  float pixels = 0;   // diameter; 0: not given
  float radius = -1;  // in units of the scene; negative: not given
};

// Makes points of the vertices of the scene's first mesh, which has no triangles. Without a size,
// discs of it would cover all but 4 % of a surface that the points are scattered over. REQUIRES:
// is_points.
inline constexpr std::size_t kBytesPerShownPoint = 110;
void show_points(const ShowAs& how, const PointSize& size, scenes::Scene& scene);

// The shape that gives: `spacing` says how far points are apart, where that decides.
scenes::Shape shape_of(const ShowAs& how, const PointSize& size,
                       const std::function<float()>& spacing);

// Sets the size of all points and lines of a scene. Returns whether there are any.
bool set_point_size(const PointSize& size, scenes::Scene& scene);

}  // namespace delray::apps
