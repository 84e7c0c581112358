// Blocks of memory for large messages, of this process's heap or shared with others.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

namespace delray::comm::internal {

// In front of a block's memory, in memory of the process that made it.
struct alignas(64) Block {
  std::size_t index = 0;
  Block* next = nullptr;          // of those of this size that are kept
  std::int64_t process = 0;       // that shares it; 0: of the heap
  std::atomic<bool> lent{false};  // until the process that it was lent to sets it to false

  std::byte* memory() { return reinterpret_cast<std::byte*>(this + 1); }
  static Block* of(std::byte* memory) { return reinterpret_cast<Block*>(memory) - 1; }
};
static_assert(std::atomic<bool>::is_always_lock_free);

// Any thread.
class BlockPool {
 public:
  // From now on blocks are cut from `memory` while there is some. Once.
  void share(std::int64_t process, std::span<std::byte> memory);

  Block* take(std::size_t bytes);
  // A block that take gave, or one of another process.
  void give_back(Block* block) noexcept;

  // The block's memory is another process's until that gives it back; its place in what share was
  // given. REQUIRES: is_shared(block).
  bool is_shared(const Block& block) const {
    return block.process != 0 && block.process == process_;
  }
  std::size_t lend(Block* block);
  // How many blocks other processes have not given back.
  std::size_t lent();

 private:
  Block* take_kept(std::size_t index);
  Block* cut(std::size_t index);
  bool keep(Block* block);
  void take_back_what_was_lent();

  std::mutex mutex_;
  std::array<Block*, 260> blocks_{};  // the first of each size; what came last is taken first
  std::size_t kept_ = 0;              // bytes of those of the heap
  std::vector<Block*> lent_;
  std::atomic<std::int64_t> process_{0};
  std::span<std::byte> shared_;
  std::size_t cut_ = 0;  // bytes of it
};

// Whether a block of this index may have a message of so many bytes. Any index: it may come from
// another process.
bool block_holds(std::size_t index, std::size_t bytes);

// Of this process. Never destroyed: buffers may outlive whatever is.
BlockPool& block_pool();

}  // namespace delray::comm::internal
