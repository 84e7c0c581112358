// Large arrays of plain values whose contents start undefined.
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <cstdint>
#include <new>
#include <type_traits>
#include <utility>

namespace delray::delaunay {

// Asks for huge pages for memory that was not touched yet, where the system has them: fewer faults
// on the way, fewer translations to miss later. Below some megabytes they would mostly be empty.
inline void prefer_huge_pages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t bytes) {
#ifdef MADV_HUGEPAGE
  constexpr std::size_t kHugeFrom = std::size_t{4} << 20;
  constexpr std::uintptr_t kPage = 65536;  // a multiple of every system's
  const std::uintptr_t begin = reinterpret_cast<std::uintptr_t>(memory);
  const std::uintptr_t first = (begin + kPage - 1) / kPage * kPage;
  if (bytes >= kHugeFrom) {
    madvise(reinterpret_cast<void*>(first), begin + bytes - first, MADV_HUGEPAGE);
  }
#endif
}

// Large ones come straight from the system, in huge pages where it has them: no time is spent on
// zeros that are overwritten at once, and random access misses fewer translations.
template <class T>
class Array {
 public:
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

  Array() = default;
  // Errors: std::bad_alloc.
  explicit Array(std::size_t size) : size_(size), bytes_(size * sizeof(T)) {
    if (bytes_ < kMappedFrom) {
      data_ = static_cast<T*>(::operator new(bytes_, kAlignment));
      return;
    }
    mapped_ = true;
    void* memory =
        mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) throw std::bad_alloc();
    data_ = static_cast<T*>(memory);
    prefer_huge_pages(memory, bytes_);
  }
  Array(Array&& other) noexcept { swap(other); }
  Array& operator=(Array&& other) noexcept {
    swap(other);
    return *this;
  }
  ~Array() {
    if (!mapped_) {
      ::operator delete(data_, kAlignment);
    } else if (bytes_ > 0) {
      munmap(data_, bytes_);
    }
  }

  std::size_t size() const { return size_; }
  T& operator[](std::size_t i) { return data_[i]; }
  const T& operator[](std::size_t i) const { return data_[i]; }
  T* data() { return data_; }
  const T* data() const { return data_; }

  // Forgets the values from `size` on and gives their memory back to the system if it came from
  // there. REQUIRES: size <= size().
  void shrink(std::size_t size) {
    const std::size_t kept = (size * sizeof(T) + kPage - 1) / kPage * kPage;
    if (mapped_ && kept < bytes_) {
      munmap(reinterpret_cast<std::byte*>(data_) + kept, bytes_ - kept);
      bytes_ = kept;
    }
    size_ = size;
  }

  // Forgets the values [first, last), whose memory goes back to the system as far as it came from
  // there; they may be written again.
  void discard(std::size_t first, std::size_t last) {
    const std::size_t from = (first * sizeof(T) + kPage - 1) / kPage * kPage;
    const std::size_t to = last * sizeof(T) / kPage * kPage;
    if (mapped_ && from < to) {
      madvise(reinterpret_cast<std::byte*>(data_) + from, to - from, MADV_DONTNEED);
    }
  }

 private:
  static constexpr std::align_val_t kAlignment{alignof(T) > __STDCPP_DEFAULT_NEW_ALIGNMENT__
                                                   ? alignof(T)
                                                   : __STDCPP_DEFAULT_NEW_ALIGNMENT__};
  static constexpr std::size_t kPage = 65536;  // a multiple of every system's
  static constexpr std::size_t kMappedFrom = std::size_t{1} << 20;

  void swap(Array& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    std::swap(bytes_, other.bytes_);
    std::swap(mapped_, other.mapped_);
  }

  T* data_ = nullptr;
  std::size_t size_ = 0;
  std::size_t bytes_ = 0;
  bool mapped_ = false;
};

}  // namespace delray::delaunay
