// The table of what points are shown as, and points of a size that suits their spacing.
#include "apps/input/show_as.h"

#include <array>

#include "scenes/points.h"

namespace delray::apps {
namespace {

using ShapeKind = scenes::Shape::Kind;

// Of the spacing: half of a square's diagonal, 0.71, would do for a lattice; points scattered at
// random then leave exp(-pi kCovering^2) of a surface bare.
constexpr float kCovering = 1.0F;

// The radius of points that are alone, in pixels.
constexpr float kAlonePixels = 4.0F;

constexpr std::array kWaysToShow = {
    ShowAs{"relief", "the surface of heights over x and y", ShapeKind::triangle, true},
    ShowAs{"points", "round spots of one colour and depth", ShapeKind::point, false},
    ShowAs{"discs", "flat discs that face the viewer", ShapeKind::disc, false},
    ShowAs{"spheres", "balls, lit", ShapeKind::sphere, true},
};

}  // namespace

std::span<const ShowAs> show_as() { return kWaysToShow; }

scenes::Shape shape_of(const ShowAs& how, const PointSize& size,
                       const std::function<float()>& spacing) {
  if (size.radius >= 0) return {how.kind, false, size.radius};
  if (size.pixels > 0) return {how.kind, true, size.pixels * 0.5F};
  // Points that are all in one place have no spacing.
  const float apart = spacing();
  return apart > 0 ? scenes::Shape{how.kind, false, kCovering * apart}
                   : scenes::Shape{how.kind, true, kAlonePixels};
}

void show_points(const ShowAs& how, const PointSize& size, scenes::Scene& scene) {
  scenes::Mesh& mesh = scene.meshes[0];
  scenes::make_points(mesh, {how.kind, true, size.pixels * 0.5F}, scene.framed);
  mesh.shape = shape_of(how, size, [&] { return scenes::point_spacing(mesh); });
  scene.materials[mesh.material].unlit = !how.lit;
}

bool set_point_size(const PointSize& size, scenes::Scene& scene) {
  bool any = false;
  for (scenes::Mesh& mesh : scene.meshes) {
    if (mesh.has_triangles()) continue;
    any = true;
    const bool in_pixels = size.radius < 0;
    mesh.shape = {mesh.shape.kind, in_pixels, in_pixels ? size.pixels * 0.5F : size.radius};
  }
  return any;
}

}  // namespace delray::apps
