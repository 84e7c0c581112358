// The order-independent hash of a triangulation: hashes of the simplices, each with sorted
// vertices, are summed modulo 2^128 by a parallel reduction. O(simplices).
#include "delaunay/triangulation.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <span>

#include "delaunay/mesh/simplex_hash.h"
#include "parallel/parallel_for.h"

namespace delray::delaunay {
namespace {

// A block takes some tens of microseconds.
constexpr std::size_t kSimplicesPerBlock = 4096;

template <std::size_t Corners, class Row>
Hash128 hash_of_range(std::span<const Row> vertices, std::size_t first, std::size_t last) {
  internal::HashSum sum;
  for (std::size_t t = first; t < last; ++t) {
    std::array<std::uint64_t, Corners> rows;
    std::copy_n(&vertices[t * Corners], Corners, rows.begin());
    sum.add(rows);
  }
  return sum.sum();
}

template <class Row>
Hash128 hash_all(int dim, std::span<const Row> vertices) {
  const std::size_t simplices = vertices.size() / (static_cast<std::size_t>(dim) + 1);
  return parallel::parallel_reduce(
      0, simplices, kSimplicesPerBlock, Hash128{},
      [&](std::size_t first, std::size_t last) {
        switch (dim) {
          case 2:
            return hash_of_range<3>(vertices, first, last);
          case 3:
            return hash_of_range<4>(vertices, first, last);
          case 4:
            return hash_of_range<5>(vertices, first, last);
          case 5:
            return hash_of_range<6>(vertices, first, last);
          default:
            return hash_of_range<7>(vertices, first, last);
        }
      },
      [](const Hash128& a, const Hash128& b) { return a + b; });
}

}  // namespace

Hash128 operator+(const Hash128& a, const Hash128& b) {
  const std::uint64_t low = a.low + b.low;
  return {a.high + b.high + (low < a.low ? 1 : 0), low};
}

std::string to_string(const Hash128& hash) {
  std::array<char, 33> text;
  std::snprintf(text.data(), text.size(), "%016llx%016llx",
                static_cast<unsigned long long>(hash.high),
                static_cast<unsigned long long>(hash.low));
  return text.data();
}

Hash128 hash(int dim, std::span<const std::uint64_t> vertices) { return hash_all(dim, vertices); }

Hash128 hash(const Triangulation& triangulation) {
  return hash_all(triangulation.dim, std::span<const std::uint32_t>(triangulation.vertices));
}

}  // namespace delray::delaunay
