// What holds of every refinement, and outlines to refine.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <set>
#include <string>
#include <vector>

#include "delaunay/quality.h"
#include "delaunay/refine.h"
#include "delaunay/verify.h"
#include "tests/delaunay/hard_points.h"

namespace delray::delaunay {

inline Outline polygon(const std::vector<glm::dvec2>& corners) {
  Outline outline;
  const auto n = static_cast<std::uint32_t>(corners.size());
  for (std::uint32_t i = 0; i < n; ++i) {
    outline.points.positions.emplace_back(corners[i], 0);
    outline.segments.push_back({i, (i + 1) % n});
  }
  return outline;
}
inline Outline square() { return polygon({{0, 0}, {1, 0}, {1, 1}, {0, 1}}); }

// Adds a segment with points of its own.
inline void add_segment(Outline& outline, const glm::dvec2& a, const glm::dvec2& b) {
  const auto first = static_cast<std::uint32_t>(outline.points.size());
  outline.points.positions.emplace_back(a, 0);
  outline.points.positions.emplace_back(b, 0);
  outline.segments.push_back({first, first + 1});
}

inline double area_of(const Refined& refined) {
  double area = 0;
  const Triangulation domain = domain_of(refined);
  for (std::size_t t = 0; t < domain.size(); ++t) {
    const glm::dvec2 a = refined.points[domain.vertices[3 * t]],
                     b = glm::dvec2(refined.points[domain.vertices[3 * t + 1]]) - a,
                     c = glm::dvec2(refined.points[domain.vertices[3 * t + 2]]) - a;
    area += (b.x * c.y - b.y * c.x) / 2;
  }
  return area;
}

inline double length_of(const std::vector<glm::dvec3>& points,
                        const std::vector<std::array<std::uint32_t, 2>>& segments) {
  double length = 0;
  for (const auto& [a, b] : segments) {
    length += glm::length(glm::dvec2(points[a]) - glm::dvec2(points[b]));
  }
  return length;
}

inline double distance_to(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b) {
  const double t = glm::dot(p - a, b - a) / glm::dot(b - a, b - a);
  return glm::length(p - glm::mix(a, b, std::clamp(t, 0.0, 1.0)));
}

inline void expect_refined(const Outline& outline, const RefineOptions& options,
                           const Refined& refined) {
  const std::size_t n = outline.points.size();
  ASSERT_GE(refined.points.size(), n);
  for (std::size_t row = 0; row < n; ++row) {
    ASSERT_EQ(refined.points[row], outline.points.positions[row]);
  }
  const Verdict verdict = verify_triangles(view(refined.points), refined.triangulation.vertices);
  ASSERT_TRUE(verdict.valid && verdict.delaunay && verdict.canonical) << verdict.reason;
  // Pieces are edges.
  std::set<std::array<std::uint32_t, 2>> edges;
  const std::vector<std::uint32_t>& vertices = refined.triangulation.vertices;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    edges.insert({vertices[i], vertices[i / 3 * 3 + (i + 1) % 3]});
  }
  for (const auto& [a, b] : refined.segments) {
    EXPECT_TRUE(edges.contains({a, b}) || edges.contains({b, a})) << a << ' ' << b;
  }
  // Angles and areas.
  std::uint64_t below = 0;
  for (std::size_t t = 0; t < refined.triangulation.size(); ++t) {
    if (refined.inside[t] == 0) continue;
    const Triangulation one{2,
                            {vertices.begin() + static_cast<std::ptrdiff_t>(3 * t),
                             vertices.begin() + static_cast<std::ptrdiff_t>(3 * t + 3)}};
    if (quality(view(refined.points), one).min_angle < options.min_angle) ++below;
    if (options.max_area > 0) {
      Refined alone{refined.points, one, {1}, {}, {}, {}, {}};
      EXPECT_LE(area_of(alone), options.max_area);
    }
  }
  EXPECT_EQ(below, refined.counts.excepted);
  EXPECT_EQ(refined.counts.too_fine, 0U);
  EXPECT_TRUE(below == 0 || !refined.small_corners.empty());
}

constexpr double kHardPointsAngle = 20;

// `refine` reaches the angle on sets of hard points, but for those that are beyond what products of
// coordinates allow and where pieces are too fine.
template <class Refine>
void expect_refined_hard_points(Refine&& refine) {
  std::uint64_t seed = 0;
  int reached_sets = 0;
  for (const HardPoints& kind : hard_points()) {
    Outline outline;
    double largest = 0;
    for (const glm::dvec2& p : kind.make(60, ++seed)) {
      outline.points.positions.emplace_back(p, 0);
      largest = std::max({largest, std::abs(p.x), std::abs(p.y)});
    }
    if (!(largest < 1e50 && (largest == 0 || largest > 1e-50))) continue;
    SCOPED_TRACE(std::string(kind.name) + ", seed " + std::to_string(seed));
    const Refined refined = refine(outline);
    const Verdict verdict = verify_triangles(view(refined.points), refined.triangulation.vertices);
    EXPECT_TRUE(verdict.valid && verdict.delaunay && verdict.canonical) << verdict.reason;
    const Quality reached = quality(view(refined.points), domain_of(refined));
    if (reached.simplices == 0 || refined.counts.too_fine + refined.counts.excepted > 0) continue;
    EXPECT_GE(reached.min_angle, kHardPointsAngle);
    ++reached_sets;
  }
  EXPECT_GT(reached_sets, 10);
}

}  // namespace delray::delaunay
