// Where the points of a rank's tiles wait for their turn: in memory, or in a folder on disk.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <utility>
#include <vector>

#include "comm/buffer.h"
#include "delaunay/tiles.h"
#include "delaunay/tiles/point_records.h"
#include "delaunay/tiles/tile_boxes.h"

namespace delray::delaunay {

class TileStore {
 public:
  virtual ~TileStore() = default;
  // Takes a message of pack_by_tile() in. Rows of different messages do not interleave: all those
  // of one come before all those of another. Any thread.
  virtual void add(comm::Buffer&& message) = 0;
  // The points of a tile by ascending rows. Any thread.
  virtual std::vector<RowPoint> read(std::size_t tile) = 0;
  // The tile's points are wanted no more.
  virtual void drop(std::size_t tile) = 0;
  virtual std::uint64_t bytes_on_disk() const { return 0; }
};

// Keeps messages as they are.
class MemoryStore final : public TileStore {
 public:
  MemoryStore(RecordFormat format, std::size_t first_tile, std::size_t tiles)
      : format_(format), first_(first_tile), runs_(tiles) {}
  void add(comm::Buffer&& message) override;
  std::vector<RowPoint> read(std::size_t tile) override;
  void drop(std::size_t) override {}

 private:
  RecordFormat format_;
  std::size_t first_;
  std::mutex mutex_;
  std::vector<comm::Buffer> messages_;
  std::vector<std::vector<TileRecords>> runs_;  // of each tile
};

// A file for each tile, of blocks with check sums.
class ScratchStore final : public TileStore {
 public:
  ScratchStore(RecordFormat format, std::filesystem::path folder)
      : format_(format), folder_(std::move(folder)) {}
  // Errors: FileError (device).
  void add(comm::Buffer&& message) override;
  // Errors: FileError (device), naming the file, if it is not as it was written.
  std::vector<RowPoint> read(std::size_t tile) override;
  void drop(std::size_t tile) override;
  std::uint64_t bytes_on_disk() const override { return bytes_; }

  // How many points each file must have for read() to be content.
  void expect(std::vector<std::uint64_t> points, std::size_t first_tile);

 private:
  std::filesystem::path path(std::size_t tile) const;

  RecordFormat format_;
  std::filesystem::path folder_;
  std::atomic<std::uint64_t> bytes_{0};
  std::vector<std::uint64_t> expected_;
  std::size_t first_ = 0;
};

}  // namespace delray::delaunay
