// A pool with segregated free lists, four sizes to each power of two.
//
// A block is taken from the list of its size or of one up to twice as large, else cut from the
// shared memory, else allocated. Blocks lent to other processes are collected when there is none
// to be taken. Constant time, but for the blocks that are lent.
//
// Degenerate: once memory is shared, blocks of the heap are no longer kept; beyond a limit they are
// freed at once.
#include "comm/transport/block_pool.h"

#include <bit>
#include <new>

namespace delray::comm::internal {
namespace {

// As much as eight ranks have under way that exchange whole pictures of 1920 x 1080, twice.
constexpr std::size_t kMostKept = std::size_t{1} << 28;

// Sizes of blocks are four to each power of two, so that less than a quarter is never used.
std::size_t bytes_of(std::size_t index) { return (index % 4 + 4) << (index / 4 - 2); }

// Of the smallest size that `bytes` fit into. REQUIRES: bytes >= 4.
std::size_t index_of(std::size_t bytes) {
  const auto power = static_cast<std::size_t>(std::bit_width(bytes) - 1);
  const std::size_t quarter = std::size_t{1} << (power - 2);
  const std::size_t quarters = (bytes + quarter - 1) / quarter;  // 4 to 8
  return 4 * power + quarters - 4;
}

}  // namespace

void BlockPool::share(std::int64_t process, std::span<std::byte> memory) {
  const std::scoped_lock lock(mutex_);
  shared_ = memory;
  process_ = process;
  // Those of the heap would be taken first.
  for (Block*& first : blocks_) {
    while (first != nullptr) {
      Block* const block = first;
      first = block->next;
      ::operator delete (block, std::align_val_t{alignof(Block)});
    }
  }
  kept_ = 0;
}

Block* BlockPool::take(std::size_t bytes) {
  const std::size_t index = index_of(bytes);
  {
    const std::scoped_lock lock(mutex_);
    if (Block* const block = take_kept(index)) return block;
    take_back_what_was_lent();
    if (Block* const block = take_kept(index)) return block;
    if (Block* const block = cut(index)) return block;
  }
  void* const memory =
      ::operator new (sizeof(Block) + bytes_of(index), std::align_val_t{alignof(Block)});
  return new (memory) Block{index};
}

void BlockPool::give_back(Block* block) noexcept {
  if (block->process != 0 && !is_shared(*block)) {
    block->lent.store(false, std::memory_order_release);
  } else if (const std::scoped_lock lock(mutex_); !keep(block)) {
    ::operator delete (block, std::align_val_t{alignof(Block)});
  }
}

std::size_t BlockPool::lend(Block* block) {
  block->lent.store(true, std::memory_order_relaxed);
  const std::scoped_lock lock(mutex_);
  lent_.push_back(block);
  return static_cast<std::size_t>(reinterpret_cast<std::byte*>(block) - shared_.data());
}

std::size_t BlockPool::lent() {
  const std::scoped_lock lock(mutex_);
  take_back_what_was_lent();
  return lent_.size();
}

// A block of up to twice the size is better than fresh memory.
Block* BlockPool::take_kept(std::size_t index) {
  for (std::size_t i = index; i <= index + 4 && i < blocks_.size(); ++i) {
    Block* const block = blocks_[i];
    if (block == nullptr) continue;
    blocks_[i] = block->next;
    if (block->process == 0) kept_ -= bytes_of(i);
    return block;
  }
  return nullptr;
}

Block* BlockPool::cut(std::size_t index) {
  const std::size_t bytes = (sizeof(Block) + bytes_of(index) + 63) / 64 * 64;
  if (bytes > shared_.size() - cut_) return nullptr;
  void* const memory = shared_.data() + cut_;
  cut_ += bytes;
  return new (memory) Block{index, nullptr, process_};
}

// False when enough is kept.
bool BlockPool::keep(Block* block) {
  if (block->process == 0) {
    if (!shared_.empty() || kept_ + bytes_of(block->index) > kMostKept) return false;
    kept_ += bytes_of(block->index);
  }
  block->next = blocks_[block->index];
  blocks_[block->index] = block;
  return true;
}

void BlockPool::take_back_what_was_lent() {
  std::erase_if(lent_, [&](Block* block) {
    return !block->lent.load(std::memory_order_acquire) && keep(block);
  });
}

bool block_holds(std::size_t index, std::size_t bytes) {
  constexpr std::size_t kMost = 4 * 62;  // of what the shift above can tell
  return 8 <= index && index < kMost && bytes <= bytes_of(index);
}

BlockPool& block_pool() {
  static BlockPool& pool = *new BlockPool;
  return pool;
}

}  // namespace delray::comm::internal
