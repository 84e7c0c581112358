// The Delaunay triangulation straight from its definition: the reference for all others.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "delaunay/predicates.h"

namespace delray::delaunay {

template <int D>
using Point = glm::vec<D, double, glm::defaultp>;
template <int D>
using Simplex = std::array<Point<D>, D + 1>;

inline int orient(const Simplex<2>& p) { return orient2d(p[0], p[1], p[2]); }
inline int orient(const Simplex<3>& p) { return orient3d(p[0], p[1], p[2], p[3]); }
inline int in_sphere(const Simplex<2>& p, const Point<2>& q) {
  return incircle(p[0], p[1], p[2], q);
}
inline int in_sphere(const Simplex<3>& p, const Point<3>& q) {
  return insphere(p[0], p[1], p[2], p[3], q);
}

template <int D>
bool lexicographically_before(const Point<D>& a, const Point<D>& b) {
  for (int k = 0; k < D; ++k) {
    if (a[k] != b[k]) return a[k] < b[k];
  }
  return false;
}

// Whether q is inside the sphere through a positively oriented simplex. For a point on it, the D +
// 2 points are visited in descending lexicographic order: on reaching q, it is outside; on reaching
// a vertex whose replacement by q leaves the simplex not flat, the orientation of the result
// decides.
template <int D>
bool counts_as_inside(const Simplex<D>& simplex, const Point<D>& q) {
  const int sign = in_sphere(simplex, q);
  if (sign != 0) return sign > 0;
  std::array<Point<D>, D + 2> visited;
  std::copy(simplex.begin(), simplex.end(), visited.begin());
  visited.back() = q;
  std::sort(visited.begin(), visited.end(),
            [](const auto& a, const auto& b) { return lexicographically_before<D>(b, a); });
  for (const Point<D>& point : visited) {
    if (point == q) return false;
    Simplex<D> replaced = simplex;
    *std::find(replaced.begin(), replaced.end(), point) = q;
    if (const int turn = orient(replaced); turn != 0) return turn > 0;
  }
  return false;
}

// Vertices in ascending order, simplices in ascending order. Of equal points the first represents.
// O(n^(D + 2)).
template <int D>
std::vector<std::array<std::uint32_t, D + 1>> brute_force(const std::vector<Point<D>>& points) {
  std::vector<std::uint32_t> distinct;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (std::find(points.begin(), points.begin() + i, points[i]) == points.begin() + i) {
      distinct.push_back(i);
    }
  }
  std::vector<std::array<std::uint32_t, D + 1>> result;
  std::vector<bool> chosen(distinct.size(), false);
  if (distinct.size() < D + 1) return result;
  std::fill(chosen.begin(), chosen.begin() + D + 1, true);
  do {
    std::array<std::uint32_t, D + 1> rows;
    Simplex<D> simplex;
    std::size_t corners = 0;
    for (std::size_t i = 0; i < distinct.size(); ++i) {
      if (!chosen[i]) continue;
      rows[corners] = distinct[i];
      simplex[corners++] = points[distinct[i]];
    }
    const int turn = orient(simplex);
    if (turn == 0) continue;
    if (turn < 0) std::swap(simplex[0], simplex[1]);
    bool empty = true;
    for (std::size_t i = 0; i < distinct.size() && empty; ++i) {
      empty = chosen[i] || !counts_as_inside<D>(simplex, points[distinct[i]]);
    }
    if (empty) result.push_back(rows);
  } while (std::prev_permutation(chosen.begin(), chosen.end()));
  std::sort(result.begin(), result.end());
  return result;
}

}  // namespace delray::delaunay
