// Divide and conquer for 2D Delaunay triangulations (Guibas and Stolfi 1985), with ghost triangles
// (Shewchuk 1996) and cuts that alternate between the axes (Dwyer 1987).
//
// Points come sorted by the cells of a grid, so the highest bit in which cell numbers differ tells
// where to cut. Up to three points, and four as a rule, are triangulated directly, larger ranges
// recursively, and merge.h joins the halves. Every range of points has slots of the mesh to itself,
// so halves never share memory and large ones are divided on separate threads. O(n) expected for
// points of bounded density, otherwise O(n) times the depth of the cells.
//
// Degenerate: duplicates are removed before. Points on a line become a chain of ghosts, so the
// result has no triangles. A cell with many points gets a grid of its own, and one with few is cut
// in lexicographic order.
#include "delaunay/divide_and_conquer/divide.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "delaunay/divide_and_conquer/base_cases.h"
#include "delaunay/divide_and_conquer/hull_mesh.h"
#include "delaunay/divide_and_conquer/merge.h"
#include "delaunay/divide_and_conquer/merge_filter.h"
#include "delaunay/mesh/extract.h"
#include "delaunay/mesh/mesh.h"
#include "delaunay/mesh/stopwatch.h"
#include "delaunay/mesh/with_threads.h"
#include "delaunay/order/cell_order.h"
#include "delaunay/order/cells.h"
#include "delaunay/predicates/conflict.h"
#include "parallel/arena.h"
#include "parallel/parallel_for.h"

namespace delray::delaunay::internal {
namespace {

class Divider {
 public:
  Divider(const CellOrder& order, Mesh<2>& mesh, const Options& options)
      : points_(order.points.data()),
        hulls_{order.points.data(), mesh},
        filter_({order.points.data(), order.points.size()}, order.box, options.threads),
        base_cases_(hulls_, filter_),
        progress_(options.progress),
        parallel_(options.threads > 1) {
    if (parallel_ && options.created_by) created_by_.assign(mesh.size(), 0);
  }
  Divider(const Divider&) = delete;
  Divider& operator=(const Divider&) = delete;

  // Triangulates points [first, last), whose triangles are [2 first, 2 last - 2): merging two
  // ranges needs two triangles more than they have, and those lie between them.
  Part divide(std::size_t first, std::size_t last, const CellGrid& grid) {
    if (!parallel_ || last - first <= kPointsPerTask) {
      note_creator(first, last);
      return timed([&] { return divide_alone(first, last, grid); });
    }
    const std::uint32_t low = grid.number(points_[first]), high = grid.number(points_[last - 1]);
    if (low == high) return divide(first, last, grid_over(first, last));
    const std::size_t split = find_split(first, last, grid, low, high);
    return divide_at(split, split_by_y(low, high), [&](bool upper) {
      return upper ? divide(split, last, grid) : divide(first, split, grid);
    });
  }

  // The same of points in lexicographic order, by vertical lines alone.
  Part divide_vertically(std::size_t first, std::size_t last) {
    if (last - first <= kPointsPerTask) {
      note_creator(first, last);
      const Part part = timed([&] { return divide_sorted(first, last); });
      if (progress_ != nullptr) progress_->advance(last - first);
      return part;
    }
    const std::size_t split = first + (last - first) / 2;
    return divide_at(split, false, [&](bool upper) {
      return upper ? divide_vertically(split, last) : divide_vertically(first, split);
    });
  }

  // Summed over threads.
  double seconds() const { return seconds_.load(); }

  // For each slot of the mesh the thread that made its triangle; empty if nobody wants to know, or
  // one thread made all.
  std::vector<std::uint16_t> take_created_by() { return std::move(created_by_); }

 private:
  // Cell numbers of so many points are computed at once and looked up while dividing them.
  static constexpr std::size_t kBlock = 256;
  // Takes about a millisecond.
  static constexpr std::size_t kPointsPerTask = 8192;

  // half(false) triangulates the points before `split`, half(true) the others.
  template <class Half>
  Part divide_at(std::size_t split, bool by_y, const Half& half) {
    std::array<Part, 2> halves;
    if (parallel_) {
      parallel::parallel_for(0, 2, 1, [&](std::size_t i) { halves[i] = half(i == 1); });
    } else {
      halves = {half(false), half(true)};
    }
    const Part whole = timed([&] { return merge(halves[0], halves[1], split, by_y); });
    note_creator_of_merge(split);
    return whole;
  }

  template <class F>
  Part timed(const F& f) {
    Stopwatch watch;
    const Part part = f();
    seconds_.fetch_add(watch.lap(), std::memory_order_relaxed);
    return part;
  }

  // All triangles of a range are the calling thread's.
  void note_creator(std::size_t first, std::size_t last) {
    if (created_by_.empty()) return;
    const auto begin = created_by_.begin() + static_cast<std::ptrdiff_t>(2 * first);
    const auto end = created_by_.begin() + static_cast<std::ptrdiff_t>(2 * last - 2);
    std::fill(begin, end, static_cast<std::uint16_t>(parallel::arena_thread()));
  }
  // The triangles that a merge has made are the calling thread's too: they have vertices on both
  // sides of `split`, and lie in a row from one of the two slots before it to the other.
  void note_creator_of_merge(std::size_t split) {
    if (created_by_.empty()) return;
    const auto thread = static_cast<std::uint16_t>(parallel::arena_thread());
    const Mesh<2>& mesh = hulls_.mesh;
    CornerNumber entry = mesh.neighbour(static_cast<SimplexNumber>(2 * split - 2), 2);
    while (!mesh.is_ghost(simplex_of(entry))) {
      created_by_[simplex_of(entry)] = thread;
      // The other edge with an end on either side is opposite the vertex on the apex's side.
      const CornerNumber one = next_corner(entry), other = previous_corner(entry);
      const bool is_apex_first = mesh.vertex(entry) < split;
      entry = mesh.neighbour((mesh.vertex(one) < split) == is_apex_first ? one : other);
    }
  }

  static std::uint32_t first_of_upper_half(std::uint32_t low, std::uint32_t high) {
    const int bit = std::bit_width(low ^ high) - 1;
    return high >> bit << bit;
  }
  std::size_t find_split(std::size_t first, std::size_t last, const CellGrid& grid,
                         std::uint32_t low, std::uint32_t high) const {
    const std::uint32_t upper = first_of_upper_half(low, high);
    const auto below = [&](const glm::dvec2& p) { return grid.number(p) < upper; };
    return static_cast<std::size_t>(std::partition_point(points_ + first, points_ + last, below) -
                                    points_);
  }
  CellGrid grid_over(std::size_t first, std::size_t last) const {
    return CellGrid(box_of({points_ + first, last - first}));
  }

  Part divide_alone(std::size_t first, std::size_t last, const CellGrid& grid) {
    if (last - first <= kBlock) {
      const Part part = divide_block(first, last, grid);
      if (progress_ != nullptr) progress_->advance(last - first);
      return part;
    }
    const std::uint32_t low = grid.number(points_[first]), high = grid.number(points_[last - 1]);
    if (low == high) return divide_alone(first, last, grid_over(first, last));
    const std::size_t split = find_split(first, last, grid, low, high);
    const Part lower = divide_alone(first, split, grid);
    return merge(lower, divide_alone(split, last, grid), split, split_by_y(low, high));
  }

  Part divide_block(std::size_t first, std::size_t last, const CellGrid& grid) {
    std::array<std::uint32_t, kBlock> cells;
    for (std::size_t i = first; i < last; ++i) cells[i - first] = grid.number(points_[i]);
    return divide_cells(first, std::span(cells).first(last - first));
  }

  // Points in lexicographic order.
  Part divide_sorted(std::size_t first, std::size_t last) {
    if (last - first <= 3) return base_cases_.few(first, last);
    const std::size_t split = first + (last - first) / 2;
    const Part lower = divide_sorted(first, split);
    return merge(lower, divide_sorted(split, last), split, false);
  }

  // Points from `first` on in the given cells.
  Part divide_cells(std::size_t first, std::span<const std::uint32_t> cells) {
    const std::size_t last = first + cells.size();
    if (cells.size() <= 3) return base_cases_.few(first, last);
    if (cells.size() == 4) {
      if (const auto part = base_cases_.four(static_cast<VertexNumber>(first))) return *part;
    }
    const std::uint32_t low = cells.front(), high = cells.back();
    if (low == high) {
      return cells.size() <= kSmallCell ? divide_sorted(first, last)
                                        : divide_block(first, last, grid_over(first, last));
    }
    const auto split = static_cast<std::size_t>(
        std::ranges::lower_bound(cells, first_of_upper_half(low, high)) - cells.begin());
    const Part lower = divide_cells(first, cells.first(split));
    return merge(lower, divide_cells(first + split, cells.subspan(split)), first + split,
                 split_by_y(low, high));
  }

  // Merges the ranges before and after `split`: the second lies to the right of the first, or above
  // it. The merge speaks of left and right; a quarter turn makes those below and above.
  Part merge(const Part& first, const Part& second, std::size_t split, bool by_y) {
    const auto spare = static_cast<SimplexNumber>(2 * split - 2);
    const auto [lower, upper] =
        internal::merge(hulls_, filter_, by_y ? first.top : first.right,
                        by_y ? second.bottom : second.left, extent_of(first, second), spare);
    // The edges of the hull that start at these two are new; those of the other extremes are not.
    const auto of_first = [&, vertex = lower.left, ghost = lower.ghost](HullVertex v) {
      return v.vertex == vertex ? HullVertex{vertex, ghost} : v;
    };
    const auto of_second = [&, vertex = upper.right, ghost = upper.ghost](HullVertex v) {
      return v.vertex == vertex ? HullVertex{vertex, ghost} : v;
    };
    // The extremes in the direction in which the ranges follow each other are known.
    if (by_y) {
      return {precedes(second.left, first.left) ? of_second(second.left) : of_first(first.left),
              precedes(first.right, second.right) ? of_second(second.right) : of_first(first.right),
              of_first(first.bottom), of_second(second.top)};
    }
    return {of_first(first.left), of_second(second.right),
            below(second.bottom, first.bottom) ? of_second(second.bottom) : of_first(first.bottom),
            below(first.top, second.top) ? of_second(second.top) : of_first(first.top)};
  }

  // At least |dx| + |dy| of any two points of both, but for rounding.
  double extent_of(const Part& first, const Part& second) const {
    const auto x = [&](HullVertex v) { return points_[v.vertex].x; };
    const auto y = [&](HullVertex v) { return points_[v.vertex].y; };
    const double width =
        std::max(x(first.right), x(second.right)) - std::min(x(first.left), x(second.left));
    const double height =
        std::max(y(first.top), y(second.top)) - std::min(y(first.bottom), y(second.bottom));
    return width + height;
  }

  bool precedes(HullVertex a, HullVertex b) const {
    const glm::dvec2 &p = points_[a.vertex], &q = points_[b.vertex];
    return before(p.x, p.y, q.x, q.y);
  }
  bool below(HullVertex a, HullVertex b) const {
    const glm::dvec2 &p = points_[a.vertex], &q = points_[b.vertex];
    return before(p.y, p.x, q.y, q.x);
  }

  const glm::dvec2* points_;
  HullMesh hulls_;
  MergeFilter filter_;
  BaseCases base_cases_;
  parallel::Progress* progress_;
  bool parallel_;
  std::vector<std::uint16_t> created_by_;  // by slot; empty if nobody wants to know
  std::atomic<double> seconds_ = 0;
};

struct Divided {
  BuiltMesh<2> built;
  std::vector<std::uint16_t> created_by;
  Statistics seconds;
};

enum class Cuts { kAlternating, kVertical };

void sort_lexicographically(CellOrder& order, std::size_t n) {
  std::vector<std::pair<glm::dvec2, std::uint32_t>> sorted(n);
  for (std::size_t i = 0; i < n; ++i) sorted[i] = {order.points[i], order.rows[i]};
  std::ranges::sort(sorted, [](const auto& a, const auto& b) {
    return lexicographically_less(a.first, b.first);
  });
  for (std::size_t i = 0; i < n; ++i) std::tie(order.points[i], order.rows[i]) = sorted[i];
}

Divided divide(PointView<double> points, const Options& options, Cuts cuts) {
  Divided result;
  Stopwatch watch;
  CellOrder order = cell_order(points, options.threads);
  const std::size_t n = order.points.size();
  if (cuts == Cuts::kVertical) sort_lexicographically(order, n);
  result.seconds.order = watch.lap();
  if (options.progress != nullptr) options.progress->advance(points.size() - n);
  result.built.mesh = Mesh<2>(n < 2 ? 0 : 2 * n - 2);
  if (n >= 2) {
    Divider divider(order, result.built.mesh, options);
    if (cuts == Cuts::kVertical) {
      divider.divide_vertically(0, n);
    } else {
      divider.divide(0, n, CellGrid(order.box));
    }
    result.seconds.subdivide = divider.seconds();
    result.created_by = divider.take_created_by();
  }
  order.rows.shrink(n);
  result.built.rows = std::move(order.rows);
  result.built.distinct = n;
  return result;
}

Result run(PointView<double> points, const Options& options, Cuts cuts) {
  Divided divided = divide(points, options, cuts);
  Stopwatch watch;
  const Array<std::uint32_t>& rows = divided.built.rows;
  Result result = extract(std::move(divided.built.mesh), {rows.data(), rows.size()},
                          options.threads, std::move(divided.created_by));
  divided.seconds.extract = watch.lap();
  result.statistics = divided.seconds;
  return result;
}

}  // namespace

Result divide_and_conquer(PointView<double> points, const Options& options) {
  return with_threads(options.threads, [&] { return run(points, options, Cuts::kAlternating); });
}

BuiltMesh<2> divide_and_conquer_mesh(PointView<double> points, const Options& options) {
  return with_threads(options.threads,
                      [&] { return divide(points, options, Cuts::kAlternating).built; });
}

Result guibas_stolfi(PointView<double> points, const Options& options) {
  return with_threads(options.threads, [&] { return run(points, options, Cuts::kVertical); });
}

}  // namespace delray::delaunay::internal
