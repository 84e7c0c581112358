// Arrays that become large at once.
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace delray::parallel {

// Gives `values` so many, new ones being zero, in huge pages where the system has them: a fault for
// each page of 4 KiB would take longer than to fill it. Several arrays are best made at once, by
// tasks of a loop.
template <class T>
void grow(std::vector<T>& values, std::size_t size) {
  values.reserve(size);
#ifdef MADV_HUGEPAGE
  constexpr std::size_t kHugeFrom = std::size_t{4} << 20;  // below they would mostly be empty
  constexpr std::uintptr_t kPage = 65536;                  // a multiple of every system's
  const std::size_t bytes = size * sizeof(T);
  if (bytes >= kHugeFrom) {
    const auto begin = reinterpret_cast<std::uintptr_t>(values.data());
    const std::uintptr_t first = (begin + kPage - 1) / kPage * kPage;
    madvise(reinterpret_cast<void*>(first), begin + bytes - first, MADV_HUGEPAGE);
  }
#endif
  values.resize(size);
}

}  // namespace delray::parallel
