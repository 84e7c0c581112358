// Points with rows as bytes of messages and scratch files, sorted by tiles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <span>
#include <vector>

#include "comm/collectives.h"
#include "delaunay/tiles.h"

namespace delray::delaunay {

// x, y, z where it is needed, row.
struct RecordFormat {
  bool with_z = true;

  constexpr std::size_t bytes() const { return with_z ? sizeof(RowPoint) : 3 * sizeof(double); }
  void write(std::byte* to, const glm::dvec3& place, std::uint64_t row) const {
    std::memcpy(to, &place, bytes() - sizeof row);
    std::memcpy(to + bytes() - sizeof row, &row, sizeof row);
  }
  RowPoint read(const std::byte* from) const {
    RowPoint point{glm::dvec3(0), 0};
    std::memcpy(&point.position, from, bytes() - sizeof point.row);
    std::memcpy(&point.row, from + bytes() - sizeof point.row, sizeof point.row);
    return point;
  }
};

// Some points of one tile, one after the other by ascending rows.
struct TileRecords {
  std::size_t tile = 0;
  std::uint64_t count = 0;
  const std::byte* records = nullptr;
};

// A run of points by ascending rows: point i lies at positions[i] and has row first_row + i.
struct PointRun {
  std::span<const glm::dvec3> positions;
  std::uint64_t first_row = 0;
};

// A message for each rank that some of the points go to, with its tiles' records. `tile_of` has
// the tile of each point of all runs.
std::vector<comm::Parcel> pack_by_tile(std::span<const PointRun> runs,
                                       std::span<const std::int32_t> tile_of, RecordFormat format,
                                       int tiles, int ranks);
std::vector<comm::Parcel> pack_by_tile(std::span<const RowPoint> points,
                                       std::span<const std::int32_t> tile_of, int tiles, int ranks);

// The tiles of a message that pack_by_tile() made.
std::vector<TileRecords> tiles_of(const comm::Buffer& message, RecordFormat format);

}  // namespace delray::delaunay
