#include "delaunay/internal/facets.h"

#include <algorithm>
#include <array>

#include "parallel/parallel_for.h"

namespace delray::delaunay {
namespace {

// A facet within the bucket of its lowest vertex.
struct Facet {
  std::uint32_t middle, high;  // the other vertices, ascending; in 2D middle is 0
  std::uint32_t number;

  bool same_vertices(const Facet& other) const {
    return middle == other.middle && high == other.high;
  }
  auto operator<=>(const Facet&) const = default;
};

struct Corners {
  std::array<std::uint32_t, 3> vertices;  // ascending; in 2D the last two
  std::uint32_t lowest(int dim) const { return vertices[3 - dim]; }
};

Corners corners_of(int dim, std::span<const std::uint32_t> simplices, std::size_t facet) {
  const std::size_t corners = static_cast<std::size_t>(dim) + 1;
  const std::size_t first = facet - facet % corners;
  Corners result{};
  int k = 3 - dim;
  for (std::size_t v = first; v < first + corners; ++v) {
    if (v != facet) result.vertices[k++] = simplices[v];
  }
  std::sort(result.vertices.begin() + (3 - dim), result.vertices.end());
  return result;
}

// Pairs the facets of one bucket; returns the lowest number among those shared by more than two.
std::uint32_t pair_up(std::span<Facet> bucket, std::vector<std::uint32_t>& mates) {
  std::ranges::sort(bucket);
  std::uint32_t crowded = FacetMates::kNone;
  for (std::size_t i = 0; i < bucket.size();) {
    std::size_t end = i + 1;
    while (end < bucket.size() && bucket[end].same_vertices(bucket[i])) ++end;
    if (end - i == 2) {
      mates[bucket[i].number] = bucket[i + 1].number;
      mates[bucket[i + 1].number] = bucket[i].number;
    } else if (end - i > 2) {
      crowded = std::min(crowded, bucket[i].number);
    }
    i = end;
  }
  return crowded;
}

}  // namespace

FacetMates match_facets(int dim, std::span<const std::uint32_t> simplices, std::size_t points) {
  FacetMates result;
  result.mates.assign(simplices.size(), FacetMates::kNone);
  std::vector<std::uint32_t> begin(points + 2, 0);  // begin[v + 1]: where bucket v is filled next
  for (std::size_t facet = 0; facet < simplices.size(); ++facet) {
    ++begin[corners_of(dim, simplices, facet).lowest(dim) + 2];
  }
  for (std::size_t v = 2; v < begin.size(); ++v) begin[v] += begin[v - 1];
  std::vector<Facet> facets(simplices.size());
  for (std::size_t facet = 0; facet < simplices.size(); ++facet) {
    const Corners corners = corners_of(dim, simplices, facet);
    const std::uint32_t middle = dim == 3 ? corners.vertices[1] : 0;
    facets[begin[corners.lowest(dim) + 1]++] = {middle, corners.vertices[2],
                                                static_cast<std::uint32_t>(facet)};
  }
  constexpr std::size_t kGrain = 1024;  // vertices: about 0.1 ms
  result.crowded = parallel::parallel_reduce(
      0, points, kGrain, FacetMates::kNone,
      [&](std::size_t first, std::size_t last) {
        std::uint32_t crowded = FacetMates::kNone;
        for (std::size_t v = first; v < last; ++v) {
          const std::span bucket(facets.data() + begin[v], begin[v + 1] - begin[v]);
          crowded = std::min(crowded, pair_up(bucket, result.mates));
        }
        return crowded;
      },
      [](std::uint32_t a, std::uint32_t b) { return std::min(a, b); });
  return result;
}

}  // namespace delray::delaunay
