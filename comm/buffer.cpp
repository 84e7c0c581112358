// Takes the memory of large messages from the pool of blocks, that of small ones from the heap.
#include "comm/buffer.h"

#include "comm/transport/block_pool.h"

namespace delray::comm {

bool Buffer::is_pooled([[maybe_unused]] std::size_t size) {
#ifdef DELRAY_ASAN
  return false;  // it could not tell when memory is used that was given back
#else
  // MPI copies at once what is smaller.
  constexpr std::size_t kSmallestPooled = std::size_t{1} << 12;
  return size >= kSmallestPooled;
#endif
}

namespace internal {

std::byte* take_memory(std::size_t size) {
  return Buffer::is_pooled(size) ? block_pool().take(size)->memory() : new std::byte[size];
}

void give_back_memory(std::byte* memory, std::size_t size) noexcept {
  if (Buffer::is_pooled(size)) {
    block_pool().give_back(Block::of(memory));
  } else {
    delete[] memory;
  }
}

}  // namespace internal
}  // namespace delray::comm
