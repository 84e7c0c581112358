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

#include "delaunay/tiles/circumball.h"
#include "delaunay/write_mesh.h"
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

}  // namespace

TileBoxes::TileBoxes(std::span<const TileSummary> summaries)
    : plane(boxes_of<glm::dvec2>(summaries)), space(boxes_of<glm::dvec3>(summaries)) {}

HaloTile::HaloTile(int tile, int dim, std::vector<RowPoint> own)
    : tile_(tile), dim_(dim), known_(std::move(own)) {
  if (known_.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw std::invalid_argument("tile " + std::to_string(tile) + " has " +
                                std::to_string(known_.size()) +
                                " points, more than a tile can have");
  }
  own_ = static_cast<std::uint32_t>(known_.size());
}

TileSummary HaloTile::summary() const {
  TileSummary summary;
  for (const RowPoint& point : known_) {
    glm::dvec3 position = point.position;
    if (dim_ == 2) position.z = 0;
    summary.box.include(position);
  }
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
}

template <int D>
std::vector<TileMessage> HaloTile::messages_of_simplices(
    const BoxTree<glm::vec<D, double>>& boxes) const {
  using Point = glm::vec<D, double>;
  using Box = geometry::Box<Point>;
  std::vector<TileMessage> all;
  std::mutex mutex;
  // For so many corners a simplex or facet: tells all tiles that `shape` touches of its own ones.
  const auto scan = [&]<std::size_t Corners>(std::span<const std::uint32_t> vertices,
                                             const auto& touches_of) {
    parallel::parallel_blocks(
        0, vertices.size() / Corners, kSimplicesGrain, [&](std::size_t first, std::size_t last) {
          std::vector<TileMessage> messages;
          for (std::size_t s = first; s < last; ++s) {
            const auto rows = vertices.subspan(s * Corners, Corners);
            if (std::ranges::none_of(rows, [&](std::uint32_t row) { return is_own(row); }))
              continue;
            std::array<Point, Corners> corners;
            for (std::size_t i = 0; i < Corners; ++i) corners[i] = Point(known_[rows[i]].position);
            boxes.find(touches_of(corners), [&](std::uint32_t tile) {
              if (static_cast<int>(tile) == tile_) return;
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
  scan.template operator()<D + 1>(triangulation_.vertices, [](const auto& corners) {
    return [ball = Circumball<D>(corners)](const Box& box) { return ball.touches(box); };
  });
  scan.template operator()<D>(hull_facets(triangulation_), [](const auto& corners) {
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
  if (own_ > 0 && triangulation_.size() == 0) {
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
  std::ranges::sort(messages);
  return messages;
}

void HaloTile::collect(TiledTriangulation& result) const {
  const auto corners = static_cast<std::size_t>(dim_) + 1;
  const auto lowest_is_own = [&](std::span<const std::uint32_t> rows) {
    return is_own(
        *std::ranges::min_element(rows, {}, [&](std::uint32_t row) { return known_[row].row; }));
  };
  TileStatistics statistics;
  statistics.points = own_;
  statistics.halo = known_.size() - own_;
  statistics.sent = told_.size();
  statistics.simplices = triangulation_.size();
  for (std::size_t s = 0; s < triangulation_.size(); ++s) {
    const auto rows = std::span(triangulation_.vertices).subspan(s * corners, corners);
    if (!lowest_is_own(rows)) continue;
    ++statistics.own_simplices;
    for (const std::uint32_t row : rows) result.vertices.push_back(known_[row].row);
  }
  const std::vector<std::uint32_t> facets = hull_facets(triangulation_);
  for (std::size_t f = 0; f < facets.size(); f += corners - 1) {
    result.hull_facets += lowest_is_own(std::span(facets).subspan(f, corners - 1)) ? 1 : 0;
  }
  // Points of halos are distinct, and equal to none of the tile's own.
  if (own_ > 0) result.distinct += triangulation_.distinct - statistics.halo;
  result.tiles.push_back(statistics);
}

}  // namespace delray::delaunay
