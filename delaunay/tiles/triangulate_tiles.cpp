// Triangulates tiles, and exchanges what they must know of each other until nobody has anything to
// tell: after the first exchange, of extreme points, one more is enough as a rule
// (tiles/halo_tile.h has the rule and its proof).
#include "delaunay/tiles.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <map>
#include <stdexcept>
#include <utility>

#include "comm/agree_on_failure.h"
#include "comm/collectives.h"
#include "delaunay/mesh/arguments.h"
#include "delaunay/tiles/halo_tile.h"
#include "delaunay/tiles/tile_cut.h"
#include "parallel/parallel_for.h"

namespace delray::delaunay {
namespace {

// Points for tiles of one rank, in a message: for each tile its number, how many points, the
// points.
class TilePoints {
 public:
  void add(int tile, const RowPoint& point) { points_[tile].push_back(point); }

  // Of so many points of a tile; nothing is sent for a tile without.
  static std::size_t bytes(std::uint64_t points) {
    return points == 0 ? 0 : kHead + points * sizeof(RowPoint);
  }
  // Returns where the points go.
  static std::byte* put_head(std::byte* at, int tile, std::uint64_t points) {
    const std::uint64_t head[2] = {static_cast<std::uint64_t>(tile), points};
    std::memcpy(at, head, kHead);
    return at + kHead;
  }

  comm::Buffer pack() const {
    std::size_t size = 0;
    for (const auto& [tile, points] : points_) size += bytes(points.size());
    comm::Buffer buffer(size);
    std::byte* at = buffer.data();
    for (const auto& [tile, points] : points_) {
      at = put_head(at, tile, points.size());
      std::memcpy(at, points.data(), points.size() * sizeof(RowPoint));
      at += points.size() * sizeof(RowPoint);
    }
    return buffer;
  }

  // Calls take(tile, points) for each tile. REQUIRES: pack() or pack_by_tile() made it.
  template <class Take>
  static void unpack(const comm::Buffer& buffer, const Take& take) {
    for (std::size_t at = 0; at < buffer.size();) {
      std::uint64_t head[2];
      std::memcpy(head, buffer.data() + at, kHead);
      const auto* points = reinterpret_cast<const RowPoint*>(buffer.data() + at + kHead);
      take(static_cast<int>(head[0]), std::span(points, head[1]));
      at += bytes(head[1]);
    }
  }

 private:
  static constexpr std::size_t kHead = 2 * sizeof(std::uint64_t);
  std::map<int, std::vector<RowPoint>> points_;
};

// The tiles of a rank, and the exchanges between those of all ranks.
class RankTiles {
 public:
  RankTiles(comm::Communicator& communicator, const TileOptions& options, int tiles)
      : communicator_(communicator), options_(options), tiles_(tiles) {}

  void distribute(std::span<const RowPoint> points) {
    const auto& partitioner = *loadbalance::find_partitioner(options_.partition);
    const TileCut cut(communicator_, points, options_.triangulate.dim, tiles_, partitioner);
    const int first = first_tile(communicator_.rank(), communicator_.size(), tiles_);
    const int last = first_tile(communicator_.rank() + 1, communicator_.size(), tiles_);
    std::vector<std::vector<RowPoint>> own(static_cast<std::size_t>(last - first));
    for (const comm::Parcel& parcel : comm::exchange(communicator_, pack_by_tile(points, cut))) {
      TilePoints::unpack(parcel.message, [&](int tile, std::span<const RowPoint> received) {
        auto& all = own[tile - first];
        all.insert(all.end(), received.begin(), received.end());
      });
    }
    for (auto& each : own) {
      if (!std::ranges::is_sorted(each, {}, &RowPoint::row)) {
        std::ranges::sort(each, {}, &RowPoint::row);
      }
    }
    comm::all_or_none(communicator_, comm::Phase::redistribute, [&] {
      for (std::size_t i = 0; i < own.size(); ++i) {
        mine_.emplace_back(first + static_cast<int>(i), options_.triangulate.dim,
                           std::move(own[i]));
      }
    });
    first_ = first;
  }

  // Tells all tiles of the boxes and extreme points of all others.
  void share_summaries() {
    std::vector<TileSummary> mine;
    for (const HaloTile& tile : mine_) mine.push_back(tile.summary());
    for (const comm::Buffer& each :
         comm::all_gather(communicator_, comm::Buffer::of(std::span<const TileSummary>(mine)))) {
      const auto summaries = each.as<TileSummary>();
      summaries_.insert(summaries_.end(), summaries.begin(), summaries.end());
    }
    for (std::size_t i = 0; i < mine_.size(); ++i) {
      for (std::size_t tile = 0; tile < summaries_.size(); ++tile) {
        if (tile == first_ + i) continue;
        mine_[i].add_halo({summaries_[tile].extremes, summaries_[tile].extreme_count});
      }
    }
  }

  // Gives away what is settled. Returns how many exchanges of halos it took.
  int complete_stars(TiledTriangulation& result) {
    const TileBoxes boxes(summaries_);
    for (int round = 0;; ++round) {
      std::uint64_t told = 0;
      std::map<int, TilePoints> parcels;
      comm::all_or_none(communicator_, comm::Phase::other, [&] {
        for (HaloTile& tile : mine_) {
          tile.triangulate(options_.triangulate);
          for (const TileMessage& message : tile.find_messages(boxes, summaries_)) {
            const int to = static_cast<int>(message.tile);
            parcels[rank_of(to)].add(to, tile.point(message.point));
            ++told;
          }
          tile.settle(result);
        }
      });
      if (comm::all_reduce_value(communicator_, told, std::plus<>()) == 0) return round;
      exchange(parcels, [&](int tile, std::span<const RowPoint> received) {
        mine_[static_cast<std::size_t>(tile) - first_].add_halo(received);
      });
    }
  }

  void collect(TiledTriangulation& result) {
    comm::all_or_none(communicator_, comm::Phase::other, [&] {
      for (HaloTile& tile : mine_) tile.collect(options_.triangulate, result);
    });
  }

 private:
  // A message for each rank that some of the points go to, sorted by tiles.
  std::vector<comm::Parcel> pack_by_tile(std::span<const RowPoint> points,
                                         const TileCut& cut) const {
    std::vector<std::int32_t> tile_of(points.size());
    constexpr std::size_t kGrain = 16384;  // points: some tenths of a millisecond
    parallel::parallel_for(0, points.size(), kGrain,
                           [&](std::size_t i) { tile_of[i] = cut.tile_of(points[i].position); });
    std::vector<std::uint64_t> counts(static_cast<std::size_t>(tiles_));
    for (const std::int32_t tile : tile_of) ++counts[static_cast<std::size_t>(tile)];

    std::vector<comm::Parcel> parcels;
    std::vector<std::byte*> next(counts.size());
    for (int rank = 0; rank < communicator_.size(); ++rank) {
      const int first = first_tile(rank, communicator_.size(), tiles_);
      const int last = first_tile(rank + 1, communicator_.size(), tiles_);
      std::size_t bytes = 0;
      for (int tile = first; tile < last; ++tile) bytes += TilePoints::bytes(counts[tile]);
      if (bytes == 0) continue;
      parcels.push_back({rank, comm::Buffer(bytes)});
      std::byte* at = parcels.back().message.data();
      for (int tile = first; tile < last; ++tile) {
        if (counts[tile] == 0) continue;
        next[tile] = TilePoints::put_head(at, tile, counts[tile]);
        at += TilePoints::bytes(counts[tile]);
      }
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
      std::byte*& to = next[static_cast<std::size_t>(tile_of[i])];
      std::memcpy(to, &points[i], sizeof points[i]);
      to += sizeof points[i];
    }
    return parcels;
  }

  int rank_of(int tile) const { return rank_of_tile(tile, communicator_.size(), tiles_); }

  template <class Take>
  void exchange(const std::map<int, TilePoints>& points, const Take& take) {
    std::vector<comm::Parcel> parcels;
    for (const auto& [rank, each] : points) parcels.push_back({rank, each.pack()});
    for (const comm::Parcel& parcel : comm::exchange(communicator_, std::move(parcels))) {
      TilePoints::unpack(parcel.message, take);
    }
  }

  comm::Communicator& communicator_;
  const TileOptions& options_;
  int tiles_;
  std::size_t first_ = 0;
  std::vector<HaloTile> mine_;
  std::vector<TileSummary> summaries_;
};

void check(std::span<const RowPoint> points, const TileOptions& options) {
  internal::check_dim(options.triangulate.dim);
  if (loadbalance::find_partitioner(options.partition) == nullptr) {
    throw std::invalid_argument("'" + options.partition + "' is no partition");
  }
  if (options.tiles < 0) {
    throw std::invalid_argument("there cannot be " + std::to_string(options.tiles) + " tiles");
  }
  for (const RowPoint& point : points) {
    for (int k = 0; k < options.triangulate.dim; ++k) {
      if (!std::isfinite(point.position[k])) {
        throw std::invalid_argument("row " + std::to_string(point.row) +
                                    " has a coordinate that is not finite");
      }
    }
  }
}

}  // namespace

TiledTriangulation triangulate_tiles(comm::Communicator& communicator,
                                     std::span<const RowPoint> points, const TileOptions& options) {
  comm::all_or_none(communicator, comm::Phase::other, [&] { check(points, options); });
  const int tiles = options.tiles > 0 ? options.tiles : communicator.size();
  RankTiles mine(communicator, options, tiles);
  communicator.mark(comm::Phase::redistribute, 0);
  mine.distribute(points);
  mine.share_summaries();
  TiledTriangulation result;
  result.dim = options.triangulate.dim;
  result.rounds = mine.complete_stars(result);
  mine.collect(result);
  return result;
}

}  // namespace delray::delaunay
