// The cells of a raster in blocks, of which some are in memory and the others in a scratch file.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <unordered_map>
#include <vector>

#include "files/unnamed_file.h"

namespace delray::delaunay::internal {

class BlockStore {
 public:
  // A block in memory. Any thread may set cells to values that all agree on.
  struct Block {
    explicit Block(std::size_t cells);
    void set(std::size_t cell, float value) {
      std::atomic_ref(cells[cell]).store(value, std::memory_order_relaxed);
    }
    std::vector<float> cells;  // NaN: none yet
    std::atomic<int> pins{0};
  };

  // Keeps a block in memory while it lives.
  class Pin {
   public:
    Pin() = default;
    explicit Pin(Block* block) : block_(block) {}
    Pin(Pin&& other) noexcept : block_(other.block_) { other.block_ = nullptr; }
    Pin& operator=(Pin&& other) noexcept {
      std::swap(block_, other.block_);
      return *this;
    }
    // What was set before it is there for whoever writes the block out.
    ~Pin() {
      if (block_) block_->pins.fetch_sub(1, std::memory_order_release);
    }
    Block* operator->() const { return block_; }

   private:
    Block* block_ = nullptr;
  };

  // Blocks of so many cells; `most` of them, at least one, are in memory, but for those that are
  // pinned at a time.
  BlockStore(std::uint64_t blocks, std::size_t cells, std::size_t most,
             std::filesystem::path scratch);
  BlockStore(const BlockStore&) = delete;
  BlockStore& operator=(const BlockStore&) = delete;

  // Any thread. Throws FileError (device). REQUIRES: block < blocks.
  Pin pin(std::uint64_t block);
  // Whether a block was ever pinned.
  bool has(std::uint64_t block) const { return touched_[block]; }

 private:
  using Order = std::list<std::uint64_t>;
  struct Entry {
    std::unique_ptr<Block> block;
    Order::iterator place;
  };
  void make_room();
  void transfer(std::uint64_t block, std::vector<float>& cells, bool out);

  std::size_t cells_, most_;
  std::filesystem::path scratch_;
  std::optional<files::UnnamedFile> file_;
  std::mutex mutex_;
  std::unordered_map<std::uint64_t, Entry> blocks_;
  Order order_;  // of those in memory, the latest first
  std::vector<bool> touched_;
};

}  // namespace delray::delaunay::internal
