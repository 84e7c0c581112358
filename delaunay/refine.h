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

#include "comm/communicator.h"
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
  std::uint64_t denied = 0;  // insertions tried again because another thread or rank was there
  std::uint64_t rounds = 0;  // of ranks
};

// What a rank did.
struct RefineRank {
  std::uint64_t triangles = 0;            // that it had at the beginning, with neighbours of these
  std::uint64_t most_triangles = 0;       // that it had a place for, its own and those of others
  std::uint64_t points = 0;               // that it added
  std::uint64_t fetched = 0;              // copies of triangles of others
  std::uint64_t requests = 0;             // of locks of single triangles of others
  std::uint64_t denials = 0;              // of requests
  std::uint64_t returned = 0;             // changed triangles of others
  std::uint64_t messages = 0, bytes = 0;  // sent to other ranks
  double waiting_seconds = 0;             // for messages; by the communicator's clock
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
  std::vector<RefineRank> ranks;  // of refinements over ranks
};

// An entry of the table of refinements.
struct RefinementMethod {
  std::string_view name;
  std::string_view description;
  bool parallel = false;     // makes use of several threads
  bool distributed = false;  // makes use of several ranks
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
// "okusanya" lets threads refine, by locks.
//
// Segments that cross get a point there; parts of segments that lie upon each other count once.
// Expected O(n log n) for n points of the result.
//
// Throws std::invalid_argument for coordinates that are not finite, above 1e60 or all below 1e-60,
// segments that join no rows, options out of range, and where segments enclose nothing;
// std::length_error beyond max_points; parallel::Interrupted.
Refined refine(const Outline& outline, const RefineOptions& options);

// Collective: ranks refine parts of the triangulation that rank 0 makes of its outline. Outline,
// number of points and threads are those of rank 0, other options are the same everywhere, and the
// result is rank 0's, that of others empty. It depends on the number of ranks, not on their speed.
// Method "auto" is the first that has ranks.
//
// Throws as the above, on all ranks.
Refined refine(comm::Communicator& communicator, const Outline& outline,
               const RefineOptions& options);

// The triangles of the domain alone.
Triangulation domain_of(const Refined& refined);

}  // namespace delray::delaunay
