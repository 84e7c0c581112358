// A part is a set of points with the facets that walls left open towards it: all simplices that are
// still missing there have their corners among the points. A plane halves the points; the simplices
// that it crosses are reached from open facets that it crosses, over facets that it crosses. That
// fails only where none of the open facets does: the plane then crosses all of the hull within the
// part, or nothing; another axis is tried, and if none serves the part is wrapped as it is.
//
// The whole has no open facet: a visibility walk from any simplex towards the plane's other side
// finds the first of its wall.
#include "delaunay/construction/dewall.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "delaunay/construction/wrapping.h"
#include "delaunay/mesh/with_threads.h"
#include "parallel/arena.h"
#include "parallel/parallel_for.h"
#include "parallel/progress.h"

namespace delray::delaunay::internal {
namespace {

// Points whose coordinate is below `place` are on side 0, the others on side 1.
struct Plane {
  int axis = 0;
  double place = 0;
};

template <int D>
class Walls {
 public:
  using Point = Position<D>;

  Walls(const ApexSearch<D>& search, const Options& options)
      : search_(search),
        progress_(options.progress),
        threads_(options.threads),
        notes_creators_(options.created_by && options.threads > 1) {}

  Wrapped<D> run(const SimplexCorners<D>& first) {
    std::vector<VertexNumber> all(search_.points().size());
    for (VertexNumber v = 0; v < all.size(); ++v) all[v] = v;
    OpenFacets<D> open;
    Wrapped<D> made;
    const Plane plane = halving(all, longest_axis(all));
    const SimplexCorners<D> start = walk_to(plane, first, all);
    made.corners.assign(start.begin(), start.end());
    note_creators(made);
    for (unsigned k = 0; k <= D; ++k) open.toggle(outer_facet<D>(start, k));
    divide(std::move(all), open, made);
    return made;
  }

 private:
  // Fewer points are not worth a plane.
  static constexpr std::size_t kFewPoints = 256;

  const Point& at(VertexNumber v) const { return search_.points()[v]; }
  unsigned side_of(const Plane& plane, VertexNumber v) const {
    return at(v)[plane.axis] < plane.place ? 0 : 1;
  }
  // 0 or 1 if all are on one side, 2 if the plane crosses.
  template <std::size_t N>
  unsigned side_of(const Plane& plane, const std::array<VertexNumber, N>& corners) const {
    const unsigned side = side_of(plane, corners[0]);
    for (const VertexNumber v : corners) {
      if (side_of(plane, v) != side) return 2;
    }
    return side;
  }

  int longest_axis(const std::vector<VertexNumber>& vertices) const {
    geometry::Box<Point> box;
    for (const VertexNumber v : vertices) box.include(at(v));
    const Point size = box.high * 0.5 - box.low * 0.5;
    int axis = 0;
    for (int k = 1; k < D; ++k) {
      if (size[k] > size[axis]) axis = k;
    }
    return axis;
  }
  Plane halving(std::vector<VertexNumber> vertices, int axis) const {
    const auto middle = vertices.begin() + static_cast<std::ptrdiff_t>(vertices.size() / 2);
    std::ranges::nth_element(vertices, middle, {}, [&](VertexNumber v) { return at(v)[axis]; });
    return {axis, at(*middle)[axis]};
  }

  // The first simplex that the plane crosses on the way from one to a point on the other side of
  // it, or the one with that point. Returns the one given if all points are on one side.
  SimplexCorners<D> walk_to(const Plane& plane, SimplexCorners<D> simplex,
                            const std::vector<VertexNumber>& vertices) const {
    const unsigned side = side_of(plane, simplex);
    if (side == 2) return simplex;
    const auto target =
        std::ranges::find_if(vertices, [&](VertexNumber v) { return side_of(plane, v) != side; });
    if (target == vertices.end()) return simplex;
    while (side_of(plane, simplex) == side) {
      for (unsigned k = 0; k <= D; ++k) {
        const FacetCorners<D> facet = outer_facet<D>(simplex, k);
        std::array<Point, D + 1> beyond;
        for (unsigned i = 0; i < D; ++i) beyond[i] = at(facet[i]);
        beyond[D] = at(*target);
        if (orientation_of(beyond) <= 0) continue;
        simplex = *simplex_on<D>(search_, facet);
        break;
      }
    }
    return simplex;
  }

  void note_creators(Wrapped<D>& made) const {
    if (notes_creators_) {
      made.created_by.resize(made.corners.size() / (D + 1),
                             static_cast<std::uint16_t>(parallel::arena_thread()));
    }
  }

  // Makes what is missing in a part.
  void divide(std::vector<VertexNumber> vertices, OpenFacets<D>& open, Wrapped<D>& made) {
    if (vertices.size() > kFewPoints) {
      const std::vector<FacetCorners<D>> facets = open.all();
      const int longest = longest_axis(vertices);
      for (int i = 0; i < D; ++i) {
        const Plane plane = halving(vertices, (longest + i) % D);
        const bool crosses = std::ranges::any_of(
            facets, [&](const FacetCorners<D>& facet) { return side_of(plane, facet) == 2; });
        if (crosses) return cut(plane, vertices, facets, made);
      }
    }
    wrap(search_, open, made, [&](const SimplexCorners<D>& simplex) {
      for (unsigned k = 0; k <= D; ++k) open.toggle(outer_facet<D>(simplex, k));
      if (progress_ != nullptr) progress_->advance(0);
    });
    note_creators(made);
    if (progress_ != nullptr) progress_->advance(vertices.size());
  }

  void cut(const Plane& plane, const std::vector<VertexNumber>& vertices,
           const std::vector<FacetCorners<D>>& facets, Wrapped<D>& made) {
    std::array<OpenFacets<D>, 3> open;  // of the sides, and those that the plane crosses
    for (const FacetCorners<D>& facet : facets) open[side_of(plane, facet)].toggle(facet);
    wrap(search_, open[2], made, [&](const SimplexCorners<D>& simplex) {
      for (unsigned k = 0; k <= D; ++k) {
        const FacetCorners<D> facet = outer_facet<D>(simplex, k);
        open[side_of(plane, facet)].toggle(facet);
      }
      if (progress_ != nullptr) progress_->advance(0);
    });
    note_creators(made);
    std::array<std::vector<VertexNumber>, 2> halves;
    for (const VertexNumber v : vertices) halves[side_of(plane, v)].push_back(v);
    std::array<Wrapped<D>, 2> parts;
    const auto divide_half = [&](std::size_t i) {
      divide(std::move(halves[i]), open[i], parts[i]);
    };
    if (threads_ > 1) {
      parallel::parallel_for(0, 2, 1, divide_half);
    } else {
      for (std::size_t i = 0; i < 2; ++i) divide_half(i);
    }
    for (Wrapped<D>& part : parts) {
      made.corners.insert(made.corners.end(), part.corners.begin(), part.corners.end());
      made.hull_facets += part.hull_facets;
      made.created_by.insert(made.created_by.end(), part.created_by.begin(), part.created_by.end());
      part = {};
    }
  }

  const ApexSearch<D>& search_;
  parallel::Progress* progress_;
  int threads_;
  bool notes_creators_;
};

template <int D>
Result build_walls(PointView<double> points, const Options& options) {
  return construct<D>(points, options, [&](const auto& search, const SimplexCorners<D>& first) {
    return Walls<D>(search, options).run(first);
  });
}

}  // namespace

Result dewall(PointView<double> points, const Options& options) {
  return with_threads(options.threads, [&] {
    return options.dim == 2 ? build_walls<2>(points, options) : build_walls<3>(points, options);
  });
}

}  // namespace delray::delaunay::internal
