// Triangles of the world, their moments in closed form, then sampled distances.
#include "scenes/shape_features.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "parallel/parallel_for.h"

namespace delray::scenes {
namespace {

constexpr std::array<ShapeFeature, kShapeFeatures> kFeatures = {{
    {"elongation", "second over first axis of the ellipsoid of inertia"},
    {"flatness", "third over first axis of the ellipsoid of inertia"},
    {"d2-spread", "deviation over mean of distances between two points of the surface"},
    {"reach", "distance of the farthest corner from the centre over the mean radius"},
    {"d1-spread", "deviation over mean of distances of points of the surface from the centre"},
    {"d2-skewness", "skewness of distances between two points of the surface"},
}};

// Triangles with area, and the sums of areas up to each.
struct Surface {
  std::vector<std::array<glm::dvec3, 3>> triangles;
  std::vector<double> areas;

  double area() const { return areas.empty() ? 0 : areas.back(); }
  // Points are spread evenly for numbers that are in the unit square (Osada et al. 2002); `place`
  // chooses the triangle.
  glm::dvec3 point(double place, double u, double v) const {
    const auto found = std::ranges::upper_bound(areas, place * area());
    const auto t = std::min(static_cast<std::size_t>(found - areas.begin()), areas.size() - 1);
    const auto& [a, b, c] = triangles[t];
    const double root = std::sqrt(u);
    return (1 - root) * a + root * (1 - v) * b + root * v * c;
  }
};

Surface surface_of(const Scene& scene) {
  Surface surface;
  double sum = 0;
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    if (!mesh.has_triangles()) continue;
    const glm::dmat4x3 to_world(instance.transform);
    for (const glm::uvec3& corners : mesh.triangles) {
      std::array<glm::dvec3, 3> triangle;
      for (int k = 0; k < 3; ++k) {
        triangle[k] = to_world * glm::dvec4(mesh.positions[corners[k]], 1);
      }
      const double area =
          glm::length(glm::cross(triangle[1] - triangle[0], triangle[2] - triangle[0])) / 2;
      if (!(area > 0) || !std::isfinite(area)) continue;
      surface.triangles.push_back(triangle);
      surface.areas.push_back(sum += area);
    }
  }
  return surface;
}

// The centre of the surface and its covariance around it.
struct Moments {
  glm::dvec3 centre{0};
  glm::dmat3 covariance{0};
};

// The integral of x x^T over a triangle around its centre g is area / 12 times the sum of the outer
// products of its corners and of 9 g.
Moments moments_of(const Surface& surface) {
  Moments moments;
  const auto area_of = [&](std::size_t t) {
    return surface.areas[t] - (t == 0 ? 0 : surface.areas[t - 1]);
  };
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& [a, b, c] = surface.triangles[t];
    moments.centre += area_of(t) / 3 * (a + b + c);
  }
  moments.centre /= surface.area();
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    glm::dvec3 sum(0);
    glm::dmat3 products(0);
    for (const glm::dvec3& corner : surface.triangles[t]) {
      const glm::dvec3 x = corner - moments.centre;
      sum += x;
      products += glm::outerProduct(x, x);
    }
    moments.covariance += area_of(t) / 12 * (products + glm::outerProduct(sum, sum));
  }
  moments.covariance /= surface.area();
  return moments;
}

// Eigenvalues of a symmetric matrix, the largest first (Smith 1961).
std::array<double, 3> eigenvalues(const glm::dmat3& m) {
  const double mean = (m[0][0] + m[1][1] + m[2][2]) / 3;
  const glm::dmat3 rest = m - glm::dmat3(mean);
  double squares = 0;
  for (int k = 0; k < 3; ++k) squares += glm::dot(rest[k], rest[k]);
  const double scale = std::sqrt(squares / 6);
  if (!(scale > 0)) return {mean, mean, mean};
  const double cosine = std::clamp(glm::determinant(rest) / (2 * scale * scale * scale), -1.0, 1.0);
  const double angle = std::acos(cosine) / 3;
  const double first = mean + 2 * scale * std::cos(angle);
  const double third = mean + 2 * scale * std::cos(angle + 2 * std::numbers::pi / 3);
  return {first, 3 * mean - first - third, third};
}

// Sums of powers of distances.
struct Distances {
  double first = 0, second = 0, third = 0;

  void add(double distance) {
    first += distance;
    second += distance * distance;
    third += distance * distance * distance;
  }
  Distances operator+(const Distances& o) const {
    return {first + o.first, second + o.second, third + o.third};
  }
  double spread(double n) const { return std::sqrt(std::max(0.0, variance(n))) / (first / n); }
  double skewness(double n) const {
    const double mean = first / n, deviation = std::sqrt(std::max(0.0, variance(n)));
    const double central = third / n - 3 * mean * second / n + 2 * mean * mean * mean;
    return deviation > 0 ? central / (deviation * deviation * deviation) : 0;
  }

 private:
  double variance(double n) const { return second / n - first / n * (first / n); }
};

struct Sampled {
  Distances between, from_centre;
};

constexpr std::size_t kPairs = std::size_t{1} << 17;

// Number i of the sequence of Roberts (2018) in six dimensions: multiples of the powers of 1 over
// the root of x^7 = x + 1, without their whole parts.
std::array<double, 6> sequence(std::size_t i) {
  constexpr double kRoot = 1.1127756842787055;
  std::array<double, 6> values;
  double power = 1;
  for (double& value : values) {
    power /= kRoot;
    const double product = 0.5 + power * static_cast<double>(i + 1);
    value = product - std::floor(product);
  }
  return values;
}

Sampled sample(const Surface& surface, const glm::dvec3& centre) {
  constexpr std::size_t kPairsOfBlock = 4096;  // pairs: about a millisecond
  return parallel::parallel_reduce(
      0, kPairs, kPairsOfBlock, Sampled{},
      [&](std::size_t first, std::size_t last) {
        Sampled sums;
        for (std::size_t i = first; i < last; ++i) {
          const std::array<double, 6> at = sequence(i);
          const glm::dvec3 p = surface.point(at[0], at[2], at[3]);
          const glm::dvec3 q = surface.point(at[1], at[4], at[5]);
          sums.between.add(glm::length(p - q));
          sums.from_centre.add(glm::length(p - centre));
        }
        return sums;
      },
      [](const Sampled& a, const Sampled& b) {
        return Sampled{a.between + b.between, a.from_centre + b.from_centre};
      });
}

}  // namespace

std::span<const ShapeFeature> shape_features() { return kFeatures; }

std::optional<std::array<double, kShapeFeatures>> features_of_shape(const Scene& scene) {
  const Surface surface = surface_of(scene);
  if (!(surface.area() > 0) || !std::isfinite(surface.area())) return std::nullopt;
  const Moments moments = moments_of(surface);
  const std::array<double, 3> axes = eigenvalues(moments.covariance);
  double farthest = 0;
  for (const auto& triangle : surface.triangles) {
    for (const glm::dvec3& corner : triangle) {
      farthest = std::max(farthest, glm::length(corner - moments.centre));
    }
  }
  const auto axis = [&](std::size_t k) { return std::sqrt(std::max(0.0, axes[k])); };
  const double radius = std::sqrt(axes[0] + axes[1] + axes[2]);
  const Sampled sampled = sample(surface, moments.centre);
  constexpr auto n = static_cast<double>(kPairs);
  return std::array<double, kShapeFeatures>{axis(1) / axis(0),
                                            axis(2) / axis(0),
                                            sampled.between.spread(n),
                                            farthest / radius,
                                            sampled.from_centre.spread(n),
                                            sampled.between.skewness(n)};
}

}  // namespace delray::scenes
