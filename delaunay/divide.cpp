#include "delaunay/internal/divide.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "delaunay/conflict.h"
#include "delaunay/internal/cell_order.h"
#include "delaunay/internal/cells.h"
#include "delaunay/internal/extract.h"
#include "delaunay/internal/seam_filter.h"
#include "delaunay/internal/stopwatch.h"
#include "delaunay/mesh.h"

namespace delray::delaunay::internal {
namespace {

constexpr SimplexNumber kNoGhost = 0xffffffffU;

// Every ghost keeps its infinite vertex in corner 2: corners 0 and 1 are the end and the start of
// an edge of the hull, counterclockwise about the points, neighbour 0 is the ghost of the edge
// before it and neighbour 1 that of the edge after it.
//
// A vertex of the hull, and the ghost of the edge that starts there (none for a single point).
struct HullVertex {
  VertexNumber vertex;
  SimplexNumber ghost;
};

// A triangulated range of points: the extreme vertices of its hull, ties broken by the other
// coordinate.
struct Part {
  HullVertex left, right, bottom, top;
};

bool less_by_y(const glm::dvec2& a, const glm::dvec2& b) {
  return a.y < b.y || (a.y == b.y && a.x < b.x);
}

class Divider {
 public:
  Divider(CellOrder& order, Mesh<2>& mesh, parallel::Progress* progress)
      : points_(order.points.data()),
        mesh_(mesh),
        filter_({order.points.data(), order.points.size()}, order.box),
        progress_(progress) {}

  // Triangulates points [first, last), whose triangles are [2 first, 2 last - 2): merging two
  // ranges needs two triangles more than they have, and those lie between them.
  Part divide(std::size_t first, std::size_t last, const CellGrid& grid) {
    if (last - first > kBlock) {
      const std::uint32_t low = grid.number(points_[first]), high = grid.number(points_[last - 1]);
      if (low == high) return divide_cell(first, last);
      const std::uint32_t middle = first_of_upper_half(low, high);
      const auto split = static_cast<std::size_t>(
          std::partition_point(points_ + first, points_ + last,
                               [&](const glm::dvec2& p) { return grid.number(p) < middle; }) -
          points_);
      const Part lower = divide(first, split, grid);
      return merge(lower, divide(split, last, grid), split, split_by_y(low, high));
    }
    std::array<std::uint32_t, kBlock> cells;
    for (std::size_t i = first; i < last; ++i) cells[i - first] = grid.number(points_[i]);
    const Part part = divide_block(first, last, cells.data() - first);
    if (progress_ != nullptr) progress_->advance(last - first);
    return part;
  }

 private:
  // Cell numbers of so many points are computed at once and looked up while dividing them.
  static constexpr std::size_t kBlock = 256;

  static std::uint32_t first_of_upper_half(std::uint32_t low, std::uint32_t high) {
    const int bit = std::bit_width(low ^ high) - 1;
    return high >> bit << bit;
  }

  Part divide_cell(std::size_t first, std::size_t last) {
    if (last - first <= kSmallCell) return divide_sorted(first, last);
    return divide(first, last, CellGrid(box_of({points_ + first, last - first})));
  }

  // Points in lexicographic order.
  Part divide_sorted(std::size_t first, std::size_t last) {
    if (last - first <= 3) return base(first, last);
    const std::size_t split = first + (last - first) / 2;
    const Part lower = divide_sorted(first, split);
    return merge(lower, divide_sorted(split, last), split, false);
  }

  Part divide_block(std::size_t first, std::size_t last, const std::uint32_t* cells) {
    if (last - first <= 3) return base(first, last);
    const std::uint32_t low = cells[first], high = cells[last - 1];
    if (low == high) return divide_cell(first, last);
    const std::uint32_t middle = first_of_upper_half(low, high);
    const auto split = static_cast<std::size_t>(
        std::partition_point(cells + first, cells + last,
                             [&](std::uint32_t cell) { return cell < middle; }) -
        cells);
    const Part lower = divide_block(first, split, cells);
    return merge(lower, divide_block(split, last, cells), split, split_by_y(low, high));
  }

  // One, two or three points.
  Part base(std::size_t first, std::size_t last) {
    const auto vertex = static_cast<VertexNumber>(first);
    if (last - first == 3) return triangle(vertex);
    if (last - first == 2) return segment(vertex);
    const HullVertex only{vertex, kNoGhost};
    return {only, only, only, only};
  }

  void set_triangle(SimplexNumber t, VertexNumber a, VertexNumber b, VertexNumber c) {
    mesh_.set_vertex(corner_of(t, 0), a);
    mesh_.set_vertex(corner_of(t, 1), b);
    mesh_.set_vertex(corner_of(t, 2), c);
  }
  // The ghost of the edge of the hull from a to b.
  void set_ghost(SimplexNumber t, VertexNumber a, VertexNumber b) {
    set_triangle(t, b, a, kInfiniteVertex);
  }
  void follow(SimplexNumber ghost, SimplexNumber next) {
    mesh_.link(corner_of(ghost, 1), corner_of(next, 0));
  }
  SimplexNumber next_ghost(SimplexNumber ghost) const {
    return simplex_of(mesh_.neighbour(corner_of(ghost, 1)));
  }
  SimplexNumber previous_ghost(SimplexNumber ghost) const {
    return simplex_of(mesh_.neighbour(corner_of(ghost, 0)));
  }

  // Two points are joined by two ghosts, back to back.
  Part segment(VertexNumber first) {
    const SimplexNumber there = 2 * first, back = there + 1;
    const VertexNumber a = first, b = first + 1;
    set_ghost(there, a, b);
    set_ghost(back, b, a);
    mesh_.link(corner_of(there, 2), corner_of(back, 2));
    follow(there, back);
    follow(back, there);
    const HullVertex at_a{a, there}, at_b{b, back};
    const bool rightward = lexicographically_less(points_[a], points_[b]);
    const bool upward = less_by_y(points_[a], points_[b]);
    return {rightward ? at_a : at_b, rightward ? at_b : at_a, upward ? at_a : at_b,
            upward ? at_b : at_a};
  }

  Part triangle(VertexNumber first) {
    const SimplexNumber inside = 2 * first;
    VertexNumber a = first, b = first + 1, c = first + 2;
    const int turn = orient2d(points_[a], points_[b], points_[c]);
    if (turn == 0) return chain(first);
    if (turn < 0) std::swap(b, c);
    set_triangle(inside, a, b, c);
    set_ghost(inside + 1, a, b);
    set_ghost(inside + 2, b, c);
    set_ghost(inside + 3, c, a);
    mesh_.link(corner_of(inside, 2), corner_of(inside + 1, 2));
    mesh_.link(corner_of(inside, 0), corner_of(inside + 2, 2));
    mesh_.link(corner_of(inside, 1), corner_of(inside + 3, 2));
    follow(inside + 1, inside + 2);
    follow(inside + 2, inside + 3);
    follow(inside + 3, inside + 1);
    return extremes({{{a, inside + 1}, {b, inside + 2}, {c, inside + 3}}});
  }

  // Three points on a line.
  Part chain(VertexNumber first) {
    VertexNumber a = first, b = first + 1, c = first + 2;
    if (lexicographically_less(points_[b], points_[a])) std::swap(a, b);
    if (lexicographically_less(points_[c], points_[b])) std::swap(b, c);
    if (lexicographically_less(points_[b], points_[a])) std::swap(a, b);
    const SimplexNumber t = 2 * first;
    set_ghost(t, a, b);
    set_ghost(t + 1, b, c);
    set_ghost(t + 2, c, b);
    set_ghost(t + 3, b, a);
    mesh_.link(corner_of(t, 2), corner_of(t + 3, 2));
    mesh_.link(corner_of(t + 1, 2), corner_of(t + 2, 2));
    for (SimplexNumber k = 0; k < 4; ++k) follow(t + k, t + (k + 1) % 4);
    return extremes({{{a, t}, {a, t}, {c, t + 2}}});
  }

  Part extremes(const std::array<HullVertex, 3>& hull) const {
    Part part{hull[0], hull[0], hull[0], hull[0]};
    for (const HullVertex& v : {hull[1], hull[2]}) {
      const glm::dvec2& p = points_[v.vertex];
      if (lexicographically_less(p, points_[part.left.vertex])) part.left = v;
      if (lexicographically_less(points_[part.right.vertex], p)) part.right = v;
      if (less_by_y(p, points_[part.bottom.vertex])) part.bottom = v;
      if (less_by_y(points_[part.top.vertex], p)) part.top = v;
    }
    return part;
  }

  // Where the seam begins or ends.
  struct Tangent {
    VertexNumber left, right;
    SimplexNumber ghost;
  };

  // Merges the ranges before and after `split`: the second lies to the right of the first, or above
  // it. What follows speaks of left and right; a quarter turn makes that of below and above.
  Part merge(const Part& first, const Part& second, std::size_t split, bool by_y) {
    const auto spare = static_cast<SimplexNumber>(2 * split - 2);
    const auto [lower, upper] =
        knit(by_y ? first.top : first.right, by_y ? second.bottom : second.left, spare);
    // The edges of the hull that start at these two are new; those of the other extremes are not.
    const auto of_first = [&, vertex = lower.left, ghost = lower.ghost](HullVertex v) {
      return v.vertex == vertex ? HullVertex{vertex, ghost} : v;
    };
    const auto of_second = [&, vertex = upper.right, ghost = upper.ghost](HullVertex v) {
      return v.vertex == vertex ? HullVertex{vertex, ghost} : v;
    };
    const auto less_of = [&](HullVertex a, HullVertex b, auto less) {
      return less(points_[b.vertex], points_[a.vertex]) ? of_second(b) : of_first(a);
    };
    const auto greater_of = [&](HullVertex a, HullVertex b, auto less) {
      return less(points_[a.vertex], points_[b.vertex]) ? of_second(b) : of_first(a);
    };
    return {less_of(first.left, second.left, lexicographically_less),
            greater_of(first.right, second.right, lexicographically_less),
            less_of(first.bottom, second.bottom, less_by_y),
            greater_of(first.top, second.top, less_by_y)};
  }

  // Fills the space between two hulls from their lower common tangent to the upper one.
  //
  // An edge of a hull that the other hull sees has a ghost, and it becomes the triangle that fills
  // the space before the edge: its infinite vertex is replaced by one of the other side. Edges that
  // are not Delaunay any more are flipped away first, which turns the triangle behind into a ghost.
  std::array<Tangent, 2> knit(HullVertex from_left, HullVertex from_right, SimplexNumber spare) {
    VertexNumber left = from_left.vertex, right = from_right.vertex;
    // The ghosts of the hull's edges around the tangent: before and after `left`, and `right`.
    SimplexNumber after_left = from_left.ghost, after_right = from_right.ghost;
    SimplexNumber before_left = kNoGhost, before_right = kNoGhost;
    if (after_left != kNoGhost) before_left = previous_ghost(after_left);
    if (after_right != kNoGhost) before_right = previous_ghost(after_right);
    for (bool moved = true; moved;) {
      moved = false;
      while (before_left != kNoGhost) {
        const VertexNumber next = mesh_.vertex(corner_of(before_left, 1));
        if (!filter_.right_of(points_[left], points_[right], points_[next])) break;
        left = next;
        after_left = before_left;
        before_left = previous_ghost(before_left);
        moved = true;
      }
      while (after_right != kNoGhost) {
        const VertexNumber next = mesh_.vertex(corner_of(after_right, 0));
        if (!filter_.right_of(points_[left], points_[right], points_[next])) break;
        right = next;
        before_right = after_right;
        after_right = next_ghost(after_right);
        moved = true;
      }
    }
    const SimplexNumber lower = spare, upper = spare + 1;
    const Tangent start{left, right, lower};
    set_ghost(lower, left, right);
    follow(before_left != kNoGhost ? before_left : upper, lower);
    follow(lower, after_right != kNoGhost ? after_right : upper);

    // The facet that the next triangle is built on, with `left` and `right` at its ends.
    CornerNumber base = corner_of(lower, 2);
    SimplexNumber ghost_left = after_left, ghost_right = before_right;
    for (;;) {
      const glm::dvec2 a = points_[left], b = points_[right];
      SeamView seen_left, seen_right;
      bool use_left = false, use_right = false;
      VertexNumber next_left = 0, next_right = 0;
      if (ghost_left != kNoGhost) {
        next_left = mesh_.vertex(corner_of(ghost_left, 0));
        seen_left = SeamView(a, b, points_[next_left]);
        use_left = filter_.above(a, b, points_[next_left], seen_left);
        while (use_left) {
          const CornerNumber apex = mesh_.neighbour(corner_of(ghost_left, 2));
          const VertexNumber behind = mesh_.vertex(apex);
          if (behind == kInfiniteVertex) break;
          const SeamView seen(a, b, points_[behind]);
          if (!filter_.inside(a, b, points_[next_left], seen_left, points_[behind], seen)) break;
          // The edge from left to next_left goes; ghost_left moves to the edge from left to behind.
          const SimplexNumber freed = simplex_of(apex);
          const CornerNumber beyond_near = mesh_.neighbour(previous_corner(apex));
          const CornerNumber beyond_far = mesh_.neighbour(next_corner(apex));
          const SimplexNumber after = next_ghost(ghost_left);
          set_ghost(freed, behind, next_left);
          mesh_.set_vertex(corner_of(ghost_left, 0), behind);
          mesh_.link(corner_of(ghost_left, 2), beyond_near);
          mesh_.link(corner_of(freed, 2), beyond_far);
          follow(ghost_left, freed);
          follow(freed, after);
          next_left = behind;
          seen_left = seen;
        }
      }
      if (ghost_right != kNoGhost) {
        next_right = mesh_.vertex(corner_of(ghost_right, 1));
        seen_right = SeamView(a, b, points_[next_right]);
        use_right = filter_.above(a, b, points_[next_right], seen_right);
        while (use_right) {
          const CornerNumber apex = mesh_.neighbour(corner_of(ghost_right, 2));
          const VertexNumber behind = mesh_.vertex(apex);
          if (behind == kInfiniteVertex) break;
          const SeamView seen(a, b, points_[behind]);
          if (!filter_.inside(a, b, points_[next_right], seen_right, points_[behind], seen)) break;
          const SimplexNumber freed = simplex_of(apex);
          const CornerNumber beyond_near = mesh_.neighbour(next_corner(apex));
          const CornerNumber beyond_far = mesh_.neighbour(previous_corner(apex));
          const SimplexNumber before = previous_ghost(ghost_right);
          set_ghost(freed, next_right, behind);
          mesh_.set_vertex(corner_of(ghost_right, 1), behind);
          mesh_.link(corner_of(ghost_right, 2), beyond_near);
          mesh_.link(corner_of(freed, 2), beyond_far);
          follow(freed, ghost_right);
          follow(before, freed);
          next_right = behind;
          seen_right = seen;
        }
      }
      if (!use_left && !use_right) break;
      if (use_left && use_right) {
        use_right =
            filter_.inside(a, b, points_[next_left], seen_left, points_[next_right], seen_right);
      }
      if (use_right) {
        const SimplexNumber before = previous_ghost(ghost_right);
        mesh_.set_vertex(corner_of(ghost_right, 2), left);
        mesh_.link(corner_of(ghost_right, 1), base);
        base = corner_of(ghost_right, 0);
        ghost_right = before;
        right = next_right;
      } else {
        const SimplexNumber after = next_ghost(ghost_left);
        mesh_.set_vertex(corner_of(ghost_left, 2), right);
        mesh_.link(corner_of(ghost_left, 0), base);
        base = corner_of(ghost_left, 1);
        ghost_left = after;
        left = next_left;
      }
    }
    set_ghost(upper, right, left);
    mesh_.link(corner_of(upper, 2), base);
    if (ghost_left != kNoGhost) follow(upper, ghost_left);
    if (ghost_right != kNoGhost) follow(ghost_right, upper);
    return {start, Tangent{left, right, upper}};
  }

  const glm::dvec2* points_;
  Mesh<2>& mesh_;
  SeamFilter filter_;
  parallel::Progress* progress_;
};

}  // namespace

Triangulation divide_and_conquer(PointView<double> points, const Options& options) {
  Stopwatch watch;
  CellOrder order = cell_order(points);
  const double order_seconds = watch.lap();
  const std::size_t n = order.points.size();
  Mesh<2> mesh(n < 2 ? 0 : 2 * n - 2);
  if (n >= 2) Divider(order, mesh, options.progress).divide(0, n, CellGrid(order.box));
  const double divide_seconds = watch.lap();
  order.points = {};
  Triangulation result = extract(std::move(mesh), {order.rows.data(), n});
  if (options.statistics != nullptr) {
    options.statistics->order = order_seconds;
    options.statistics->subdivide = divide_seconds;
    options.statistics->extract = watch.lap();
  }
  return result;
}

}  // namespace delray::delaunay::internal
