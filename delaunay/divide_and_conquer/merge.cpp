// The merge step of divide and conquer (Guibas and Stolfi 1985), on triangulations within hulls of
// ghosts.
//
// Two walks along the hulls find their lower common tangent. From there an edge between the sides
// rises: on each side, hull edges that are no longer Delaunay are flipped away, then the better of
// the two candidates, by the incircle test, becomes the next triangle and its far edge the new
// base, until the upper tangent is reached. O(edges of the hulls along the merge line + edges made
// and removed).
//
// Degenerate: filters decide most signs, exact predicates the rest; points on a common circle are
// decided by the perturbation of conflict.h, so the result is unique. Sides that are a single point
// or a chain of collinear points are legal.
#include "delaunay/divide_and_conquer/merge.h"

#include <algorithm>
#include <cmath>

#include "delaunay/divide_and_conquer/merge_pair.h"

namespace delray::delaunay::internal {
namespace {

// Sides of the merge line, as bits.
constexpr unsigned kLeft = 1, kRight = 2;

// The edge of a hull that is next on one side of the merge line.
template <unsigned kSide>
struct HullFront {
  // The corners of its ghost with the edge's end that the merge line has come to, and with the
  // other.
  static constexpr unsigned kNear = kSide == kLeft ? 1 : 0, kFar = 1 - kNear;

  SimplexNumber ghost;
  unsigned present = 0;    // kSide if there is an edge
  unsigned is_backed = 0;  // kSide if there is a triangle behind it
  VertexNumber next;       // its far end
  VertexNumber behind;     // the vertex of that triangle, or `next`
  CornerNumber apex = 0;   // and its corner

  // `vertex` is where the merge line starts; there may be no edge.
  HullFront(const Mesh<2>& mesh, SimplexNumber first, VertexNumber vertex)
      : ghost(first), next(vertex), behind(vertex) {
    if (ghost != kNoGhost) load(mesh);
  }

  void load(const Mesh<2>& mesh) {
    present = kSide;
    next = mesh.vertex(ghost, kFar);
    apex = mesh.neighbour(ghost, 2);
    look_behind(mesh);
  }
  void look_behind(const Mesh<2>& mesh) {
    const VertexNumber vertex = mesh.vertex(apex);
    is_backed = vertex != kInfiniteVertex ? kSide : 0;
    behind = vertex != kInfiniteVertex ? vertex : next;
  }

  // The edge goes, and the ghost moves to the one from its near end to `behind`.
  void flip(HullMesh& hulls) {
    Mesh<2>& mesh = hulls.mesh;
    const SimplexNumber freed = simplex_of(apex);
    const CornerNumber before = mesh.neighbour(previous_corner(apex));
    const CornerNumber after = mesh.neighbour(next_corner(apex));
    mesh.set_vertex(ghost, kFar, behind);
    if constexpr (kSide == kLeft) {
      hulls.set_ghost(freed, behind, next);
      hulls.follow(freed, hulls.next_ghost(ghost));
      hulls.follow(ghost, freed);
      hulls.link(freed, 2, after);
      apex = before;
    } else {
      hulls.set_ghost(freed, next, behind);
      hulls.follow(hulls.previous_ghost(ghost), freed);
      hulls.follow(freed, ghost);
      hulls.link(freed, 2, before);
      apex = after;
    }
    hulls.link(ghost, 2, apex);
    next = behind;
    look_behind(mesh);
  }

  // Flips edges away that are not Delaunay any more. REQUIRES: `next` is above the edge from a to
  // b. `first` says whether it is known that the first one goes.
  void retreat(HullMesh& hulls, const MergeFilter& filter, const glm::dvec2& a, const glm::dvec2& b,
               bool first) {
    const glm::dvec2* points = hulls.points;
    if (first) flip(hulls);
    for (EdgeView seen(a, b, points[next]); is_backed != 0;) {
      const EdgeView seen_behind(a, b, points[behind]);
      if (!filter.inside(a, b, points[next], seen, points[behind], seen_behind)) break;
      flip(hulls);
      seen = seen_behind;
    }
  }

  // Makes the ghost the triangle over `base`, whose other end is `opposite`, and goes on to the
  // edge after it. Returns the vertex that the merge line has come to.
  VertexNumber advance(HullMesh& hulls, VertexNumber opposite, CornerNumber& base) {
    const VertexNumber vertex = next;
    const CornerNumber following = hulls.mesh.neighbour(ghost, kNear);
    hulls.mesh.set_vertex(ghost, 2, opposite);
    hulls.link(ghost, kFar, base);
    base = corner_of(ghost, kNear);
    ghost = simplex_of(following);
    load(hulls.mesh);
    return vertex;
  }
};

// Where the lower common tangent of two hulls touches them, and the ghosts of the edges before and
// after its ends, kNoGhost on a side that is a single point.
struct LowerTangent {
  VertexNumber left, right;
  SimplexNumber before_left, after_left, before_right, after_right;
};

// Walks down both hulls for as long as an end can move. A cross product beyond `error` has a sure
// sign.
LowerTangent lower_tangent(const HullMesh& hulls, const MergeFilter& filter, double error,
                           HullVertex from_left, HullVertex from_right) {
  const glm::dvec2* points = hulls.points;
  const Mesh<2>& mesh = hulls.mesh;
  const auto right_of = [&](VertexNumber a, VertexNumber b, VertexNumber c) {
    const glm::dvec2 ac = points[a] - points[c], bc = points[b] - points[c];
    const double cross = ac.x * bc.y - ac.y * bc.x;
    if (std::abs(cross) > error) return cross < 0;
    return filter.right_of(points[a], points[b], points[c]);
  };
  VertexNumber left = from_left.vertex, right = from_right.vertex;
  SimplexNumber after_left = from_left.ghost, after_right = from_right.ghost;
  SimplexNumber before_left = kNoGhost, before_right = kNoGhost;
  if (after_left != kNoGhost) before_left = hulls.previous_ghost(after_left);
  if (after_right != kNoGhost) before_right = hulls.previous_ghost(after_right);
  for (bool moved = true; moved;) {
    moved = false;
    while (before_left != kNoGhost) {
      const VertexNumber next = mesh.vertex(before_left, 1);
      if (!right_of(left, right, next)) break;
      left = next;
      after_left = before_left;
      before_left = hulls.previous_ghost(before_left);
      moved = true;
    }
    while (after_right != kNoGhost) {
      const VertexNumber next = mesh.vertex(after_right, 0);
      if (!right_of(left, right, next)) break;
      right = next;
      before_right = after_right;
      after_right = hulls.next_ghost(after_right);
      moved = true;
    }
  }
  return {left, right, before_left, after_left, before_right, after_right};
}

}  // namespace

std::array<Tangent, 2> merge(HullMesh hulls, const MergeFilter& filter, HullVertex from_left,
                             HullVertex from_right, double extent, SimplexNumber spare) {
  const glm::dvec2* points = hulls.points;
  Mesh<2>& mesh = hulls.mesh;
  const MergeFilter::Bounds bounds = filter.bounds(extent);
  const double surely_above = std::max(bounds.cross, 0.0);
  auto [left, right, before_left, after_left, before_right, after_right] =
      lower_tangent(hulls, filter, bounds.cross, from_left, from_right);
  const SimplexNumber lower = spare, upper = spare + 1;
  const Tangent start{left, right, lower};
  hulls.set_ghost(lower, left, right);
  hulls.follow(before_left != kNoGhost ? before_left : upper, lower);
  hulls.follow(lower, after_right != kNoGhost ? after_right : upper);

  // The facet that the next triangle is built on, with `left` and `right` at its ends.
  CornerNumber base = corner_of(lower, 2);
  HullFront<kLeft> front_left(mesh, after_left, left);
  HullFront<kRight> front_right(mesh, before_right, right);
  for (;;) {
    const glm::dvec2 &a = points[left], &b = points[right];
    const auto view_next = [&] {
      return EdgeViewPair(a, b, PointPair(points[front_left.next], points[front_right.next]));
    };
    EdgeViewPair seen = view_next();
    const unsigned present = front_left.present | front_right.present;
    unsigned use = bits_of(seen.cross > surely_above) & present;
    if (const unsigned sure = bits_of(absolute(seen.cross) > bounds.cross); (present & ~sure) != 0)
        [[unlikely]] {
      const auto above = [&](VertexNumber next, unsigned side) {
        const glm::dvec2& p = points[next];
        if ((present & ~sure & side) != 0 && filter.above(a, b, p, EdgeView(a, b, p))) use |= side;
      };
      above(front_left.next, kLeft);
      above(front_right.next, kRight);
    }
    if (use == 0) break;

    const EdgeViewPair seen_behind(
        a, b, PointPair(points[front_left.behind], points[front_right.behind]));
    const Pair inside = seen.dot * seen_behind.cross - seen.cross * seen_behind.dot;
    // Where it overflows it is not a number, and nothing is sure.
    const unsigned surely_outside = bits_of(inside < -bounds.circle);
    const unsigned go = use & (front_left.is_backed | front_right.is_backed) & ~surely_outside;
    if (go != 0) {
      const unsigned surely = bits_of(inside > bounds.circle);
      if ((go & kLeft) != 0) front_left.retreat(hulls, filter, a, b, (surely & kLeft) != 0);
      if ((go & kRight) != 0) front_right.retreat(hulls, filter, a, b, (surely & kRight) != 0);
      seen = view_next();
    }

    const double right_inside = seen.dot[0] * seen.cross[1] - seen.cross[0] * seen.dot[1];
    unsigned left_loses = ~use | static_cast<unsigned>(right_inside > 0);
    if (use == (kLeft | kRight) && !(std::abs(right_inside) > bounds.circle)) [[unlikely]] {
      const glm::dvec2 &p = points[front_left.next], &q = points[front_right.next];
      left_loses = filter.inside(a, b, p, EdgeView(a, b, p), q, EdgeView(a, b, q)) ? 1 : 0;
    }
    if ((use >> 1 & left_loses & 1) != 0) {
      right = front_right.advance(hulls, left, base);
    } else {
      left = front_left.advance(hulls, right, base);
    }
  }
  hulls.set_ghost(upper, right, left);
  hulls.link(upper, 2, base);
  if (front_left.present != 0) hulls.follow(upper, front_left.ghost);
  if (front_right.present != 0) hulls.follow(front_right.ghost, upper);
  return {start, Tangent{left, right, upper}};
}

}  // namespace delray::delaunay::internal
