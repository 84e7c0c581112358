// Turns about each vertex from one segment to the next.
#include "delaunay/refinement/small_corners.h"

#include <array>
#include <map>
#include <numbers>

namespace delray::delaunay::internal {
namespace {

constexpr double kSmall = 60 * (1 - 0x1p-40);  // degrees

// From a direction to another counterclockwise, from -180 to 180 degrees.
double degrees_between(const glm::dvec2& first, const glm::dvec2& second) {
  const double sine = first.x * second.y - first.y * second.x;
  return std::atan2(sine, glm::dot(first, second)) * (180 / std::numbers::pi);
}
bool is_small(double degrees) { return degrees > 0 && degrees < kSmall; }

// A small corner reaches as far along its segments as the shorter one; two that meet on a segment
// share it.
class SmallCornerReaches {
 public:
  explicit SmallCornerReaches(const RefinementMesh& mesh) : mesh_(mesh) {}

  // By the next vertices on the two segments.
  void add(VertexNumber corner, VertexNumber first, VertexNumber second) {
    first = other_end(corner, first);
    second = other_end(corner, second);
    const double reach = std::min(length(corner, first), length(corner, second));
    for (const VertexNumber end : {first, second}) {
      const SegmentEnds segment = ascending(corner, end);
      double& longest = found_[segment][corner < end ? 0 : 1];
      longest = std::max(longest, reach);
    }
  }
  std::map<SegmentEnds, RefinementMesh::Reach> reaches() const {
    std::map<SegmentEnds, RefinementMesh::Reach> result;
    for (const auto& [segment, of_ends] : found_) {
      const double share = of_ends[0] / (of_ends[0] + of_ends[1]);
      result[segment] = {segment[0], share * length(segment[0], segment[1])};
    }
    return result;
  }

 private:
  double length(VertexNumber a, VertexNumber b) const {
    return glm::length(mesh_.points[a] - mesh_.points[b]);
  }
  VertexNumber other_end(VertexNumber corner, VertexNumber next) const {
    const SegmentEnds& ends = mesh_.ends[next];
    return ends == kOnNoSegment ? next : ends[ends[0] == corner ? 1 : 0];
  }

  const RefinementMesh& mesh_;
  std::map<SegmentEnds, std::array<double, 2>> found_;
};

}  // namespace

std::vector<SmallCorner> find_small_corners(RefinementMesh& mesh) {
  std::vector<SmallCorner> found;
  SmallCornerReaches reaches(mesh);
  const auto turn = [&](CornerNumber corner) {
    return next_corner(mesh.mesh.neighbour(next_corner(corner)));
  };
  for (SimplexNumber t = 0; t < mesh.triangles; ++t) {
    for (unsigned k = 0; k < 3; ++k) {
      const CornerNumber corner = corner_of(t, k);
      if (!mesh.is_segment(previous_corner(corner))) continue;
      const VertexNumber v = mesh.mesh.vertex(corner);
      if (v == kInfiniteVertex || mesh.ends[v] != kOnNoSegment) continue;
      CornerNumber last = corner;
      while (!mesh.is_segment(next_corner(last))) last = turn(last);
      const glm::dvec2 first_side = mesh.at(next_corner(corner)) - mesh.points[v];
      const glm::dvec2 last_side = mesh.at(previous_corner(last)) - mesh.points[v];
      const double degrees = degrees_between(first_side, last_side);
      if (!is_small(degrees)) continue;
      mesh.acute[v] = 1;
      found.push_back({v, degrees});
      reaches.add(v, mesh.mesh.vertex(next_corner(corner)),
                  mesh.mesh.vertex(previous_corner(last)));
    }
  }
  mesh.reaches = reaches.reaches();
  return found;
}

}  // namespace delray::delaunay::internal
