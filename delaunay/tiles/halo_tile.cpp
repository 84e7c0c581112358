// The rule of the exchange of halos, for one tile (Caraffa et al., Tile & Merge, 2019; Funke and
// Sanders, Parallel d-D Delaunay triangulations in shared and distributed memory, 2017).
#include "delaunay/tiles/halo_tile.h"

#include <algorithm>
#include <array>
#include <limits>
#include <mutex>
#include <numeric>
#include <stdexcept>
#include <string>

#include "delaunay/mesh/facets.h"
#include "delaunay/tiles/circumball.h"
#include "parallel/parallel_for.h"

namespace delray::delaunay {
namespace {

constexpr std::size_t kSimplicesGrain = 4096;  // simplices: some tenths of a millisecond

template <class Point>
std::vector<geometry::Box<Point>> boxes_of(std::span<const TileSummary> summaries) {
  std::vector<geometry::Box<Point>> boxes;
  for (const TileSummary& each : summaries) {
    boxes.push_back({Point(each.box.low), Point(each.box.high)});
  }
  return boxes;
}

// Whether a comes before b along an axis; ties by the other coordinates, then the lower row, so
// that of equal points the one that represents them is first.
bool comes_before(const RowPoint& a, const RowPoint& b, int axis, int dim, bool descending) {
  for (int i = 0; i < dim; ++i) {
    const int k = (axis + i) % dim;
    if (a.position[k] != b.position[k]) {
      return (a.position[k] < b.position[k]) != (descending && i == 0);
    }
  }
  return a.row < b.row;
}

// Which boxes a simplex's ball or the half-space beyond a facet touches.
template <int D>
struct BallTouches {
  using Box = geometry::Box<glm::vec<D, double>>;
  Circumball<D> ball;
  bool operator()(const Box& box) const { return ball.touches(box); }
  bool is_within(const Box& box) const { return ball.is_within(box); }
};
template <int D>
struct FacetReaches {
  using Box = geometry::Box<glm::vec<D, double>>;
  std::array<glm::vec<D, double>, D> facet;
  bool operator()(const Box& box) const { return reaches_beyond(facet, box); }
  bool is_within(const Box&) const { return false; }
};

}  // namespace

TileBoxes::TileBoxes(std::span<const TileSummary> summaries)
    : plane(boxes_of<glm::dvec2>(summaries)), space(boxes_of<glm::dvec3>(summaries)) {}

HaloTile::HaloTile(int tile, int dim, std::vector<RowPoint> own)
    : tile_(tile), dim_(dim), known_(std::move(own)), walls_(dim) {
  if (known_.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw std::invalid_argument("tile " + std::to_string(tile) + " has " +
                                std::to_string(known_.size()) +
                                " points, more than a tile can have");
  }
  own_ = static_cast<std::uint32_t>(known_.size());
  statistics_.points = own_;
  for (const RowPoint& point : known_) {
    box_.include(dim == 2 ? glm::dvec3(glm::dvec2(point.position), 0) : point.position);
  }
}

TileSummary HaloTile::summary() const {
  TileSummary summary;
  summary.box = box_;
  if (own_ == 0) return summary;
  for (int axis = 0; axis < dim_; ++axis) {
    for (const bool descending : {false, true}) {
      summary.extremes[summary.extreme_count++] =
          *std::ranges::min_element(known_, [&](const RowPoint& a, const RowPoint& b) {
            return comes_before(a, b, axis, dim_, descending);
          });
    }
  }
  return summary;
}

void HaloTile::add_halo(std::span<const RowPoint> points) {
  for (const RowPoint& point : points) {
    if (!halo_rows_.insert(point.row).second) continue;
    known_.push_back(point);
    ++statistics_.halo;
    changed_ = true;
  }
}

void HaloTile::triangulate(const Options& options) {
  if (!changed_) return;
  changed_ = false;
  if (own_ == 0) return;
  const PointView<double> view{reinterpret_cast<const std::byte*>(known_.data()), known_.size(),
                               sizeof(RowPoint)};
  triangulation_ = delaunay::triangulate(view, options).triangulation;
  statistics_.simplices += triangulation_.size();
  mates_ = match_facets(dim_, triangulation_.vertices, known_.size()).mates;
  outside_ = walls_.find_outside(triangulation_, mates_);
}

template <int D>
std::vector<TileMessage> HaloTile::messages_of_simplices(
    const BoxTree<glm::vec<D, double>>& boxes) {
  using Point = glm::vec<D, double>;
  using Box = geometry::Box<Point>;
  std::vector<TileMessage> all;
  std::mutex mutex;
  // What lies in the tile's own box touches no other box, unless boxes overlap.
  Box own_box{Point(box_.low), Point(box_.high)};
  bool overlaps = false;
  boxes.find(
      [&](const Box& box) {
        return glm::all(glm::lessThanEqual(own_box.low, box.high)) &&
               glm::all(glm::lessThanEqual(box.low, own_box.high));
      },
      [&](std::uint32_t tile) { overlaps |= static_cast<int>(tile) != tile_; });
  if (overlaps) own_box = {};
  // For simplices or facets of so many corners: marks those that are no own ones or touch other
  // tiles, and tells these of their own vertices.
  const auto scan = [&]<std::size_t Corners>(
                        std::span<const std::uint32_t> vertices, const std::uint8_t* are_outside,
                        std::vector<std::uint8_t>& concerns, const auto& touches_of) {
    concerns.assign(vertices.size() / Corners, 1);
    parallel::parallel_blocks(
        0, concerns.size(), kSimplicesGrain, [&](std::size_t first, std::size_t last) {
          std::vector<TileMessage> messages;
          for (std::size_t s = first; s < last; ++s) {
            if (are_outside != nullptr && are_outside[s] == 0) continue;
            const auto rows = vertices.subspan(s * Corners, Corners);
            if (std::ranges::none_of(rows, [&](std::uint32_t row) { return is_own(row); }))
              continue;
            std::array<Point, Corners> corners;
            for (std::size_t i = 0; i < Corners; ++i) corners[i] = Point(known_[rows[i]].position);
            concerns[s] = 0;
            boxes.find(touches_of(corners), [&](std::uint32_t tile) {
              if (static_cast<int>(tile) == tile_) return;
              concerns[s] = 1;
              for (const std::uint32_t row : rows) {
                if (is_own(row)) messages.push_back({tile, row});
              }
            });
          }
          std::ranges::sort(messages);
          messages.erase(std::unique(messages.begin(), messages.end()), messages.end());
          const std::lock_guard lock(mutex);
          all.insert(all.end(), messages.begin(), messages.end());
        });
  };
  scan.template operator()<D + 1>(triangulation_.vertices, outside_.simplices.data(),
                                  simplex_concerns_, [](const auto& corners) {
                                    return [ball = Circumball<D>(corners)](const Box& box) {
                                      return ball.touches(box);
                                    };
                                  });
  scan.template operator()<D>(outside_.hull, nullptr, facet_concerns_, [](const auto& corners) {
    return [corners](const Box& box) { return reaches_beyond(corners, box); };
  });
  return all;
}

std::vector<std::uint32_t> HaloTile::distinct_own() const {
  std::vector<std::uint32_t> rows(own_);
  std::iota(rows.begin(), rows.end(), 0U);
  std::ranges::sort(rows, [&](std::uint32_t a, std::uint32_t b) {
    return comes_before(known_[a], known_[b], 0, dim_, /*descending=*/false);
  });
  const auto equal = [&](std::uint32_t a, std::uint32_t b) {
    const glm::dvec3 &p = known_[a].position, &q = known_[b].position;
    return p.x == q.x && p.y == q.y && (dim_ == 2 || p.z == q.z);
  };
  rows.erase(std::unique(rows.begin(), rows.end(), equal), rows.end());
  return rows;
}

std::vector<TileMessage> HaloTile::find_messages(const TileBoxes& boxes,
                                                 std::span<const TileSummary> tiles) {
  std::vector<TileMessage> messages;
  if (own_ > 0 && triangulation_.size() == 0 && !settled_) {
    // All in one line or plane: anything may be a neighbour.
    const std::vector<std::uint32_t> distinct = distinct_own();
    for (std::size_t tile = 0; tile < tiles.size(); ++tile) {
      if (static_cast<int>(tile) == tile_ || tiles[tile].box.empty()) continue;
      for (const std::uint32_t i : distinct) messages.push_back({tile, i});
    }
  } else if (own_ > 0) {
    messages =
        dim_ == 2 ? messages_of_simplices<2>(boxes.plane) : messages_of_simplices<3>(boxes.space);
  }
  std::erase_if(messages, [&](const TileMessage& message) {
    return !told_.insert(message.tile << 32 | message.point).second;
  });
  statistics_.sent += messages.size();
  std::ranges::sort(messages);
  return messages;
}

bool HaloTile::lowest_is_own(std::span<const std::uint32_t> rows) const {
  return is_own(
      *std::ranges::min_element(rows, {}, [&](std::uint32_t row) { return known_[row].row; }));
}

void HaloTile::give(std::span<const std::uint32_t> rows, TiledTriangulation& result) {
  for (const std::uint32_t row : rows) result.vertices.push_back(known_[row].row);
  ++statistics_.own_simplices;
}

void HaloTile::give_settled(TiledTriangulation& result) {
  const auto corners = static_cast<std::size_t>(dim_) + 1;
  const auto settled = static_cast<std::size_t>(std::ranges::count(simplex_concerns_, 0));
  statistics_.own_simplices += settled;
  std::size_t to = result.vertices.size();
  result.vertices.resize(to + settled * corners);
  for (std::size_t s = 0; s < triangulation_.size(); ++s) {
    if (simplex_concerns_[s] != 0) continue;
    for (std::size_t corner = s * corners; corner < (s + 1) * corners; ++corner) {
      result.vertices[to++] = known_[triangulation_.vertices[corner]].row;
    }
  }
}

void HaloTile::settle(TiledTriangulation& result) {
  const auto corners = static_cast<std::size_t>(dim_) + 1, sides = corners - 1;
  if (settled_ || std::ranges::count(simplex_concerns_, 0) == 0) return;
  settled_ = true;
  result.distinct += triangulation_.distinct - statistics_.halo;

  std::vector<std::uint8_t> keep(known_.size());
  std::ranges::fill(keep.begin() + own_, keep.end(), std::uint8_t{1});
  const std::span<const std::uint32_t> vertices = triangulation_.vertices;
  std::array<std::uint32_t, 3> facet{};
  for (std::size_t s = 0; s < triangulation_.size(); ++s) {
    if (simplex_concerns_[s] == 0) continue;
    for (std::size_t corner = s * corners; corner < (s + 1) * corners; ++corner) {
      keep[vertices[corner]] = 1;
      const std::uint32_t mate = mates_[corner];
      if (mate == FacetMates::kNone || simplex_concerns_[mate / corners] != 0) continue;
      const auto rows = vertices.subspan(mate / corners * corners, corners);
      const std::span<const int> order = facet_corners(dim_, mate % corners);
      for (std::size_t k = 0; k < sides; ++k) facet[k] = rows[static_cast<std::size_t>(order[k])];
      walls_.add(std::span(facet).first(sides));
    }
  }
  give_settled(result);
  // Without walls the hull lists facets by their simplices; a simplex may have several.
  std::size_t next = 0;
  for (std::size_t corner = 0; corner < mates_.size(); ++corner) {
    if (mates_[corner] != FacetMates::kNone) continue;
    const std::size_t f = next++;
    if (simplex_concerns_[corner / corners] != 0) continue;
    const auto rows = std::span<const std::uint32_t>(outside_.hull).subspan(f * sides, sides);
    if (facet_concerns_[f] == 0) {
      ++result.hull_facets;
    } else {
      walls_.add(rows);
    }
  }
  walls_.mark_vertices(keep);

  std::vector<std::uint32_t> numbers(known_.size());
  std::uint32_t kept = 0, own = 0;
  for (std::uint32_t i = 0; i < known_.size(); ++i) {
    numbers[i] = kept;
    if (keep[i] == 0) continue;
    if (is_own(i)) ++own;
    known_[kept++] = known_[i];
  }
  known_.resize(kept);
  known_.shrink_to_fit();
  walls_.renumber(numbers);
  std::unordered_set<std::uint64_t> told;
  for (const std::uint64_t message : told_) {
    const auto point = static_cast<std::uint32_t>(message);
    if (keep[point] != 0) told.insert(message >> 32 << 32 | numbers[point]);
  }
  told_ = std::move(told);
  own_ = own;
  triangulation_ = {};
  mates_ = {};
  outside_ = {};
  changed_ = true;
}

void HaloTile::collect(const Options& options, TiledTriangulation& result) {
  triangulate(options);
  const auto corners = static_cast<std::size_t>(dim_) + 1, sides = corners - 1;
  for (std::size_t s = 0; s < triangulation_.size(); ++s) {
    if (outside_.simplices[s] == 0) continue;
    const auto rows =
        std::span<const std::uint32_t>(triangulation_.vertices).subspan(s * corners, corners);
    if (lowest_is_own(rows)) give(rows, result);
  }
  for (std::size_t f = 0; f < outside_.hull.size(); f += sides) {
    const auto rows = std::span<const std::uint32_t>(outside_.hull).subspan(f, sides);
    result.hull_facets += lowest_is_own(rows) ? 1 : 0;
  }
  // Points of halos are distinct, and equal to none of the tile's own.
  if (!settled_ && statistics_.points > 0) {
    result.distinct += triangulation_.distinct - statistics_.halo;
  }
  result.tiles.push_back(statistics_);
}

}  // namespace delray::delaunay
