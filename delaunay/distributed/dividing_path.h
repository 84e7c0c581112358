// A chain of Delaunay edges that divides points in two, found before they are triangulated.
//
// The edges whose dual Voronoi edges a straight line crosses are a lower hull: that of the points
// lifted onto a paraboloid that stands on the line and projected along the line's normal (Blelloch,
// Hardwick, Miller and Talmor 1999; Kohout 2004, Figure 5.6). It is monotone along the line, and
// every triangle lies on one side of it: that on which its circumcentre lies of the line.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <utility>
#include <vector>

#include "comm/communicator.h"
#include "delaunay/distributed.h"

namespace delray::delaunay {

// The line where coordinate `axis` (0: x, 1: y) is `place`.
struct CutLine {
  int axis = 0;
  double place = 0;
};

// The sign of the turn of a, b, c as lifted and projected: +1 for a left turn, the hull's. 0 only
// where two of them have one coordinate along the line. Exact; ties by the perturbation of
// predicates/conflict.h.
int projected_turn(const CutLine& line, const glm::dvec2& a, const glm::dvec2& b,
                   const glm::dvec2& c);
// Whether a is lifted less than b. REQUIRES: equal coordinates along the line.
bool is_lifted_less(const CutLine& line, const glm::dvec2& a, const glm::dvec2& b);

// The vertices of the path of some points, ascending along the line; of equal points the one with
// the lowest row. That of all points of several ranks is that of their paths. O(n log n).
std::vector<RowPoint> lower_hull(const CutLine& line, std::vector<RowPoint> points);

// A path with which side of it counts.
class DividingPath {
 public:
  // `vertices` as lower_hull() gives them, at least one.
  DividingPath(const CutLine& line, std::vector<RowPoint> vertices)
      : line_(line), vertices_(std::move(vertices)) {}

  std::span<const RowPoint> vertices() const { return vertices_; }
  // -1 where the line's coordinate is lower, +1 where it is higher, 0 for what equals a vertex.
  // O(log vertices). REQUIRES: the point is one of those whose hull the path is.
  int side_of(const glm::dvec3& position) const;
  // That of a Delaunay triangle of those points: -1 or +1.
  int side_of(const RowPoint& a, const RowPoint& b, const RowPoint& c) const;

 private:
  double along(const glm::dvec3& p) const { return p[1 - line_.axis]; }
  // Of p as seen from the straight line through two points, the first lower along the line.
  int side_of_edge(const glm::dvec3& low, const glm::dvec3& high, const glm::dvec3& p) const;

  CutLine line_;
  std::vector<RowPoint> vertices_;
};

// The triangles of some points that lie on the given sides of all paths; `paths` and `sides` have
// one size. Corners are indices of points. REQUIRES: the vertices of the last path are among the
// points.
std::vector<std::uint32_t> triangles_between(std::span<const RowPoint> points,
                                             std::span<const DividingPath> paths,
                                             std::span<const int> sides, const Options& options);

// What a rank gives for its points and those paths: vertices of a path count as points of the rank
// on its low side, triangles with such a vertex as shared. Collective, as the number of hull edges
// is one of all ranks.
DistributedTriangulation triangulate_between(comm::Communicator& communicator,
                                             std::span<const RowPoint> points,
                                             std::span<const DividingPath> paths,
                                             std::span<const int> sides, const Options& options);

}  // namespace delray::delaunay
