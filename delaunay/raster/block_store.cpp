// Least recently used blocks are written to an unnamed file and read back when they are asked for
// again. The file ends with the process, however that ends.
#include "delaunay/raster/block_store.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>
#include <string>
#include <utility>

#include "files/error.h"

namespace delray::delaunay::internal {

BlockStore::Block::Block(std::size_t size) : cells(size, std::numeric_limits<float>::quiet_NaN()) {}

BlockStore::BlockStore(std::uint64_t blocks, std::size_t cells, std::size_t most,
                       std::filesystem::path scratch)
    : cells_(cells),
      most_(std::max<std::size_t>(most, 1)),
      scratch_(std::move(scratch)),
      touched_(blocks) {}

BlockStore::~BlockStore() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

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

void BlockStore::open_scratch() {
  std::error_code ignored;
  if (scratch_.empty()) scratch_ = std::filesystem::temp_directory_path(ignored);
  descriptor_ = ::open(scratch_.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (descriptor_ < 0 && (errno == EOPNOTSUPP || errno == EISDIR || errno == ENOENT)) {
    // Not every file system makes files without names.
    std::string name = (scratch_ / ".delray-raster-XXXXXX").string();
    descriptor_ = ::mkostemp(name.data(), O_CLOEXEC);
    if (descriptor_ >= 0) ::unlink(name.c_str());
  }
}

void BlockStore::transfer(std::uint64_t block, std::vector<float>& cells, bool out) {
  if (descriptor_ < 0) open_scratch();
  auto* at = reinterpret_cast<char*>(cells.data());
  std::size_t left = cells.size() * sizeof(float);
  auto offset = static_cast<off_t>(block * left);
  while (descriptor_ >= 0 && left > 0) {
    const ssize_t moved =
        out ? ::pwrite(descriptor_, at, left, offset) : ::pread(descriptor_, at, left, offset);
    if (moved < 0 && errno == EINTR) continue;
    if (moved <= 0) break;
    at += moved;
    left -= static_cast<std::size_t>(moved);
    offset += moved;
  }
  if (left == 0) return;
  throw files::FileError(
      files::Cause::device, scratch_.string(), "scratch file of the raster",
      std::string("cannot ") + (out ? "write: " : "read: ") + std::strerror(errno));
}

}  // namespace delray::delaunay::internal
