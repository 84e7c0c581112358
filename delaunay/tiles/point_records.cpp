// Counts points by tiles and scatters them to where each tile's records go.
#include "delaunay/tiles/point_records.h"

#include "delaunay/tiles/tile_cut.h"

namespace delray::delaunay {
namespace {

constexpr std::size_t kHead = 2 * sizeof(std::uint64_t);  // of a tile: its number, how many points

// Calls each_point(put) once messages are there: put(tile) returns where the tile's next record
// goes.
template <class EachPoint>
std::vector<comm::Parcel> pack(std::span<const std::int32_t> tile_of, std::size_t record, int tiles,
                               int ranks, const EachPoint& each_point) {
  std::vector<std::uint64_t> counts(static_cast<std::size_t>(tiles));
  for (const std::int32_t tile : tile_of) ++counts[static_cast<std::size_t>(tile)];
  const auto bytes = [&](std::size_t tile) {
    return counts[tile] == 0 ? 0 : kHead + counts[tile] * record;
  };
  std::vector<comm::Parcel> parcels;
  std::vector<std::byte*> next(counts.size());
  for (int rank = 0; rank < ranks; ++rank) {
    const auto first = static_cast<std::size_t>(first_tile(rank, ranks, tiles));
    const auto last = static_cast<std::size_t>(first_tile(rank + 1, ranks, tiles));
    std::size_t sum = 0;
    for (std::size_t tile = first; tile < last; ++tile) sum += bytes(tile);
    if (sum == 0) continue;
    parcels.push_back({rank, comm::Buffer(sum)});
    std::byte* at = parcels.back().message.data();
    for (std::size_t tile = first; tile < last; ++tile) {
      if (counts[tile] == 0) continue;
      const std::uint64_t head[2] = {tile, counts[tile]};
      std::memcpy(at, head, kHead);
      next[tile] = at + kHead;
      at += bytes(tile);
    }
  }
  std::size_t i = 0;
  each_point([&] {
    std::byte*& place = next[static_cast<std::size_t>(tile_of[i++])];
    std::byte* const to = place;
    place += record;
    return to;
  });
  return parcels;
}

}  // namespace

std::vector<comm::Parcel> pack_by_tile(std::span<const PointRun> runs,
                                       std::span<const std::int32_t> tile_of, RecordFormat format,
                                       int tiles, int ranks) {
  const auto each_point = [&](auto with_z) {
    return [&](const auto& next) {
      constexpr RecordFormat kFormat{decltype(with_z)::value};
      for (const PointRun& run : runs) {
        for (std::size_t i = 0; i < run.positions.size(); ++i) {
          kFormat.write(next(), run.positions[i], run.first_row + i);
        }
      }
    };
  };
  return format.with_z ? pack(tile_of, format.bytes(), tiles, ranks, each_point(std::true_type()))
                       : pack(tile_of, format.bytes(), tiles, ranks, each_point(std::false_type()));
}

std::vector<comm::Parcel> pack_by_tile(std::span<const RowPoint> points,
                                       std::span<const std::int32_t> tile_of, int tiles,
                                       int ranks) {
  return pack(tile_of, sizeof(RowPoint), tiles, ranks, [&](const auto& next) {
    for (const RowPoint& point : points) std::memcpy(next(), &point, sizeof point);
  });
}

std::vector<TileRecords> tiles_of(const comm::Buffer& message, RecordFormat format) {
  std::vector<TileRecords> all;
  for (std::size_t at = 0; at < message.size();) {
    std::uint64_t head[2];
    std::memcpy(head, message.data() + at, kHead);
    all.push_back({head[0], head[1], message.data() + at + kHead});
    at += kHead + head[1] * format.bytes();
  }
  return all;
}

}  // namespace delray::delaunay
