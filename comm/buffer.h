// The bytes that a message carries.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstring>
#include <span>
#include <type_traits>
#include <utility>

namespace delray::comm {

namespace internal {
// Memory for messages, not initialised. Large blocks are kept when they are given back, up to 256
// MiB in all, and handed out again: fresh memory from the system takes several times as long to
// write to as a message takes on its way between two processes. Under MPI they are of memory that
// other processes of the machine see (shared_memory.h). Any thread.
std::byte* take_memory(std::size_t size);
void give_back_memory(std::byte* memory, std::size_t size) noexcept;
}  // namespace internal

// Owned bytes, moved and never copied implicitly; not initialised on construction, aligned for any
// scalar type.
class Buffer {
 public:
  Buffer() = default;
  Buffer(Buffer&& other) noexcept
      : bytes_(std::exchange(other.bytes_, nullptr)),
        size_(std::exchange(other.size_, 0)),
        counted_(std::exchange(other.counted_, 0)) {}
  Buffer& operator=(Buffer&& other) noexcept {
    Buffer taken(std::move(other));
    std::swap(bytes_, taken.bytes_);
    std::swap(size_, taken.size_);
    std::swap(counted_, taken.counted_);
    return *this;
  }
  explicit Buffer(std::size_t size)
      : bytes_(internal::take_memory(size)), size_(size), counted_(size) {}
  ~Buffer() {
    if (bytes_) internal::give_back_memory(bytes_, size_);
  }

  // Stands for a message of `bytes` bytes of which `content` is all that anybody looks at: runs on
  // metadata-only layers send these, in one process only. Ledgers and the simulated machine take
  // them for what they stand for.
  static Buffer standing_for(std::size_t bytes, Buffer&& content) {
    Buffer buffer = std::move(content);
    buffer.counted_ = bytes;
    return buffer;
  }

  // A copy of `values`.
  template <class T>
  static Buffer of(std::span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    Buffer buffer(values.size_bytes());
    if (!values.empty()) std::memcpy(buffer.data(), values.data(), values.size_bytes());
    return buffer;
  }
  template <class T>
  static Buffer of_value(const T& value) {
    return of(std::span<const T>(&value, 1));
  }

  Buffer copy() const {
    return standing_for(counted_, of(std::span<const std::byte>(bytes_, size_)));
  }

  std::byte* data() { return bytes_; }
  const std::byte* data() const { return bytes_; }
  std::size_t size() const { return size_; }
  // size() unless it stands for another message.
  std::size_t counted_bytes() const { return counted_; }
  bool empty() const { return size_ == 0; }

  // For communicators, which hand over memory between buffers of several processes. Memory of so
  // many bytes as take_memory gives, to be given back in the end.
  static Buffer of_memory(std::byte* memory, std::size_t size) {
    Buffer buffer;
    buffer.bytes_ = memory;
    buffer.size_ = buffer.counted_ = size;
    return buffer;
  }
  // The memory is the caller's now, the buffer empty.
  std::byte* release() {
    size_ = counted_ = 0;
    return std::exchange(bytes_, nullptr);
  }
  // Whether memory of so many bytes is a block of internal::block_pool().
  static bool is_pooled(std::size_t size);

  // The bytes as values of T. REQUIRES: size() is a multiple of sizeof(T).
  template <class T>
  std::span<T> as() {
    static_assert(std::is_trivially_copyable_v<T>);
    assert(size_ % sizeof(T) == 0);
    return {reinterpret_cast<T*>(bytes_), size_ / sizeof(T)};
  }
  template <class T>
  std::span<const T> as() const {
    static_assert(std::is_trivially_copyable_v<T>);
    assert(size_ % sizeof(T) == 0);
    return {reinterpret_cast<const T*>(bytes_), size_ / sizeof(T)};
  }

 private:
  std::byte* bytes_ = nullptr;
  std::size_t size_ = 0, counted_ = 0;
};

}  // namespace delray::comm
