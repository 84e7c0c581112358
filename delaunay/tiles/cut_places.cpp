// Cuts space by partitions of grids of counts, coarse ones first (see tile_cut.h).
//
// A point near a cut costs more than others: simplices there are made by the tiles on both sides,
// and once more when these are put together. How far that reaches depends on how far apart points
// are, which a tree of the places tells (Bentley 1975). So once space is cut, places near the cut
// weigh more in those that follow.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "delaunay/tiles/tile_cut.h"
#include "geometry/box.h"
#include "loadbalance/costs.h"

namespace delray::delaunay {
namespace {

using geometry::Rect;
using Owned = loadbalance::Region;

struct Place {
  glm::dvec3 at;
  double reach = 0;   // how near a cut has to be for the place to cost more
  double weight = 1;  // that of those that no cut is near
};

// A cut is felt by so many layers of points on each side, which then cost so much more each.
// Measured in space: an inner tile of n points is told of 18 n^(2/3), three layers for each face,
// and makes its own points there again with these.
constexpr double kLayers = 3, kCostOfLayer = 2;

// Finds the reaches of places, each of which stands for so many points. O(n log n).
void find_reaches(std::span<Place> places, int dim, double points_per_place) {
  constexpr std::size_t kLeaf = 8;
  geometry::Box3d box;
  for (const Place& place : places) box.include(place.at);
  const glm::dvec3 size = box.high - box.low;
  const auto n = static_cast<double>(places.size());
  if (places.size() <= kLeaf) {
    if (places.size() < 2) return;
    // Of n uniform places the box is (n - 1) / (n + 1) as long as the cell that they lie in.
    double volume = 1 / (n * points_per_place);
    for (int k = 0; k < dim; ++k) volume *= size[k] * (n + 1) / (n - 1);
    const double reach = kLayers * std::pow(volume, 1.0 / dim);
    for (Place& place : places) place.reach = std::isfinite(reach) ? reach : 0;
    return;
  }
  int longest = 0;
  for (int k = 1; k < dim; ++k) longest = size[k] > size[longest] ? k : longest;
  const auto middle = places.begin() + std::ssize(places) / 2;
  std::nth_element(places.begin(), middle, places.end(), [longest](const Place& a, const Place& b) {
    return a.at[longest] < b.at[longest];
  });
  find_reaches({places.begin(), middle}, dim, points_per_place);
  find_reaches({middle, places.end()}, dim, points_per_place);
}

// A grid of nearly square cells over the two longest axes of a box, in ascending order.
struct PlaneGrid {
  std::array<int, 2> axes = {0, 1};
  std::array<int, 2> cells = {1, 1};
  std::array<double, 2> low = {0, 0}, high = {0, 0};

  PlaneGrid(const geometry::Box3d& box, int dim, int tiles) {
    if (dim == 3) {
      int shortest = 2;
      for (const int k : {1, 0}) {
        if (half(box, k) < half(box, shortest)) shortest = k;
      }
      axes = {shortest == 0 ? 1 : 0, shortest == 2 ? 1 : 2};
    }
    for (std::size_t i = 0; i < 2; ++i) {
      low[i] = box.low[axes[i]];
      high[i] = box.high[axes[i]];
    }
    constexpr double kPerTile = 64, kFewest = 16, kMost = 65536;
    const std::size_t longer = half(1) > half(0) ? 1 : 0, shorter = 1 - longer;
    if (!(half(longer) > 0)) return;
    const double wanted = std::min(kPerTile * tiles, kMost);
    const double ratio = half(shorter) / half(longer);
    cells[longer] = static_cast<int>(
        std::clamp(std::ceil(std::sqrt(wanted / ratio)), kFewest, std::max(kFewest, wanted)));
    cells[shorter] =
        std::clamp(static_cast<int>(std::ceil(cells[longer] * ratio)), 1, cells[longer]);
  }

  // Halves, as differences of large coordinates may be infinite.
  static double half(const geometry::Box3d& box, int axis) {
    return box.high[axis] * 0.5 - box.low[axis] * 0.5;
  }
  double half(std::size_t i) const { return high[i] * 0.5 - low[i] * 0.5; }
  bool is_point() const { return !(half(0) > 0) && !(half(1) > 0); }

  int cell_of(const glm::dvec3& place, std::size_t i) const {
    const double size = half(i);
    if (!(size > 0)) return 0;
    const double at = (place[axes[i]] * 0.5 - low[i] * 0.5) / size * cells[i];
    return std::clamp(static_cast<int>(at), 0, cells[i] - 1);
  }
  double border(int cell, std::size_t i) const {
    const double share = std::clamp(double(cell) / cells[i], 0.0, 1.0);
    return low[i] * (1 - share) + high[i] * share;
  }
};

loadbalance::Costs count(const PlaneGrid& grid, std::span<const Place> places) {
  const auto [columns, rows] = grid.cells;
  loadbalance::Costs costs{{0, 0, columns, rows}, columns, rows, {}, {}, {}, {}};
  const std::size_t cells = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  costs.cells.resize(cells);
  costs.cross_right.resize(cells);
  costs.cross_down.resize(cells);
  for (const Place& place : places) {
    costs.cells[static_cast<std::size_t>(grid.cell_of(place.at, 1)) *
                    static_cast<std::size_t>(columns) +
                static_cast<std::size_t>(grid.cell_of(place.at, 0))] += place.weight;
  }
  return costs;
}

int low_of(const Rect& rect, std::size_t i) { return i == 0 ? rect.x0 : rect.y0; }
int high_of(const Rect& rect, std::size_t i) { return i == 0 ? rect.x1 : rect.y1; }

struct Line {
  std::size_t along = 0;  // the axis of the grid that it is across
  int cell = 0;           // that it is before
  int before = 0;         // owners on the lower side
};

// The line that the fewest rectangles lie across, of these the one with the most even number of
// rectangles on both sides. None if all lines are outside of all rectangles.
struct Crossing {
  Line line;
  int crossed = 0;
};
std::optional<Crossing> best_line(std::span<const Rect> rects) {
  std::optional<Crossing> best;
  const auto n = static_cast<int>(rects.size());
  for (const std::size_t along : {std::size_t{0}, std::size_t{1}}) {
    std::vector<int> lows, highs;
    for (const Rect& rect : rects) {
      lows.push_back(low_of(rect, along));
      highs.push_back(high_of(rect, along));
    }
    std::ranges::sort(lows);
    std::ranges::sort(highs);
    // Of every border between rectangles how many end there or before, and how many begin before.
    std::size_t begun = 0, ended = 0;
    while (ended < highs.size()) {
      const int cell = highs[ended];
      while (ended < highs.size() && highs[ended] == cell) ++ended;
      while (begun < lows.size() && lows[begun] < cell) ++begun;
      const int before = static_cast<int>(ended), crossed = static_cast<int>(begun - ended);
      if (before + crossed == n) break;
      const auto uneven = [&](int lower) { return std::abs(2 * lower - n); };
      if (!best || std::pair(crossed, uneven(before)) <
                       std::pair(best->crossed, uneven(best->line.before))) {
        best = {{along, cell, before}, crossed};
      }
    }
  }
  return best;
}

class Cutter {
 public:
  Cutter(int dim, const loadbalance::Partitioner& partitioner)
      : dim_(dim), partitioner_(partitioner) {}

  // Returns the number of the first plane.
  std::uint32_t cut(std::span<Place> places, int first, int tiles) {
    if (tiles == 1 || places.empty()) return leaf(first);
    geometry::Box3d box;
    for (const Place& place : places) box.include(place.at);
    const PlaneGrid grid(box, dim_, tiles);
    if (grid.is_point()) return leaf(first);
    const loadbalance::Costs costs = count(grid, places);
    std::vector<Owned> regions = partitioner_.partition(costs, costs.frame, tiles).regions;
    std::erase_if(regions, [](const Owned& region) { return region.rect.empty(); });
    const std::vector<Rect> owned = owners(regions, tiles);
    const auto best = best_line(owned);
    if (!best || best->crossed > 0)
      return owned.size() < 2 ? leaf(first) : take(grid, regions, first);
    const Line& line = best->line;
    const int axis = grid.axes[line.along];
    // Owners without a region count for those that there are.
    const double share = double(line.before) / static_cast<double>(owned.size());
    const double at = divide(places, axis, share, grid.border(line.cell - 1, line.along),
                             grid.border(line.cell + 1, line.along));
    const auto middle = std::partition(places.begin(), places.end(),
                                       [&](const Place& place) { return place.at[axis] < at; });
    // Equal coordinates may have left another share there.
    const double below_share = weight_of({places.begin(), middle}) / weight_of(places);
    for (Place& place : places) {
      if (std::abs(place.at[axis] - at) < place.reach) place.weight += kCostOfLayer;
    }
    const int lower = std::clamp(static_cast<int>(std::lround(below_share * tiles)), 1, tiles - 1);
    const std::uint32_t plane = add(at, axis);
    const std::uint32_t below = cut({places.begin(), middle}, first, lower);
    const std::uint32_t above = cut({middle, places.end()}, first + lower, tiles - lower);
    return link(plane, below, above);
  }

  std::vector<TileCut::Plane> take_planes() { return std::move(planes_); }

 private:
  std::uint32_t leaf(int tile) {
    const std::uint32_t plane = add(0, 0);
    planes_[plane].tile = tile;
    return link(plane, plane, plane);
  }
  std::uint32_t add(double at, int axis) {
    planes_.push_back({.at = at, .axis = axis});
    return static_cast<std::uint32_t>(planes_.size()) - 1;
  }
  std::uint32_t link(std::uint32_t plane, std::uint32_t below, std::uint32_t above) {
    planes_[plane].next[0] = below;
    planes_[plane].next[1] = above;
    return plane;
  }

  // The box of each owner's regions, of those that have any.
  static std::vector<Rect> owners(std::span<const Owned> regions, int tiles) {
    std::vector<std::optional<Rect>> boxes(static_cast<std::size_t>(tiles));
    for (const Owned& region : regions) {
      std::optional<Rect>& box = boxes[static_cast<std::size_t>(region.owner)];
      const Rect& rect = region.rect;
      box = !box ? rect
                 : Rect{std::min(box->x0, rect.x0), std::min(box->y0, rect.y0),
                        std::max(box->x1, rect.x1), std::max(box->y1, rect.y1)};
    }
    std::vector<Rect> result;
    for (const auto& box : boxes) {
      if (box) result.push_back(*box);
    }
    return result;
  }

  static double weight_of(std::span<const Place> places) {
    double sum = 0;
    for (const Place& place : places) sum += place.weight;
    return sum;
  }

  // The number of the place before which, were they sorted by a coordinate, the weights add up to
  // `wanted`. Reorders the places so that none after it has a lower one. O(n), expected.
  static std::size_t select(std::span<Place> places, int axis, double wanted) {
    const auto before = [axis](const Place& a, const Place& b) { return a.at[axis] < b.at[axis]; };
    std::size_t first = 0, last = places.size();
    while (last - first > 1) {
      const std::size_t middle = first + (last - first) / 2;
      const auto some = places.subspan(first, last - first);
      std::nth_element(some.begin(), some.begin() + static_cast<std::ptrdiff_t>(middle - first),
                       some.end(), before);
      const double weight = weight_of(places.subspan(first, middle - first));
      if (weight <= wanted) {
        wanted -= weight;
        first = middle;
      } else {
        last = middle;
      }
    }
    return first;
  }

  // The coordinate within [low, high] that leaves about that share of the weights below it.
  // Reorders the places.
  static double divide(std::span<Place> places, int axis, double share, double low, double high) {
    const double wanted = std::round(share * weight_of(places));  // weights are whole numbers
    const std::size_t nth = select(places, axis, wanted);
    const double at = places[nth].at[axis];
    // Places with this very coordinate lie all below or all above.
    double fewer = 0, equal = 0, next = at, least = at;
    for (const Place& place : places) {
      const double x = place.at[axis];
      least = std::min(least, x);
      if (x < at) fewer += place.weight;
      if (x == at) equal += place.weight;
      if (x > at && (next == at || x < next)) next = x;
    }
    const bool goes_below = fewer + equal - wanted < wanted - fewer || fewer == 0;
    const double wished = goes_below && next > at ? next : at;
    const double allowed = std::clamp(wished, low, high);
    return allowed > least ? allowed : wished;
  }

  // Regions as they are.
  std::uint32_t take(const PlaneGrid& grid, std::span<const Owned> regions, int first) {
    const int owner = regions.front().owner;
    if (std::ranges::all_of(regions, [&](const Owned& each) { return each.owner == owner; })) {
      return leaf(first + owner);
    }
    std::vector<Rect> rects;
    for (const Owned& region : regions) rects.push_back(region.rect);
    const Line line = best_line(rects)->line;
    std::array<std::vector<Owned>, 2> sides;
    for (const Owned& region : regions) {
      Owned lower = region, upper = region;
      (line.along == 0 ? lower.rect.x1 : lower.rect.y1) =
          std::min(high_of(region.rect, line.along), line.cell);
      (line.along == 0 ? upper.rect.x0 : upper.rect.y0) =
          std::max(low_of(region.rect, line.along), line.cell);
      if (!lower.rect.empty()) sides[0].push_back(lower);
      if (!upper.rect.empty()) sides[1].push_back(upper);
    }
    const std::uint32_t plane = add(grid.border(line.cell, line.along), grid.axes[line.along]);
    const std::uint32_t below = take(grid, sides[0], first);
    const std::uint32_t above = take(grid, sides[1], first);
    return link(plane, below, above);
  }

  int dim_;
  const loadbalance::Partitioner& partitioner_;
  std::vector<TileCut::Plane> planes_;
};

}  // namespace

TileCut cut_places(std::span<const glm::dvec3> places, int dim, int tiles,
                   const loadbalance::Partitioner& partitioner, double points_per_place) {
  std::vector<Place> weighted;
  weighted.reserve(places.size());
  for (const glm::dvec3& place : places) {
    weighted.push_back({dim == 2 ? glm::dvec3(place.x, place.y, 0) : place});
  }
  // The first of the cuts has none before it.
  if (points_per_place > 0 && tiles > 2) find_reaches(weighted, dim, points_per_place);
  Cutter cutter(dim, partitioner);
  cutter.cut(weighted, 0, tiles);
  return TileCut(cutter.take_planes());
}

}  // namespace delray::delaunay
