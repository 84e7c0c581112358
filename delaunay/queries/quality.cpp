// Angles by atan2 of cross and dot products, which stays accurate for thin simplices, and radius
// ratios from edge lengths, areas and volumes, of coordinates scaled so that nothing overflows.
// Sums are combined by a parallel reduction. Flat simplices have a ratio of 0.
#include "delaunay/quality.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>
#include <span>

#include "delaunay/mesh/arguments.h"
#include "parallel/parallel_for.h"

namespace delray::delaunay {
namespace {

struct Shape {
  std::array<double, 6> angles;  // radians; the first 3 or 6
  double radius_ratio;
};

// Corners relative to the first, so scaled that nothing overflows.
template <int D>
std::array<glm::dvec3, D + 1> relative(PointView<double> points, const std::uint32_t* vertices) {
  std::array<glm::dvec3, D + 1> result{};
  double largest = 0;
  for (int i = 1; i <= D; ++i) {
    for (int k = 0; k < D; ++k) {
      result[i][k] = 0.5 * points(vertices[i], k) - 0.5 * points(vertices[0], k);
      largest = std::max(largest, std::abs(result[i][k]));
    }
  }
  if (largest > 0) {
    for (glm::dvec3& p : result) p /= largest;
  }
  return result;
}

Shape shape_of(const std::array<glm::dvec3, 3>& p) {
  const double twice_area = std::abs(glm::cross(p[1], p[2]).z);
  Shape shape{};
  double sum = 0, product = 1;
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3 a = p[(i + 1) % 3] - p[i], b = p[(i + 2) % 3] - p[i];
    shape.angles[i] = std::atan2(twice_area, glm::dot(a, b));
    sum += glm::length(a);
    product *= glm::length(a);
  }
  const double below = sum * product;
  shape.radius_ratio = below > 0 ? 4 * twice_area * twice_area / below : 0;
  return shape;
}

Shape shape_of(const std::array<glm::dvec3, 4>& p) {
  // Normal i is that of the face opposite to corner i, outward, as long as twice its area.
  const std::array<glm::dvec3, 4> normals = {
      glm::cross(p[2] - p[1], p[3] - p[1]), glm::cross(p[3] - p[0], p[2] - p[0]),
      glm::cross(p[1] - p[0], p[3] - p[0]), glm::cross(p[2] - p[0], p[1] - p[0])};
  Shape shape{};
  int next = 0;
  double surface = 0;
  for (int i = 0; i < 4; ++i) {
    surface += glm::length(normals[i]);
    for (int j = i + 1; j < 4; ++j) {
      shape.angles[next++] = std::atan2(glm::length(glm::cross(normals[i], normals[j])),
                                        -glm::dot(normals[i], normals[j]));
    }
  }
  const glm::dvec3 a = p[1], b = p[2], c = p[3];
  const double six_volumes = std::abs(glm::dot(a, glm::cross(b, c)));
  // In radius: 3 volumes over the surface. Circumradius: |w| over 12 volumes.
  const glm::dvec3 w = glm::dot(a, a) * glm::cross(b, c) + glm::dot(b, b) * glm::cross(c, a) +
                       glm::dot(c, c) * glm::cross(a, b);
  const double below = surface * glm::length(w);
  shape.radius_ratio = below > 0 ? 6 * six_volumes * six_volumes / below : 0;
  return shape;
}

std::size_t bin(double value, double width, std::size_t bins) {
  return std::min(static_cast<std::size_t>(std::max(0.0, value / width)), bins - 1);
}

template <int D>
Quality quality_of_range(PointView<double> points, const Triangulation& triangulation,
                         std::size_t first, std::size_t last) {
  constexpr std::size_t kAngles = D == 2 ? 3 : 6;
  Quality result;
  for (std::size_t t = first; t < last; ++t) {
    const Shape shape = shape_of(relative<D>(points, &triangulation.vertices[t * (D + 1)]));
    double low = 180, high = 0;
    for (const double radians : std::span(shape.angles).first(kAngles)) {
      const double angle = radians * (180 / std::numbers::pi);
      low = std::min(low, angle);
      high = std::max(high, angle);
      ++result.angles[bin(angle, 10, result.angles.size())];
    }
    ++result.radius_ratios[bin(shape.radius_ratio, 0.1, result.radius_ratios.size())];
    const bool is_first = result.simplices++ == 0;
    result.min_angle = is_first ? low : std::min(result.min_angle, low);
    result.max_angle = std::max(result.max_angle, high);
    result.mean_min_angle += low;
    result.min_radius_ratio =
        is_first ? shape.radius_ratio : std::min(result.min_radius_ratio, shape.radius_ratio);
    result.mean_radius_ratio += shape.radius_ratio;
  }
  return result;
}

// Combines qualities that hold sums instead of means.
Quality combine(const Quality& a, const Quality& b) {
  if (a.simplices == 0) return b;
  if (b.simplices == 0) return a;
  Quality result = a;
  result.simplices += b.simplices;
  result.min_angle = std::min(a.min_angle, b.min_angle);
  result.max_angle = std::max(a.max_angle, b.max_angle);
  result.mean_min_angle += b.mean_min_angle;
  result.min_radius_ratio = std::min(a.min_radius_ratio, b.min_radius_ratio);
  result.mean_radius_ratio += b.mean_radius_ratio;
  for (std::size_t i = 0; i < a.angles.size(); ++i) result.angles[i] += b.angles[i];
  for (std::size_t i = 0; i < a.radius_ratios.size(); ++i) {
    result.radius_ratios[i] += b.radius_ratios[i];
  }
  return result;
}

}  // namespace

Quality quality(PointView<double> points, const Triangulation& triangulation) {
  internal::check_view(points, triangulation.dim);
  internal::check_triangulation(triangulation, points.size());
  constexpr std::size_t kGrain = 4096;  // simplices: about a millisecond
  Quality result = parallel::parallel_reduce(
      0, triangulation.size(), kGrain, Quality{},
      [&](std::size_t first, std::size_t last) {
        return triangulation.dim == 2 ? quality_of_range<2>(points, triangulation, first, last)
                                      : quality_of_range<3>(points, triangulation, first, last);
      },
      combine);
  if (result.simplices > 0) {
    result.mean_min_angle /= static_cast<double>(result.simplices);
    result.mean_radius_ratio /= static_cast<double>(result.simplices);
  }
  return result;
}

}  // namespace delray::delaunay
