// Numbers by which shapes are told apart, however they are placed, turned and scaled.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string_view>

#include "scenes/scene.h"

namespace delray::scenes {

inline constexpr int kShapeFeatures = 6;

// An entry of the table of features, the ones that tell most first.
struct ShapeFeature {
  std::string_view name;
  std::string_view description;
};

std::span<const ShapeFeature> shape_features();

// Of all triangles of all instances. The surface counts and not how it is cut into triangles:
// features of a model that has fewer triangles are near those of the model.
//
// - Moments: the covariance of the surface, whose axes are those of its ellipsoid of inertia, exact
//   up to rounding.
// - The distribution D2 of distances between two points of the surface, and that of distances from
//   its centre, D1 (Osada, Funkhouser, Chazelle and Dobkin 2002), by 2^17 pairs of points of a
//   low-discrepancy sequence (Roberts 2018), to about 10^-3.
// - The extent: the distance of the farthest corner from the centre.
//
// None for a scene without area. O(n + pairs log n), parallel, the same for every number of
// threads.
std::optional<std::array<double, kShapeFeatures>> features_of_shape(const Scene& scene);

}  // namespace delray::scenes
