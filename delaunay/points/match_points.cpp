// Puts vertices and points into one list and groups equal coordinates by a hash: a vertex is the
// lowest point of its group. Two points that are different but round to the same floats make a
// vertex ambiguous.
#include "delaunay/match_points.h"

#include <cmath>
#include <glm/glm.hpp>
#include <limits>

#include "delaunay/mesh/equal_points.h"

namespace delray::delaunay {
namespace {

// A double beyond the floats stays as it is, and equals none.
double rounded_to_float(double x) {
  return std::abs(x) > static_cast<double>(std::numeric_limits<float>::max())
             ? x
             : static_cast<double>(static_cast<float>(x));
}

}  // namespace

PointMatch match_points(PointView<double> vertices, PointView<double> points,
                        const Matching& matching) {
  const std::size_t n = points.size();
  const int compared = matching.with_z ? 3 : matching.dim;
  std::vector<glm::dvec3> all(n + vertices.size(), glm::dvec3(0));
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (int k = 0; k < compared; ++k) {
      if (i >= n) {
        all[i][k] = vertices(i - n, k);
      } else {
        all[i][k] = matching.as_floats ? rounded_to_float(points(i, k)) : points(i, k);
      }
    }
  }
  const std::vector<std::uint32_t> alike = lowest_equal_rows(view(all), compared);
  const std::vector<std::uint32_t> equal = lowest_equal_rows(points, matching.dim);
  // For the lowest of rows that are alike, one that differs from it.
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> other(n, kNone);
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint32_t lowest = alike[i];
    if (equal[i] != equal[lowest] && other[lowest] == kNone) {
      other[lowest] = static_cast<std::uint32_t>(i);
    }
  }
  PointMatch match;
  std::vector<bool> used(n);
  match.rows.resize(vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const std::uint32_t lowest = alike[n + i];
    if (lowest >= n) {
      match.unknown = i;
      return match;
    }
    if (other[lowest] != kNone) {
      match.ambiguous = {i, {lowest, other[lowest]}};
      return match;
    }
    match.rows[i] = equal[lowest];
    used[match.rows[i]] = true;
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (equal[i] != i) continue;
    ++match.distinct;
    if (!used[i]) ++match.unused;
  }
  return match;
}

}  // namespace delray::delaunay
