// Least recently used blocks are written to an unnamed file and read back when they are asked for
// again. The file ends with the process, however that ends.
#include "delaunay/raster/block_store.h"

#include <algorithm>
#include <limits>
#include <span>
#include <utility>

namespace delray::delaunay::internal {

BlockStore::Block::Block(std::size_t size) : cells(size, std::numeric_limits<float>::quiet_NaN()) {}

BlockStore::BlockStore(std::uint64_t blocks, std::size_t cells, std::size_t most,
                       std::filesystem::path scratch)
    : cells_(cells),
      most_(std::max<std::size_t>(most, 1)),
      scratch_(std::move(scratch)),
      touched_(blocks) {}

BlockStore::Pin BlockStore::pin(std::uint64_t block) {
  const std::lock_guard lock(mutex_);
  auto found = blocks_.find(block);
  if (found == blocks_.end()) {
    make_room();
    auto fresh = std::make_unique<Block>(cells_);
    if (touched_[block]) transfer(block, fresh->cells, false);
    touched_[block] = true;
    order_.push_front(block);
    found = blocks_.emplace(block, Entry{std::move(fresh), order_.begin()}).first;
  } else {
    order_.splice(order_.begin(), order_, found->second.place);
  }
  found->second.block->pins.fetch_add(1, std::memory_order_relaxed);
  return Pin(found->second.block.get());
}

void BlockStore::make_room() {
  for (auto at = order_.end(); blocks_.size() >= most_ && at != order_.begin();) {
    --at;
    const auto entry = blocks_.find(*at);
    if (entry->second.block->pins.load(std::memory_order_acquire) != 0) continue;
    transfer(*at, entry->second.block->cells, true);
    blocks_.erase(entry);
    at = order_.erase(at);
  }
}

void BlockStore::transfer(std::uint64_t block, std::vector<float>& cells, bool out) {
  if (!file_) file_.emplace(scratch_, "scratch file of the raster");
  const std::span<float> all(cells);
  const std::uint64_t offset = block * all.size_bytes();
  if (out) return file_->write(offset, std::as_bytes(all));
  file_->read(offset, std::as_writable_bytes(all));
}

}  // namespace delray::delaunay::internal
