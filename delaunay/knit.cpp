#include "delaunay/internal/knit.h"

namespace delray::delaunay::internal {

std::array<Tangent, 2> knit(HullMesh hulls, const SeamFilter& filter, HullVertex from_left,
                            HullVertex from_right, SimplexNumber spare) {
  const glm::dvec2* points = hulls.points;
  Mesh<2>& mesh = hulls.mesh;
  VertexNumber left = from_left.vertex, right = from_right.vertex;
  // The ghosts of the hull's edges around the tangent: before and after `left`, and `right`.
  SimplexNumber after_left = from_left.ghost, after_right = from_right.ghost;
  SimplexNumber before_left = kNoGhost, before_right = kNoGhost;
  if (after_left != kNoGhost) before_left = hulls.previous_ghost(after_left);
  if (after_right != kNoGhost) before_right = hulls.previous_ghost(after_right);
  for (bool moved = true; moved;) {
    moved = false;
    while (before_left != kNoGhost) {
      const VertexNumber next = mesh.vertex(corner_of(before_left, 1));
      if (!filter.right_of(points[left], points[right], points[next])) break;
      left = next;
      after_left = before_left;
      before_left = hulls.previous_ghost(before_left);
      moved = true;
    }
    while (after_right != kNoGhost) {
      const VertexNumber next = mesh.vertex(corner_of(after_right, 0));
      if (!filter.right_of(points[left], points[right], points[next])) break;
      right = next;
      before_right = after_right;
      after_right = hulls.next_ghost(after_right);
      moved = true;
    }
  }
  const SimplexNumber lower = spare, upper = spare + 1;
  const Tangent start{left, right, lower};
  hulls.set_ghost(lower, left, right);
  hulls.follow(before_left != kNoGhost ? before_left : upper, lower);
  hulls.follow(lower, after_right != kNoGhost ? after_right : upper);

  // The facet that the next triangle is built on, with `left` and `right` at its ends.
  CornerNumber base = corner_of(lower, 2);
  SimplexNumber ghost_left = after_left, ghost_right = before_right;
  for (;;) {
    const glm::dvec2 a = points[left], b = points[right];
    SeamView seen_left, seen_right;
    bool use_left = false, use_right = false;
    VertexNumber next_left = 0, next_right = 0;
    if (ghost_left != kNoGhost) {
      next_left = mesh.vertex(corner_of(ghost_left, 0));
      seen_left = SeamView(a, b, points[next_left]);
      use_left = filter.above(a, b, points[next_left], seen_left);
      while (use_left) {
        const CornerNumber apex = mesh.neighbour(corner_of(ghost_left, 2));
        const VertexNumber behind = mesh.vertex(apex);
        if (behind == kInfiniteVertex) break;
        const SeamView seen(a, b, points[behind]);
        if (!filter.inside(a, b, points[next_left], seen_left, points[behind], seen)) break;
        // The edge from left to next_left goes; ghost_left moves to the edge from left to behind.
        const SimplexNumber freed = simplex_of(apex);
        const CornerNumber beyond_near = mesh.neighbour(previous_corner(apex));
        const CornerNumber beyond_far = mesh.neighbour(next_corner(apex));
        const SimplexNumber after = hulls.next_ghost(ghost_left);
        hulls.set_ghost(freed, behind, next_left);
        mesh.set_vertex(corner_of(ghost_left, 0), behind);
        mesh.link(corner_of(ghost_left, 2), beyond_near);
        mesh.link(corner_of(freed, 2), beyond_far);
        hulls.follow(ghost_left, freed);
        hulls.follow(freed, after);
        next_left = behind;
        seen_left = seen;
      }
    }
    if (ghost_right != kNoGhost) {
      next_right = mesh.vertex(corner_of(ghost_right, 1));
      seen_right = SeamView(a, b, points[next_right]);
      use_right = filter.above(a, b, points[next_right], seen_right);
      while (use_right) {
        const CornerNumber apex = mesh.neighbour(corner_of(ghost_right, 2));
        const VertexNumber behind = mesh.vertex(apex);
        if (behind == kInfiniteVertex) break;
        const SeamView seen(a, b, points[behind]);
        if (!filter.inside(a, b, points[next_right], seen_right, points[behind], seen)) break;
        const SimplexNumber freed = simplex_of(apex);
        const CornerNumber beyond_near = mesh.neighbour(next_corner(apex));
        const CornerNumber beyond_far = mesh.neighbour(previous_corner(apex));
        const SimplexNumber before = hulls.previous_ghost(ghost_right);
        hulls.set_ghost(freed, next_right, behind);
        mesh.set_vertex(corner_of(ghost_right, 1), behind);
        mesh.link(corner_of(ghost_right, 2), beyond_near);
        mesh.link(corner_of(freed, 2), beyond_far);
        hulls.follow(freed, ghost_right);
        hulls.follow(before, freed);
        next_right = behind;
        seen_right = seen;
      }
    }
    if (!use_left && !use_right) break;
    if (use_left && use_right) {
      use_right = filter.inside(a, b, points[next_left], seen_left, points[next_right], seen_right);
    }
    if (use_right) {
      const SimplexNumber before = hulls.previous_ghost(ghost_right);
      mesh.set_vertex(corner_of(ghost_right, 2), left);
      mesh.link(corner_of(ghost_right, 1), base);
      base = corner_of(ghost_right, 0);
      ghost_right = before;
      right = next_right;
    } else {
      const SimplexNumber after = hulls.next_ghost(ghost_left);
      mesh.set_vertex(corner_of(ghost_left, 2), right);
      mesh.link(corner_of(ghost_left, 0), base);
      base = corner_of(ghost_left, 1);
      ghost_left = after;
      left = next_left;
    }
  }
  hulls.set_ghost(upper, right, left);
  mesh.link(corner_of(upper, 2), base);
  if (ghost_left != kNoGhost) hulls.follow(upper, ghost_left);
  if (ghost_right != kNoGhost) hulls.follow(ghost_right, upper);
  return {start, Tangent{left, right, upper}};
}

}  // namespace delray::delaunay::internal
