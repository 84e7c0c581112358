// Groups equal points by a parallel hash partition: rows are counted into buckets by the high bits
// of their hash, and each bucket is searched by open addressing in a table that fits the cache.
// O(n) expected. Degenerate: many equal points fall into one bucket, which one thread searches,
// still in O(1) for each; -0 is hashed as 0.
#include "delaunay/mesh/equal_points.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "parallel/parallel_for.h"

namespace delray::delaunay {
namespace {

constexpr std::uint32_t kFreeSlot = std::numeric_limits<std::uint32_t>::max();

std::uint64_t mix(std::uint64_t key) {
  key = (key ^ (key >> 32)) * 0xd6e8feb86659fd93;
  key = (key ^ (key >> 32)) * 0xd6e8feb86659fd93;
  return key ^ (key >> 32);
}

std::uint64_t hash_of(PointView<double> points, int dim, std::size_t i) {
  std::uint64_t hash = 0;
  for (int k = 0; k < dim; ++k) {
    hash = mix(hash * 31 + std::bit_cast<std::uint64_t>(points(i, k) + 0.0));  // -0 + 0 is 0
  }
  return hash;
}

bool equal(PointView<double> points, int dim, std::size_t i, std::size_t j) {
  for (int k = 0; k < dim; ++k) {
    if (points(i, k) != points(j, k)) return false;
  }
  return true;
}

}  // namespace

std::vector<std::uint32_t> lowest_equal_rows(PointView<double> points, int dim) {
  const std::size_t n = points.size();
  // About 8192 rows to a bucket: their table and coordinates fit the second-level cache.
  const int bits = std::clamp(static_cast<int>(std::bit_width(n >> 13)), 1, 16);
  const auto bucket_of = [bits](std::uint64_t hash) { return hash >> (64 - bits); };
  std::vector<std::uint64_t> hashes(n);
  constexpr std::size_t kGrain = 16384;  // about 0.1 ms
  parallel::parallel_for(0, n, kGrain, [&](std::size_t i) { hashes[i] = hash_of(points, dim, i); });
  const std::size_t buckets = std::size_t{1} << bits;
  std::vector<std::size_t> begin(buckets + 2, 0);
  for (const std::uint64_t hash : hashes) ++begin[bucket_of(hash) + 2];
  for (std::size_t b = 2; b < begin.size(); ++b) begin[b] += begin[b - 1];
  std::vector<std::uint32_t> rows(n);  // ascending within a bucket
  for (std::size_t i = 0; i < n; ++i) {
    rows[begin[bucket_of(hashes[i]) + 1]++] = static_cast<std::uint32_t>(i);
  }

  std::vector<std::uint32_t> lowest(n);
  parallel::parallel_for(0, buckets, 1, [&](std::size_t b) {
    const std::size_t size = std::bit_ceil(2 * (begin[b + 1] - begin[b]) + 1);
    std::vector<std::uint32_t> table(size, kFreeSlot);
    for (std::size_t r = begin[b]; r < begin[b + 1]; ++r) {
      const std::uint32_t row = rows[r];
      std::size_t slot = hashes[row] & (size - 1);
      while (table[slot] != kFreeSlot && !equal(points, dim, table[slot], row)) {
        slot = (slot + 1) & (size - 1);
      }
      if (table[slot] == kFreeSlot) table[slot] = row;
      lowest[row] = table[slot];
    }
  });
  return lowest;
}

}  // namespace delray::delaunay
