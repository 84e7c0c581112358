// An array that grows under the threads that use it, and whose elements never move.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <new>

#include "delaunay/mesh/array.h"

namespace delray::delaunay::internal {

// Elements are of undefined content until they are written, and have numbers from 0.
template <class T>
class GrowingArray {
 public:
  // So many elements will be found fastest; there may be at most `maximum`.
  GrowingArray(std::size_t expected, std::size_t maximum)
      : maximum_(maximum),
        first_block_(static_cast<std::uint32_t>(
            std::bit_ceil(std::clamp<std::size_t>(expected, kSmallestBlock, maximum)))) {}

  std::uint32_t size() const { return size_; }

  // The first of `count` more. One thread at a time. Errors: std::bad_alloc. REQUIRES: `count`
  // divides kSmallestBlock, and is the same in all calls.
  std::uint32_t extend(std::uint32_t count) {
    if (size_ + std::size_t{count} > maximum_) throw std::bad_alloc();
    const unsigned block = block_of(size_);
    if (bases_[block] == nullptr) {
      blocks_[block] = Array<T>(std::size_t{first_block_} << block);
      bases_[block] = blocks_[block].data();
    }
    const std::uint32_t first = size_;
    size_ += count;
    return first;
  }

  // The element to touch after an extension to [first, first + count), or null: it lies in a large
  // page that nobody has used. A page is cleared when it is first touched, which takes a while, and
  // threads that come to it together would each clear one, all but one of them in vain; so the
  // thread that comes to a page first touches the one after it, when nobody needs that as yet.
  T* ahead_of(std::uint32_t first, std::uint32_t count) const {
    const unsigned block = block_of(first);
    T* const base = bases_[block];
    const std::uint32_t place = place_in(block, first);
    if (page_of(base + place) == page_of(base + place + count) && place != 0) return nullptr;
    const std::size_t ahead = place + count + kPage / sizeof(T);
    return ahead < std::size_t{first_block_} << block ? base + ahead : nullptr;
  }

  T& operator[](std::uint32_t i) const { return i < first_block_ ? bases_[0][i] : far(i); }

 private:
  // Blocks double in size, so that a handful of pointers leads to all elements.
  static constexpr std::uint32_t kSmallestBlock = 1024;
  static constexpr unsigned kBlocks = 21;
  static constexpr std::uintptr_t kPage = std::uintptr_t{1} << 21;

  static std::uintptr_t page_of(const T* element) {
    return reinterpret_cast<std::uintptr_t>(element) / kPage;
  }
  unsigned block_of(std::uint32_t i) const {
    return static_cast<unsigned>(std::bit_width(i / first_block_ + 1) - 1);
  }
  std::uint32_t place_in(unsigned block, std::uint32_t i) const {
    return i + first_block_ - (first_block_ << block);
  }
  // Apart, so that the rest is small enough to be inlined everywhere.
  [[gnu::noinline]] T& far(std::uint32_t i) const {
    const unsigned block = block_of(i);
    return bases_[block][place_in(block, i)];
  }

  std::size_t maximum_;
  std::uint32_t size_ = 0;
  std::uint32_t first_block_;
  std::array<T*, kBlocks> bases_{};
  std::array<Array<T>, kBlocks> blocks_;
};

}  // namespace delray::delaunay::internal
