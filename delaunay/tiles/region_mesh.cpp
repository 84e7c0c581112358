// Finds what can change no more in the mesh of a region, by the neighbours that its method left.
// Vertices are numbered along the method's order, so that their points lie near each other; nothing
// but the few open simplices is looked at twice.
#include "delaunay/tiles/region_mesh.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "delaunay/mesh/blocks.h"
#include "delaunay/mesh/build_mesh.h"
#include "delaunay/mesh/facets.h"
#include "delaunay/mesh/simplex_hash.h"
#include "delaunay/tiles/circumball.h"
#include "delaunay/tiles/wall_table.h"

namespace delray::delaunay {
namespace {

using internal::Blocks;

template <class Point>
bool overlap(const geometry::Box<Point>& a, const geometry::Box<Point>& b) {
  return glm::all(glm::lessThanEqual(a.low, b.high)) && glm::all(glm::lessThanEqual(b.low, a.high));
}

// Calls found(tile) for the other tiles that `touches` is true for.
template <int D, class Touches, class Found>
void find_others(const OtherTiles& others, const Touches& touches, const Found& found) {
  others.boxes.tree<D>().find(touches, [&](std::uint32_t tile) {
    if (others.has(tile)) found(tile);
  });
}
template <int D, class Touches>
bool any_other(const OtherTiles& others, const Touches& touches) {
  return others.boxes.tree<D>().any(touches, [&](std::uint32_t tile) { return others.has(tile); });
}

// The box of the region's own tiles, or an empty one if other tiles reach into it.
template <int D>
geometry::Box<glm::vec<D, double>> own_box(const OtherTiles& others) {
  using Point = glm::vec<D, double>;
  geometry::Box<Point> box;
  for (std::size_t tile = others.first; tile < others.last; ++tile) {
    box.include(
        geometry::Box<Point>{Point(others.boxes[tile].low), Point(others.boxes[tile].high)});
  }
  const auto overlaps = [&](const geometry::Box<Point>& other) { return overlap(box, other); };
  return any_other<D>(others, overlaps) ? geometry::Box<Point>{} : box;
}

bool same_place(const RowPoint& a, const RowPoint& b, int dim) {
  const glm::dvec3 &p = a.position, &q = b.position;
  return p.x == q.x && p.y == q.y && (dim == 2 || p.z == q.z);
}

bool precedes(const RowPoint& a, const RowPoint& b, int dim) {
  for (int k = 0; k < dim; ++k) {
    if (a.position[k] != b.position[k]) return a.position[k] < b.position[k];
  }
  return a.row < b.row;
}

}  // namespace

template <int D>
RegionMesh<D>::RegionMesh(Region&& region, const Options& options)
    : options_(options),
      known_(std::move(region.points)),
      known_own_(region.own),
      has_walls_(!region.walls.empty()) {
  const PointView<double> view{reinterpret_cast<const std::byte*>(known_.data()), known_.size(),
                               sizeof(RowPoint)};
  BuiltMesh<D> built = known_.empty() ? BuiltMesh<D>() : build_mesh<D>(view, options);
  mesh_ = std::move(built.mesh);
  distinct_ = built.distinct;
  const Blocks slots(mesh_.size(), options.threads);
  std::vector<std::uint64_t> counts(slots.count());
  states_.resize(mesh_.size());
  slots.for_each([&](std::size_t block, std::size_t first, std::size_t last) {
    std::uint64_t count = 0;
    for (auto t = static_cast<SimplexNumber>(first); t < last; ++t) {
      const bool is_simplex = !mesh_.is_dead(t) && !mesh_.is_ghost(t);
      states_[t] = is_simplex ? kSettled : kNone;
      count += is_simplex ? 1 : 0;
    }
    counts[block] = count;
  });
  simplices_ = std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
  if (is_flat()) return;
  // Walls survive without simplices when nothing else is left: then points keep their places.
  vertices_ = simplices_ == 0 ? known_.size() : built.rows.size();
  if (simplices_ > 0) rows_ = std::move(built.rows);
  if (known_own_ < known_.size()) {
    is_own_.resize(vertices_);
    for (VertexNumber v = 0; v < vertices_; ++v) is_own_[v] = place_of(v) < known_own_ ? 1 : 0;
  }
  std::vector<Facet> walls(region.walls.size() / D);
  if (has_walls_) {
    std::vector<VertexNumber> vertex_of(known_.size());
    for (VertexNumber v = 0; v < vertices_; ++v) vertex_of[place_of(v)] = v;
    for (std::size_t i = 0; i < region.walls.size(); ++i) {
      walls[i / D][i % D] = vertex_of[region.walls[i]];
    }
  }
  find_outside(walls);
}

template <int D>
auto RegionMesh<D>::corners(SimplexNumber simplex) const -> Corners {
  Corners vertices;
  for (unsigned k = 0; k <= D; ++k) vertices[k] = mesh_.vertex(simplex, k);
  return vertices;
}

template <int D>
auto RegionMesh<D>::facet(SimplexNumber simplex, unsigned opposite) const -> Facet {
  Facet vertices;
  const std::span<const int> order = facet_corners(D, opposite);
  for (unsigned k = 0; k < D; ++k) {
    vertices[k] = mesh_.vertex(simplex, static_cast<unsigned>(order[k]));
  }
  return vertices;
}

template <int D>
template <std::size_t N>
bool RegionMesh<D>::has_own(const std::array<VertexNumber, N>& vertices) const {
  return is_own_.empty() ||
         std::ranges::any_of(vertices, [&](VertexNumber v) { return is_own_[v] != 0; });
}

template <int D>
template <std::size_t N>
bool RegionMesh<D>::all_own(const std::array<VertexNumber, N>& vertices) const {
  return is_own_.empty() ||
         std::ranges::all_of(vertices, [&](VertexNumber v) { return is_own_[v] != 0; });
}

template <int D>
template <std::size_t N>
bool RegionMesh<D>::lowest_is_own(const std::array<VertexNumber, N>& vertices) const {
  return is_own(
      *std::ranges::min_element(vertices, {}, [&](VertexNumber v) { return point(v).row; }));
}

template <int D>
template <std::size_t N>
auto RegionMesh<D>::positions(const std::array<VertexNumber, N>& vertices) const
    -> std::array<Point, N> {
  std::array<Point, N> places;
  for (std::size_t k = 0; k < N; ++k) places[k] = Point(point(vertices[k]).position);
  return places;
}

// Walks from the outer side of each wall over all facets that are none.
template <int D>
void RegionMesh<D>::find_outside(const std::vector<Facet>& walls) {
  std::vector<std::uint8_t> is_wall;  // of slots, a bit for each facet
  if (has_walls_) {
    is_wall.resize(mesh_.size());
    const WallTable<D> table(walls, vertices_);
    std::vector<std::uint8_t> has_outer(walls.size());
    std::vector<SimplexNumber> front;
    for (SimplexNumber t = 0; t < mesh_.size(); ++t) {
      if (states_[t] != kSettled) continue;
      states_[t] = kNone;
      for (unsigned k = 0; k <= D; ++k) {
        const auto found = table.find(facet(t, k));
        if (found.wall == table.kNoWall) continue;
        is_wall[t] |= static_cast<std::uint8_t>(1U << k);
        if (!found.turned) continue;
        has_outer[found.wall] = 1;
        front.push_back(t);
      }
    }
    while (!front.empty()) {
      const SimplexNumber t = front.back();
      front.pop_back();
      if (std::exchange(states_[t], std::uint8_t{kSettled}) == kSettled) continue;
      for (unsigned k = 0; k <= D; ++k) {
        const SimplexNumber next = simplex_of(mesh_.neighbour(t, k));
        if ((is_wall[t] >> k & 1) != 0 || mesh_.is_ghost(next)) continue;
        front.push_back(next);
      }
    }
    for (std::size_t i = 0; i < walls.size(); ++i) {
      if (has_outer[i] == 0) hull_.push_back({walls[i], kNoSimplex});
    }
  }
  for (SimplexNumber t = 0; t < mesh_.size(); ++t) {
    if (states_[t] != kNone || mesh_.is_dead(t) || !mesh_.is_ghost(t)) continue;
    unsigned k = 0;
    while (mesh_.vertex(t, k) != kInfiniteVertex) ++k;
    const CornerNumber inside = mesh_.neighbour(t, k);
    const SimplexNumber simplex = simplex_of(inside);
    if (states_[simplex] != kSettled) continue;
    if (!is_wall.empty() && (is_wall[simplex] >> (inside & 3) & 1) != 0) continue;
    hull_.push_back({facet(simplex, inside & 3), simplex});
  }
}

// Where no other tile reaches into the box of the own points, let p be a point of another tile. The
// simplices, ghosts included, whose closed balls p touches are connected across facets: lifted to
// the paraboloid, they are what a point just below the lift of p sees of the lower hull. Among them
// is one that p lies in; it has a vertex of others, or is a ghost, as p is outside of the hull of
// the own points. So open simplices are found from those along this border on.
template <int D>
std::vector<SimplexNumber> RegionMesh<D>::border() const {
  std::vector<SimplexNumber> found;
  for (const HullFacet& each : hull_) found.push_back(each.simplex);
  if (!is_own_.empty()) {
    for (SimplexNumber t = 0; t < mesh_.size(); ++t) {
      if (states_[t] != kNone && !all_own(corners(t))) found.push_back(t);
    }
  }
  std::ranges::sort(found);
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

template <int D>
bool RegionMesh<D>::is_open(SimplexNumber simplex, const OtherTiles& others,
                            const geometry::Box<Point>& box) const {
  const Corners vertices = corners(simplex);
  if (!has_own(vertices)) return true;
  const Circumball<D> ball(positions(vertices));
  return !ball.is_within(box) &&
         any_other<D>(others, [&](const auto& other) { return ball.touches(other); });
}

// By rings: all simplices of one are tested at the same time.
template <int D>
void RegionMesh<D>::spread_open(const OtherTiles& others, const geometry::Box<Point>& box) {
  std::vector<SimplexNumber> ring = border(), closed;
  for (const SimplexNumber t : ring) states_[t] = kTested;
  while (!ring.empty()) {
    std::vector<std::uint8_t> goes_on(ring.size());
    Blocks(ring.size(), options_.threads)
        .for_each([&](std::size_t, std::size_t first, std::size_t last) {
          for (std::size_t i = first; i < last; ++i) {
            const bool open = is_open(ring[i], others, box);
            if (open) states_[ring[i]] = kOpen;
            goes_on[i] = open || !all_own(corners(ring[i])) ? 1 : 0;
          }
        });
    std::vector<SimplexNumber> next;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      if (states_[ring[i]] == kTested) closed.push_back(ring[i]);
      if (goes_on[i] == 0) continue;
      for (unsigned k = 0; k <= D; ++k) {
        const SimplexNumber beyond = simplex_of(mesh_.neighbour(ring[i], k));
        if (states_[beyond] != kSettled) continue;
        states_[beyond] = kTested;
        next.push_back(beyond);
      }
    }
    ring = std::move(next);
  }
  for (const SimplexNumber t : closed) states_[t] = kSettled;
}

template <int D>
void RegionMesh<D>::find_open(const OtherTiles& others) {
  const auto box = own_box<D>(others);
  if (!has_walls_ && !box.empty()) {
    spread_open(others, box);
  } else {
    Blocks(mesh_.size(), options_.threads)
        .for_each([&](std::size_t, std::size_t first, std::size_t last) {
          for (auto t = static_cast<SimplexNumber>(first); t < last; ++t) {
            if (states_[t] != kNone && is_open(t, others, box)) states_[t] = kOpen;
          }
        });
  }
  for (HullFacet& each : hull_) {
    const auto places = positions(each.corners);
    each.open =
        (each.simplex != kNoSimplex && states_[each.simplex] == kOpen) || !has_own(each.corners) ||
        any_other<D>(others, [&](const auto& other) { return reaches_beyond(places, other); });
  }
}

template <int D>
std::vector<TileMessage> RegionMesh<D>::find_messages(const OtherTiles& others) const {
  std::vector<TileMessage> messages;
  if (is_flat()) {
    const Region rest = flat_rest();
    for (std::size_t tile = 0; tile < others.boxes.size(); ++tile) {
      if (!others.has(tile) || others.boxes[tile].empty()) continue;
      for (std::size_t i = 0; i < rest.own; ++i) messages.push_back({tile, rest.points[i]});
    }
    return messages;
  }
  const auto tell = [&](std::uint64_t tile, const auto& vertices) {
    for (const VertexNumber v : vertices) {
      if (is_own(v)) messages.push_back({tile, point(v)});
    }
  };
  for (SimplexNumber t = 0; t < mesh_.size(); ++t) {
    if (states_[t] != kOpen) continue;
    const Corners vertices = corners(t);
    if (!has_own(vertices)) continue;
    const Circumball<D> ball(positions(vertices));
    find_others<D>(
        others, [&](const auto& other) { return ball.touches(other); },
        [&](std::uint32_t tile) { tell(tile, vertices); });
  }
  for (const HullFacet& each : hull_) {
    if (!has_own(each.corners)) continue;
    const auto places = positions(each.corners);
    find_others<D>(
        others, [&](const auto& other) { return reaches_beyond(places, other); },
        [&](std::uint32_t tile) { tell(tile, each.corners); });
  }
  return messages;
}

template <int D>
Region RegionMesh<D>::flat_rest() const {
  Region rest;
  rest.points.assign(known_.begin(), known_.begin() + static_cast<std::ptrdiff_t>(known_own_));
  std::ranges::sort(rest.points,
                    [](const RowPoint& a, const RowPoint& b) { return precedes(a, b, D); });
  rest.points.erase(
      std::unique(rest.points.begin(), rest.points.end(),
                  [](const RowPoint& a, const RowPoint& b) { return same_place(a, b, D); }),
      rest.points.end());
  rest.own = rest.points.size();
  rest.points.insert(rest.points.end(), known_.begin() + static_cast<std::ptrdiff_t>(known_own_),
                     known_.end());
  return rest;
}

template <int D>
Region RegionMesh<D>::rest() const {
  if (is_flat()) return flat_rest();
  std::vector<Facet> walls;
  std::vector<std::uint8_t> keep(vertices_);
  for (SimplexNumber t = 0; t < mesh_.size(); ++t) {
    if (states_[t] != kOpen) continue;
    for (unsigned k = 0; k <= D; ++k) {
      keep[mesh_.vertex(t, k)] = 1;
      const CornerNumber next = mesh_.neighbour(t, k);
      const SimplexNumber beyond = simplex_of(next);
      if (states_[beyond] == kOpen || mesh_.is_ghost(beyond)) continue;
      walls.push_back(facet(beyond, next & 3));
    }
  }
  for (const HullFacet& each : hull_) {
    const bool is_kept = each.simplex != kNoSimplex && states_[each.simplex] == kOpen;
    if (each.open && !is_kept) walls.push_back(each.corners);
  }
  for (const Facet& wall : walls) {
    for (const VertexNumber v : wall) keep[v] = 1;
  }
  Region rest;
  std::vector<std::uint32_t> places(vertices_);
  for (const bool own : {true, false}) {
    for (VertexNumber v = 0; v < vertices_; ++v) {
      if (is_own(v) != own || (own && keep[v] == 0)) continue;
      places[v] = static_cast<std::uint32_t>(rest.points.size());
      rest.points.push_back(point(v));
    }
    if (own) rest.own = rest.points.size();
  }
  rest.walls.reserve(D * walls.size());
  for (const Facet& wall : walls) {
    for (const VertexNumber v : wall) rest.walls.push_back(places[v]);
  }
  return rest;
}

template <int D>
template <class Wanted>
FinalSimplices RegionMesh<D>::take(const Wanted& wanted, const FinalsWish& wish) {
  FinalSimplices taken;
  // Rows come by themselves: a simplex needs no more of its points than that.
  Array<std::uint64_t> rows(wish.hash ? vertices_ : 0);
  if (wish.simplices) taken.points = Array<RowPoint>(vertices_);
  Blocks(vertices_, options_.threads)
      .for_each([&](std::size_t, std::size_t first, std::size_t last) {
        for (auto v = static_cast<VertexNumber>(first); v < last; ++v) {
          const RowPoint& known = known_[place_of(v)];
          if (wish.hash) rows[v] = known.row;
          if (wish.simplices) taken.points[v] = known;
        }
      });
  const Blocks blocks(mesh_.size(), options_.threads);
  std::vector<std::size_t> begins(blocks.count() + 1);
  blocks.for_each([&](std::size_t block, std::size_t first, std::size_t last) {
    std::size_t count = 0;
    for (auto t = static_cast<SimplexNumber>(first); t < last; ++t) count += wanted(t) ? 1 : 0;
    begins[block + 1] = count;
  });
  std::partial_sum(begins.begin(), begins.end(), begins.begin());
  taken.count = begins.back();
  if (wish.simplices) taken.simplices = Array<std::uint32_t>((D + 1) * taken.count);
  std::vector<internal::HashSum> sums(blocks.count());
  blocks.for_each([&](std::size_t block, std::size_t first, std::size_t last) {
    std::uint32_t* to = taken.simplices.data() + (D + 1) * (wish.simplices ? begins[block] : 0);
    internal::HashSum sum;
    // Memory goes back to the system by whole huge pages.
    constexpr std::size_t kPiece = std::size_t{1} << (D == 2 ? 18 : 16);
    for (std::size_t begin = first; begin < last; begin += kPiece) {
      const std::size_t end = std::min(last, begin + kPiece);
      for (auto t = static_cast<SimplexNumber>(begin); t < end; ++t) {
        if (!wanted(t)) continue;
        const Corners vertices = corners(t);
        if (wish.simplices) to = std::ranges::copy(vertices, to).out;
        if (!wish.hash) continue;
        std::array<std::uint64_t, D + 1> of_corners;
        for (unsigned k = 0; k <= D; ++k) of_corners[k] = rows[vertices[k]];
        sum.add(of_corners);
      }
      if (wish.simplices) mesh_.discard(begin, end);
    }
    sums[block] = sum;
  });
  for (const internal::HashSum& sum : sums) taken.hash = taken.hash + sum.sum();
  mesh_ = {};
  return taken;
}

template <int D>
FinalSimplices RegionMesh<D>::take_settled(const FinalsWish& wish) {
  std::uint64_t facets = 0;
  for (const HullFacet& each : hull_) facets += each.open ? 0 : 1;
  FinalSimplices taken = take([&](SimplexNumber t) { return states_[t] == kSettled; }, wish);
  taken.hull_facets = facets;
  return taken;
}

template <int D>
FinalSimplices RegionMesh<D>::take_own(const FinalsWish& wish) {
  std::uint64_t facets = 0;
  for (const HullFacet& each : hull_) facets += lowest_is_own(each.corners) ? 1 : 0;
  // Twice each, as they are few.
  FinalSimplices taken =
      take([&](SimplexNumber t) { return states_[t] != kNone && lowest_is_own(corners(t)); }, wish);
  taken.hull_facets = facets;
  return taken;
}

template class RegionMesh<2>;
template class RegionMesh<3>;

}  // namespace delray::delaunay
