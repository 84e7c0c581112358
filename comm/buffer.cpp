#include "comm/buffer.h"

#include <array>
#include <bit>
#include <cstdint>
#include <mutex>
#include <new>

namespace delray::comm::internal {
namespace {

// Below this malloc has memory at hand.
constexpr std::size_t kSmallestKept = std::size_t{1} << 16;
// As much as eight ranks have under way that exchange whole pictures of 1920 x 1080, twice.
constexpr std::size_t kMostKept = std::size_t{1} << 28;

// In front of a large block's memory. Sizes of blocks are four to each power of two, so that less
// than a quarter is never used; `index` counts them.
struct alignas(64) Header {
  std::size_t index = 0;
  Header* next = nullptr;  // of those of this size that are kept
};

std::size_t bytes_of(std::size_t index) { return (index % 4 + 4) << (index / 4 - 2); }

// Of the smallest size that `bytes` fit into. REQUIRES: bytes >= kSmallestKept.
std::size_t index_of(std::size_t bytes) {
  const auto power = static_cast<std::size_t>(std::bit_width(bytes) - 1);
  const std::size_t quarter = std::size_t{1} << (power - 2);
  const std::size_t quarters = (bytes + quarter - 1) / quarter;  // 4 to 8
  return 4 * power + quarters - 4;
}

class Pool {
 public:
  // Null when there is none.
  Header* take(std::size_t index) {
    const std::scoped_lock lock(mutex_);
    // A block of up to twice the size is better than fresh memory.
    for (std::size_t i = index; i <= index + 4 && i < blocks_.size(); ++i) {
      Header* const block = blocks_[i];
      if (!block) continue;
      blocks_[i] = block->next;
      kept_ -= bytes_of(i);
      return block;
    }
    return nullptr;
  }

  // False when enough is kept.
  bool keep(Header* block) {
    const std::scoped_lock lock(mutex_);
    if (kept_ + bytes_of(block->index) > kMostKept) return false;
    block->next = blocks_[block->index];
    blocks_[block->index] = block;
    kept_ += bytes_of(block->index);
    return true;
  }

 private:
  std::mutex mutex_;
  std::array<Header*, 260> blocks_{};  // the first of each size; what came last is taken first
  std::size_t kept_ = 0;
};

// Never destroyed: buffers may outlive whatever is.
Pool& pool() {
  static Pool& pool = *new Pool;
  return pool;
}

bool is_kept([[maybe_unused]] std::size_t size) {
#if defined(__SANITIZE_ADDRESS__)
  return false;  // it could not tell when memory is used that was given back
#else
  return size >= kSmallestKept;
#endif
}

}  // namespace

std::byte* take_memory(std::size_t size) {
  if (!is_kept(size)) return new std::byte[size];
  const std::size_t index = index_of(size);
  Header* block = pool().take(index);
  if (!block) {
    void* const memory =
        ::operator new (sizeof(Header) + bytes_of(index), std::align_val_t{alignof(Header)});
    block = new (memory) Header{index, nullptr};
  }
  return reinterpret_cast<std::byte*>(block + 1);
}

void give_back_memory(std::byte* memory, std::size_t size) noexcept {
  if (!is_kept(size)) {
    delete[] memory;
    return;
  }
  Header* const block = reinterpret_cast<Header*>(memory) - 1;
  if (!pool().keep(block)) ::operator delete (block, std::align_val_t{alignof(Header)});
}

}  // namespace delray::comm::internal
