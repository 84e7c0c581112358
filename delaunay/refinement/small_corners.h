// Segments that meet at less than 60 degrees, and where they are cut.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "delaunay/refine.h"
#include "delaunay/refinement/refinement_mesh.h"

namespace delray::delaunay::internal {

// Marks and lists the small corners of a mesh whose segments are edges; rows are vertices. O(n).
std::vector<SmallCorner> find_small_corners(RefinementMesh& mesh);

// Where pieces of segments are cut. Those of a segment with a small corner are cut at distances
// from it with as few binary digits as there are, so that those of both sides have ends beside each
// other and do not encroach upon each other (Ruppert 1995 and Miller, Pav and Walkington 2003 do so
// next to the corner).
class SegmentCuts {
 public:
  explicit SegmentCuts(const RefinementMesh& mesh) : mesh_(mesh) {}

  // The segment that a piece is a part of.
  SegmentEnds segment_of(VertexNumber start, VertexNumber end) const {
    if (mesh_.ends[start] != kOnNoSegment) return mesh_.ends[start];
    return mesh_.ends[end] != kOnNoSegment ? mesh_.ends[end] : SegmentEnds{start, end};
  }

  // In the middle, or in the middle third at a distance from the small corner.
  glm::dvec2 place_on(VertexNumber start, VertexNumber end) const {
    const glm::dvec2 &a = mesh_.points[start], &b = mesh_.points[end];
    const std::optional<VertexNumber> apex = small_corner_of(start, end);
    if (!apex) return 0.5 * a + 0.5 * b;
    const double to_a = distance(start, *apex), to_b = distance(end, *apex);
    const double near = std::min(to_a, to_b), far = std::max(to_a, to_b), third = (far - near) / 3;
    // Rounding may leave nothing between the ends.
    if (!(third > 0)) return 0.5 * a + 0.5 * b;
    const glm::dvec2& from = mesh_.points[*apex];
    return from +
           shortest_between(near + third, far - third) / far * ((to_a < to_b ? b : a) - from);
  }

  // Whether a vertex is as far from a piece's small corner as an end of the piece, but for
  // rounding.
  bool is_beside_end(VertexNumber v, VertexNumber start, VertexNumber end) const {
    const std::optional<VertexNumber> apex = small_corner_of(start, end);
    if (!apex) return false;
    const double far = distance(v, *apex);
    return std::abs(far - distance(start, *apex)) <= mesh_.tolerance ||
           std::abs(far - distance(end, *apex)) <= mesh_.tolerance;
  }

 private:
  // The small corner that a piece is cut by distances from, if its segment has one.
  std::optional<VertexNumber> small_corner_of(VertexNumber start, VertexNumber end) const {
    const SegmentEnds segment = segment_of(start, end);
    if (mesh_.acute[segment[0]] == 0 && mesh_.acute[segment[1]] == 0) return std::nullopt;
    const SegmentEnds key = ascending(segment[0], segment[1]);
    const auto reach = mesh_.reaches.find(key);
    if (reach == mesh_.reaches.end()) return std::nullopt;
    const glm::dvec2 middle = 0.5 * mesh_.points[start] + 0.5 * mesh_.points[end];
    const auto& [from, length] = reach->second;
    const bool is_within = glm::length(middle - mesh_.points[from]) <= length;
    return is_within == (from == key[0]) ? key[0] : key[1];
  }

  double distance(VertexNumber a, VertexNumber b) const {
    return glm::length(mesh_.points[a] - mesh_.points[b]);
  }

  // The number with the fewest binary digits from `low` to `high`. REQUIRES: 0 <= low < high.
  static double shortest_between(double low, double high) {
    // Of multiples of a step that is longer than the interval there is one at most; of half of it,
    // then, exactly one.
    const double step = std::ldexp(1.0, std::ilogb(high - low) + 1);
    const double multiple = std::floor(high / step) * step;
    return multiple >= low ? multiple : std::floor(high / (step / 2)) * (step / 2);
  }

  const RefinementMesh& mesh_;
};

}  // namespace delray::delaunay::internal
