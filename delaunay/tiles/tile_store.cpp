// Points of tiles in memory and on disk. A tile's file is a sequence of blocks in the order of
// their arrival; their first rows put them in order.
#include "delaunay/tiles/tile_store.h"

#include <algorithm>
#include <system_error>
#include <type_traits>
#include <utility>

#include "delaunay/mesh/array.h"
#include "delaunay/tiles/scratch_file.h"

namespace delray::delaunay {
namespace {

struct BlockHead {
  static constexpr std::uint64_t kMark = 0x31656c6974796c64;
  std::uint64_t mark = kMark, tile = 0, count = 0, first_row = 0, check = 0;
  std::uint64_t head_check = 0;  // of the numbers before

  std::uint64_t check_of_head() const {
    return check_sum(std::as_bytes(std::span(this, 1)).first(sizeof *this - sizeof head_check));
  }
};

std::vector<RowPoint> room_for(std::size_t points) {
  std::vector<RowPoint> room;
  room.reserve(points);
  prefer_huge_pages(room.data(), points * sizeof(RowPoint));
  return room;
}

void append_records(const std::byte* from, std::uint64_t count, RecordFormat format,
                    std::vector<RowPoint>& to) {
  const auto append = [&](auto with_z) {
    constexpr RecordFormat kFormat{decltype(with_z)::value};
    for (std::uint64_t i = 0; i < count; ++i)
      to.push_back(kFormat.read(from + i * kFormat.bytes()));
  };
  if (format.with_z) {
    append(std::true_type());
  } else {
    append(std::false_type());
  }
}

}  // namespace

void MemoryStore::add(comm::Buffer&& message) {
  const std::lock_guard lock(mutex_);
  messages_.push_back(std::move(message));
  for (const TileRecords& run : tiles_of(messages_.back(), format_)) {
    runs_[run.tile - first_].push_back(run);
  }
}

std::vector<RowPoint> MemoryStore::read(std::size_t tile) {
  std::vector<TileRecords> runs = std::move(runs_[tile - first_]);
  std::ranges::sort(runs, {},
                    [&](const TileRecords& run) { return format_.read(run.records).row; });
  std::size_t size = 0;
  for (const TileRecords& run : runs) size += run.count;
  std::vector<RowPoint> points = room_for(size);
  for (const TileRecords& run : runs) append_records(run.records, run.count, format_, points);
  return points;
}

std::filesystem::path ScratchStore::path(std::size_t tile) const {
  return folder_ / ("tile-" + std::to_string(tile));
}

void ScratchStore::expect(std::vector<std::uint64_t> points, std::size_t first_tile) {
  expected_ = std::move(points);
  first_ = first_tile;
}

void ScratchStore::add(comm::Buffer&& message) {
  const comm::Buffer own = std::move(message);
  for (const TileRecords& run : tiles_of(own, format_)) {
    const std::span records(run.records, run.count * format_.bytes());
    BlockHead head;
    head.tile = run.tile;
    head.count = run.count;
    head.first_row = format_.read(run.records).row;
    head.check = check_sum(records);
    head.head_check = head.check_of_head();
    // By one call, so that blocks of several threads do not mix.
    ScratchFile(path(run.tile), ScratchFile::Mode::append)
        .write(std::as_bytes(std::span(&head, 1)), records);
    bytes_ += sizeof head + records.size();
  }
}

std::vector<RowPoint> ScratchStore::read(std::size_t tile) {
  const std::uint64_t wanted = expected_.at(tile - first_);
  if (wanted == 0) return {};
  const ScratchFile file(path(tile), ScratchFile::Mode::read);
  const auto damaged = [&] { file.fail("is not as it was written: start again without --resume"); };
  struct Block {
    BlockHead head;
    std::uint64_t offset = 0;
  };
  std::vector<Block> blocks;
  std::uint64_t size = 0;
  for (std::uint64_t at = 0; size < wanted;) {
    Block block;
    const BlockHead& head = block.head;
    if (!file.read(at, std::as_writable_bytes(std::span(&block.head, 1))) ||
        head.mark != BlockHead::kMark || head.head_check != head.check_of_head() ||
        head.tile != tile || head.count > wanted - size) {
      damaged();
    }
    block.offset = at + sizeof head;
    size += head.count;
    at = block.offset + head.count * format_.bytes();
    blocks.push_back(block);
  }
  std::ranges::sort(blocks, {}, [](const Block& block) { return block.head.first_row; });
  std::vector<RowPoint> points = room_for(size);
  std::vector<std::byte> bytes;
  for (const Block& block : blocks) {
    bytes.resize(block.head.count * format_.bytes());
    if (!file.read(block.offset, bytes) || check_sum(bytes) != block.head.check) damaged();
    append_records(bytes.data(), block.head.count, format_, points);
  }
  return points;
}

void ScratchStore::drop(std::size_t tile) {
  std::error_code ignored;
  std::filesystem::remove(path(tile), ignored);
}

}  // namespace delray::delaunay
