// Finds the two simplices at each facet, given nothing but vertex numbers.
//
// Facets, as sorted vertices, are counted and scattered into buckets by their lowest vertex (a
// parallel counting sort); within each bucket, which fits the cache, a hash table pairs equal ones.
// O(n) expected. Degenerate: a facet of three or more simplices gets no mate and is reported; a
// vertex of very many facets fills one bucket, which one thread pairs.
#include "delaunay/mesh/facets.h"

#include <algorithm>
#include <array>
#include <bit>

#include "delaunay/mesh/array.h"
#include "parallel/parallel_for.h"

namespace delray::delaunay {
namespace {

// Vertices ascending; of an edge the last two.
struct Facet {
  std::array<std::uint32_t, 3> vertices;
  std::uint32_t number;

  bool equals(const Facet& other) const {
    return vertices[0] == other.vertices[0] && vertices[1] == other.vertices[1] &&
           vertices[2] == other.vertices[2];
  }
};

// That of simplex `first / (D + 1)` opposite to its vertex i.
template <int D>
Facet facet_of(const std::uint32_t* simplices, std::size_t first, std::size_t i) {
  Facet facet{{}, static_cast<std::uint32_t>(first + i)};
  std::array<std::uint32_t, 3>& v = facet.vertices;
  const std::uint32_t* corners = simplices + first;
  for (std::size_t k = 0; k < D; ++k) v[3 - D + k] = corners[k < i ? k : k + 1];
  if (D == 3 && v[0] > v[1]) std::swap(v[0], v[1]);
  if (v[1] > v[2]) std::swap(v[1], v[2]);
  if (D == 3 && v[0] > v[1]) std::swap(v[0], v[1]);
  return facet;
}

std::size_t slot_of(const Facet& facet) {
  std::uint64_t key = (std::uint64_t{facet.vertices[0]} << 32 | facet.vertices[1]);
  key = (key ^ (key >> 32)) * 0xd6e8feb86659fd93 + facet.vertices[2];
  key = (key ^ (key >> 32)) * 0xd6e8feb86659fd93;
  return key ^ (key >> 32);
}

// Pairs the facets of one bucket, which come in ascending order; returns the lowest number among
// those shared by more than two.
std::uint32_t pair_up(std::span<const Facet> bucket, std::vector<std::uint32_t>& mates) {
  constexpr std::uint32_t kFree = FacetMates::kNone;
  const std::size_t mask = std::bit_ceil(2 * bucket.size() + 1) - 1;
  std::vector<std::uint32_t> table(mask + 1, kFree);  // the first of each set of equal facets
  std::vector<std::uint8_t> equals(bucket.size(), 0);
  std::uint32_t crowded = FacetMates::kNone;
  for (std::uint32_t i = 0; i < bucket.size(); ++i) {
    std::size_t slot = slot_of(bucket[i]) & mask;
    while (table[slot] != kFree && !bucket[table[slot]].equals(bucket[i])) {
      slot = (slot + 1) & mask;
    }
    if (table[slot] == kFree) {
      table[slot] = i;
      continue;
    }
    const std::uint32_t first = bucket[table[slot]].number;
    std::uint8_t& known = equals[table[slot]];
    if (known == 0) {
      mates[first] = bucket[i].number;
      mates[bucket[i].number] = first;
    } else {
      if (known == 1) {
        mates[mates[first]] = FacetMates::kNone;
        mates[first] = FacetMates::kNone;
      }
      crowded = std::min(crowded, first);
    }
    known = known == 0 ? 1 : 2;
  }
  return crowded;
}

template <int D>
FacetMates match(std::span<const std::uint32_t> simplices, std::size_t points) {
  FacetMates result;
  result.mates.assign(simplices.size(), FacetMates::kNone);
  if (simplices.empty()) return result;
  // A bucket holds the facets whose lowest vertex is in a range: in the mean some 4096, so that
  // they and their table stay in the cache, and facets that were near each other remain so.
  const int wanted = std::clamp(static_cast<int>(std::bit_width(simplices.size() >> 12)), 0, 12);
  const int shift = std::max(0, static_cast<int>(std::bit_width(points)) - wanted);
  const std::size_t buckets = (points >> shift) + 1;
  const auto bucket_of = [&](const Facet& facet) { return facet.vertices[3 - D] >> shift; };
  // Each block counts its facets per bucket and later writes them behind those of earlier blocks.
  const std::size_t block = (D + 1) * std::max<std::size_t>(std::size_t{1} << 14, 2 * buckets);
  const std::size_t blocks = (simplices.size() + block - 1) / block;
  std::vector<std::uint32_t> next(blocks * buckets, 0);
  const auto each_of_block = [&](std::size_t b, auto&& f) {
    const std::size_t end = std::min(simplices.size(), (b + 1) * block);
    for (std::size_t first = b * block; first < end; first += D + 1) {
      for (std::size_t i = 0; i <= D; ++i) f(facet_of<D>(simplices.data(), first, i));
    }
  };
  parallel::parallel_for(0, blocks, 1, [&](std::size_t b) {
    each_of_block(b, [&](const Facet& facet) { ++next[b * buckets + bucket_of(facet)]; });
  });
  std::vector<std::uint32_t> begin(buckets + 1, 0);
  std::uint32_t sum = 0;
  for (std::size_t bucket = 0; bucket < buckets; ++bucket) {
    begin[bucket] = sum;
    for (std::size_t b = 0; b < blocks; ++b) {
      const std::uint32_t count = next[b * buckets + bucket];
      next[b * buckets + bucket] = sum;
      sum += count;
    }
  }
  begin[buckets] = sum;
  Array<Facet> facets(simplices.size());
  parallel::parallel_for(0, blocks, 1, [&](std::size_t b) {
    each_of_block(
        b, [&](const Facet& facet) { facets[next[b * buckets + bucket_of(facet)]++] = facet; });
  });
  result.crowded = parallel::parallel_reduce(
      0, buckets, 1, FacetMates::kNone,
      [&](std::size_t first, std::size_t last) {
        std::uint32_t crowded = FacetMates::kNone;
        for (std::size_t b = first; b < last; ++b) {
          const std::span bucket(facets.data() + begin[b], begin[b + 1] - begin[b]);
          crowded = std::min(crowded, pair_up(bucket, result.mates));
        }
        return crowded;
      },
      [](std::uint32_t a, std::uint32_t b) { return std::min(a, b); });
  return result;
}

}  // namespace

FacetMates match_facets(int dim, std::span<const std::uint32_t> simplices, std::size_t points) {
  return dim == 2 ? match<2>(simplices, points) : match<3>(simplices, points);
}

std::span<const int> facet_corners(int dim, std::size_t opposite) {
  static constexpr std::array<std::array<int, 2>, 3> kEdges = {{{1, 2}, {2, 0}, {0, 1}}};
  static constexpr std::array<std::array<int, 3>, 4> kTriangles = {
      {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
  return dim == 2 ? std::span<const int>(kEdges[opposite])
                  : std::span<const int>(kTriangles[opposite]);
}

}  // namespace delray::delaunay
