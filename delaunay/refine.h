// Refinement: points added to a triangulation until its triangles are well shaped and small.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "delaunay/outline.h"
#include "delaunay/points.h"
#include "delaunay/triangulation.h"
#include "parallel/progress.h"

namespace delray::delaunay {

// Up to this angle Ruppert's refinement ends on every outline without acute corners (Ruppert 1995);
// beyond, it did on all that were tried.
inline constexpr double kProvenAngle = 20.7;
inline constexpr double kLargestMinAngle = 30;

// What triangles are to be.
struct RefineOptions {
  double min_angle = 20;        // degrees, from 0 to kLargestMinAngle
  double max_area = 0;          // 0: of any size
  std::size_t max_points = 0;   // that the result may have; 0: as many as a mesh holds
  std::string method = "auto";  // of refinement_methods()
  int threads = 1;
  parallel::Progress* progress = nullptr;  // advanced by inserted points, of an unknown number
};

// Two segments that meet at less than 60 degrees. No triangle that fills a corner can have a larger
// angle there, and those around it may be below the bound, too.
struct SmallCorner {
  std::uint32_t row = 0;  // of the point where they meet
  double degrees = 0;
};

// Counts of what was done.
struct RefineCounts {
  std::uint64_t on_segments = 0;  // points that were added to segments
  std::uint64_t inside = 0;       // and to triangles
  std::uint64_t crossings = 0;    // of segments that met without a point
  std::uint64_t excepted = 0;     // triangles below the bound by a small corner
  // Triangles and segments that double precision is too coarse to cut.
  std::uint64_t too_fine = 0;
  std::uint64_t denied = 0;  // insertions tried again because another thread was there
};

// A refined triangulation.
struct Refined {
  // The points of the input, then the added ones. Where the input has heights, added points have
  // those of its own triangulation.
  std::vector<glm::dvec3> points;
  // The Delaunay triangulation of `points`.
  Triangulation triangulation;
  // Per triangle: whether it lies in the domain.
  std::vector<std::uint8_t> inside;
  // The pieces of the segments, as rows.
  std::vector<std::array<std::uint32_t, 2>> segments;
  std::vector<SmallCorner> small_corners;
  RefineCounts counts;
};

// An entry of the table of refinements.
struct RefinementMethod {
  std::string_view name;
  std::string_view description;
  bool parallel = false;  // makes use of several threads
};

std::span<const RefinementMethod> refinement_methods();

// Refines the Delaunay triangulation of an outline until every triangle of its domain has no angle
// below min_angle and no area above max_area, but for what small corners except (Ruppert 1995).
//
// Segments are kept: each is a chain of edges of the result, whose points lie on it as closely as
// doubles allow. Without segments the domain is the convex hull, with its edges as segments. Points
// are added to the middle of segments that have a point within their diametral circle, which makes
// them Delaunay edges, and otherwise at off-centres of triangles (Üngör 2004), the worst first.
// Ends for min_angle <= kProvenAngle; beyond, where points would come closer than doubles tell
// apart, the triangle stays and is counted.
//
// Method "chew" calls a triangle large by its circle and cuts it at the centre of that (Chew 1989);
// "okusanya" lets threads do it, by locks.
//
// Segments that cross get a point there; parts of segments that lie upon each other count once.
// Expected O(n log n) for n points of the result.
//
// Throws std::invalid_argument for coordinates that are not finite, above 1e60 or all below 1e-60,
// segments that join no rows, options out of range, and where segments enclose nothing;
// std::length_error beyond max_points; parallel::Interrupted.
Refined refine(const Outline& outline, const RefineOptions& options);

// The triangles of the domain alone.
Triangulation domain_of(const Refined& refined);

}  // namespace delray::delaunay
