// The whole triangulation is made, verified like any other, and has the simplices looked up in it.
#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "delaunay/mesh/arguments.h"
#include "delaunay/mesh/equal_points.h"
#include "delaunay/triangulate.h"
#include "delaunay/verify.h"

namespace delray::delaunay {
namespace {

// The vertices of a simplex, ascending, behind zeros.
using Corners = std::array<std::uint32_t, 4>;

std::vector<std::pair<Corners, std::size_t>> sorted_simplices(
    int dim, std::span<const std::uint32_t> simplices, std::span<const std::uint32_t> lowest) {
  const auto corners = static_cast<std::size_t>(dim) + 1;
  std::vector<std::pair<Corners, std::size_t>> sorted(simplices.size() / corners);
  for (std::size_t t = 0; t < sorted.size(); ++t) {
    sorted[t] = {Corners{}, t};
    for (std::size_t k = 0; k < corners; ++k) {
      sorted[t].first[k] = lowest[simplices[t * corners + k]];
    }
    std::ranges::sort(sorted[t].first);
  }
  std::ranges::sort(sorted);
  return sorted;
}

}  // namespace

Verdict verify_part(int dim, PointView<double> points, std::span<const std::uint32_t> simplices) {
  internal::check_view(points, dim);
  internal::check_simplices(dim, simplices, points.size());
  Options options;
  options.dim = dim;
  const Triangulation whole = triangulate(points, options).triangulation;
  Verdict verdict = verify_simplices(dim, points, whole.vertices);
  if (!verdict.canonical) return verdict;
  const std::vector<std::uint32_t> lowest = lowest_equal_rows(points, dim);
  const auto known = sorted_simplices(dim, whole.vertices, lowest);
  const auto given = sorted_simplices(dim, simplices, lowest);
  const auto fail = [&](std::size_t simplex, const char* reason) {
    if (verdict.simplex && *verdict.simplex <= simplex) return;
    verdict.valid = verdict.delaunay = verdict.canonical = false;
    verdict.simplex = simplex;
    verdict.reason = reason;
  };
  auto place = known.begin();
  for (std::size_t i = 0; i < given.size(); ++i) {
    while (place != known.end() && place->first < given[i].first) ++place;
    if (place == known.end() || place->first != given[i].first) {
      fail(given[i].second, "is none of the Delaunay triangulation of the points");
    } else if (i > 0 && given[i - 1].first == given[i].first) {
      fail(given[i].second, "is there twice");
    }
  }
  return verdict;
}

}  // namespace delray::delaunay
