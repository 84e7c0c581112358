// Shares of natural neighbours in numbers of any precision, with a bound of their error.
//
// The area or volume that a neighbour loses to the point is a sum of signed parts (areas or
// volumes) between the centres of circumscribed circles or spheres. Where simplices are almost flat
// the centres lie far away and the parts, large ones, cancel out. So each centre carries how far
// off it may be, each part adds what that makes of it, and shares count only if all of it together
// is a small part of the whole.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "delaunay/interpolate.h"
#include "delaunay/mesh/edge_pairs.h"
#include "delaunay/predicates/circumcentres.h"

namespace delray::delaunay::internal {

// The error that shares may have, all together, as a part of the whole.
constexpr double kShareError = 0x1p-32;

using SharesFound = std::optional<std::vector<NaturalNeighbour>>;

// The corners of simplices, ascending: neighbour i is the vertex of row `rows[i]`.
template <class Simplex>
std::vector<std::uint32_t> rows_of(const std::vector<Simplex>& cavity) {
  std::vector<std::uint32_t> rows;
  rows.reserve(cavity.size() * cavity.front().rows.size());
  for (const Simplex& simplex : cavity) {
    rows.insert(rows.end(), simplex.rows.begin(), simplex.rows.end());
  }
  std::ranges::sort(rows);
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  return rows;
}

inline std::uint32_t number_of(const std::vector<std::uint32_t>& rows, std::uint32_t row) {
  return static_cast<std::uint32_t>(std::ranges::lower_bound(rows, row) - rows.begin());
}

// A part of what neighbours lose, and how far off it is before it is rounded.
template <class T>
struct Loss {
  T size, error;
};

// Sums of what neighbours lose.
template <class T>
class Shares {
 public:
  explicit Shares(std::size_t neighbours) : sums_(neighbours, T(0)) {}

  void add(std::size_t neighbour, const Loss<T>& part) {
    using std::abs;
    sums_[neighbour] += part.size;
    error_ += part.error;
    absolute_ += abs(part.size);
    ++parts_;
  }

  // As shares of the whole; none where they are not precise enough. No share is negative in truth,
  // so that taking those that are for zero does not add to the error.
  SharesFound normalized(const std::vector<std::uint32_t>& rows) const {
    T whole = 0;
    for (const T& lost : sums_) whole += lost;
    const T rounded = T(Precision<T>::kRelative) * T(static_cast<double>(parts_ + 2)) * absolute_;
    if (!(whole > 0 && error_ + rounded <= T(kShareError) * whole)) return std::nullopt;
    std::vector<NaturalNeighbour> shares;
    shares.reserve(rows.size());
    double sum = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      shares.push_back({rows[i], std::max(0.0, static_cast<double>(T(sums_[i] / whole)))});
      sum += shares.back().weight;
    }
    for (NaturalNeighbour& share : shares) share.weight /= sum;
    return shares;
  }

 private:
  std::vector<T> sums_;
  T error_ = 0, absolute_ = 0;
  std::size_t parts_ = 0;
};

// A triangle whose circle holds q, in the plane or in one of space. Sides are edges of one triangle
// that are no other's.
template <class T>
struct Triangle {
  std::array<std::uint32_t, 3> rows;
  std::array<Vector2<T>, 3> at;  // counterclockwise
};

// The area that a neighbour loses is a polygon about it: from the centre of q and an edge of the
// cavity that leaves it, over those of the triangles there, to that of q and the edge that enters
// it.
//
// REQUIRES: q is on the line of no side.
template <class T>
SharesFound shares_of_area(const std::vector<Triangle<T>>& cavity, const Vector2<T>& q) {
  using Middle = Centre<Vector2<T>, T>;
  struct Edge {
    std::uint32_t start, end;  // neighbours
    Middle centre;             // of the triangle on its left; of a side: of that with q
  };
  const auto ends = [](const Edge& edge) { return std::pair(edge.start, edge.end); };
  const std::vector<std::uint32_t> rows = rows_of(cavity);
  std::vector<Edge> edges, sides;
  for (const Triangle<T>& t : cavity) {
    const Middle centre = centre_of(t.at, q);
    if (!centre.known()) return std::nullopt;
    std::array<std::uint32_t, 3> numbers;
    for (std::size_t k = 0; k < 3; ++k) numbers[k] = number_of(rows, t.rows[k]);
    for (std::size_t k = 0; k < 3; ++k) edges.push_back({numbers[k], numbers[(k + 1) % 3], centre});
  }
  std::vector<Edge> sorted = edges;
  std::ranges::sort(sorted, {}, ends);
  Shares<T> shares(rows.size());
  const auto add = [&](std::uint32_t neighbour, const Middle& from, const Middle& to) {
    const T a = norm(from.at), b = norm(to.at);
    const T error = a * to.error + b * from.error + from.error * to.error;
    shares.add(neighbour,
               {cross(from.at, to.at), error + T(4) * T(Precision<T>::kRelative) * a * b});
  };
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Edge& edge = edges[i];
    const auto twin = std::ranges::lower_bound(sorted, std::pair(edge.end, edge.start), {}, ends);
    if (twin != sorted.end() && ends(*twin) == std::pair(edge.end, edge.start)) {
      add(edge.start, twin->centre, edge.centre);
      continue;
    }
    const Triangle<T>& t = cavity[i / 3];
    const Middle outer = centre_of({q, t.at[i % 3], t.at[(i + 1) % 3]}, q);
    if (!outer.known()) return std::nullopt;
    add(edge.start, outer, edge.centre);
    add(edge.end, edge.centre, outer);
    sides.push_back({edge.start, edge.end, outer});
  }
  std::ranges::sort(sides, {}, ends);
  for (const Edge& entering : sides) {
    const Edge& leaving = *std::ranges::lower_bound(sides, entering.end, {}, &Edge::start);
    add(entering.end, entering.centre, leaving.centre);
  }
  return shares.normalized(rows);
}

// A tetrahedron whose sphere holds q.
struct Tetrahedron {
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  std::array<std::uint32_t, 4> rows;
  std::array<glm::dvec3, 4> at;  // positively oriented
  // Which of the cavity lies beyond the facet opposite to a vertex; kNone for a side of the cavity.
  std::array<std::size_t, 4> beyond;

  bool is_side(std::size_t k) const { return beyond[k] == kNone; }
};

// For each corner of a tetrahedron the three others, such that with it they are an even
// permutation.
constexpr std::array<std::array<std::size_t, 3>, 4> kFacets = {
    {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}}};

// The two tetrahedra of q and a side that share one of the side's edges.
struct EdgeOfSides {
  std::uint32_t start, end;  // as they follow each other around the first side
  std::size_t first, second;
};

// The edges of the sides of a cavity, by their corners. O(n log n).
inline std::vector<EdgeOfSides> edges_of(const std::vector<std::array<std::uint32_t, 3>>& sides) {
  EdgePairs<std::size_t> pairs(3 * sides.size());
  for (std::size_t i = 0; i < sides.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) pairs.add(sides[i][k], sides[i][(k + 1) % 3], 3 * i + k);
  }
  std::vector<EdgeOfSides> edges;
  edges.reserve(3 * sides.size() / 2);
  pairs.for_each([&](std::size_t first, std::size_t second) {
    const auto& side = sides[first / 3];
    edges.push_back({side[first % 3], side[(first + 1) % 3], first / 3, second / 3});
  });
  return edges;
}

// The volume that a neighbour i loses is a polyhedron. Each of its faces lies half-way between i
// and a point j, another neighbour or q, and its edges are between the centres of tetrahedra that
// follow each other around the edge from i to j. So its volume is a sum of cones with the apex i
// over triangles of two centres and the middle of i and j: those of the tetrahedra in the cavity,
// less those of the tetrahedra that would replace them. A cone with the apex j over the same
// triangle has the same volume, as part of what j loses.
//
// REQUIRES: none of the sides is in a plane with q.
template <class T>
class SharesOfVolume {
 public:
  SharesOfVolume(const std::vector<Tetrahedron>& cavity, const glm::dvec3& q)
      : cavity_(cavity), q_(to_vector<T>(q)), rows_(rows_of(cavity)), shares_(rows_.size()) {}

  SharesFound compute() {
    find_corners();
    if (!find_centres()) return std::nullopt;
    add_cavity();
    subtract_new();
    return shares_.normalized(rows_);
  }

 private:
  using Middle = Centre<Vector3<T>, T>;
  struct Corner {
    Vector3<T> at, from_q;
    T far;  // norm(from_q)
  };

  void find_corners() {
    corners_.resize(rows_.size());
    numbers_.resize(cavity_.size());
    for (std::size_t t = 0; t < cavity_.size(); ++t) {
      for (std::size_t k = 0; k < 4; ++k) {
        const std::uint32_t number = numbers_[t][k] = number_of(rows_, cavity_[t].rows[k]);
        const Vector3<T> at = to_vector<T>(cavity_[t].at[k]);
        corners_[number] = {at, at - q_, norm(at - q_)};
      }
    }
  }

  // Centres of all tetrahedra of the cavity, and of all that q makes with a side.
  bool find_centres() {
    for (std::size_t t = 0; t < cavity_.size(); ++t) {
      const auto& n = numbers_[t];
      const auto at = [&](std::size_t k) { return corners_[n[k]].at; };
      centres_.push_back(centre_of<T>({at(0), at(1), at(2), at(3)}, q_));
      if (!centres_.back().known()) return false;
      for (std::size_t k = 0; k < 4; ++k) {
        if (!cavity_[t].is_side(k)) continue;
        const auto& facet = kFacets[k];
        new_centres_.push_back(centre_of<T>({at(facet[0]), at(facet[1]), at(facet[2]), q_}, q_));
        if (!new_centres_.back().known()) return false;
        sides_.push_back({n[facet[0]], n[facet[1]], n[facet[2]]});
      }
    }
    return true;
  }

  void add_cavity() {
    std::size_t side = 0;
    for (std::size_t t = 0; t < cavity_.size(); ++t) {
      for (std::size_t k = 0; k < 4; ++k) {
        const std::size_t beyond = cavity_[t].beyond[k];
        if (!cavity_[t].is_side(k) && beyond < t) continue;
        const Middle& other = cavity_[t].is_side(k) ? new_centres_[side++] : centres_[beyond];
        for (std::size_t i = 0; i < 3; ++i) {
          const std::uint32_t start = numbers_[t][kFacets[k][i]];
          const std::uint32_t end = numbers_[t][kFacets[k][(i + 1) % 3]];
          const Loss<T> part = cone(corners_[start], corners_[end], other, centres_[t]);
          shares_.add(start, part);
          shares_.add(end, part);
        }
      }
    }
  }

  void subtract_new() {
    const Corner origin = {q_, {T(0), T(0), T(0)}, T(0)};
    for (const EdgeOfSides& edge : edges_of(sides_)) {
      const Corner &start = corners_[edge.start], &end = corners_[edge.end];
      const Middle &first = new_centres_[edge.first], &second = new_centres_[edge.second];
      // Around the edge from `end` to `start` the first tetrahedron follows the second, and so it
      // does from `start` to q.
      const Loss<T> between = cone(end, start, first, second);
      shares_.add(edge.start, between);
      shares_.add(edge.end, between);
      shares_.add(edge.start, cone(start, origin, first, second));
      shares_.add(edge.end, cone(end, origin, second, first));
    }
  }

  Loss<T> cone(const Corner& i, const Corner& j, const Middle& from, const Middle& to) const {
    const T kU = Precision<T>::kRelative;
    const Vector3<T> middle = T(0.5) * (i.from_q + j.from_q), axis = j.from_q - i.from_q;
    const Vector3<T> f = from.at - middle, t = to.at - middle;
    const T far = i.far + j.far, lf = norm(f), lt = norm(t), length = norm(axis);
    const T from_off = from.error + T(3) * kU * (far + norm(from.at));
    const T to_off = to.error + T(3) * kU * (far + norm(to.at));
    const T off = length * (lf * to_off + lt * from_off + from_off * to_off);
    return {dot(axis, cross(f, t)), off + T(16) * kU * (length + far) * lf * lt};
  }

  const std::vector<Tetrahedron>& cavity_;
  const Vector3<T> q_;
  const std::vector<std::uint32_t> rows_;
  std::vector<Corner> corners_;                        // of neighbour i
  std::vector<std::array<std::uint32_t, 4>> numbers_;  // of tetrahedron i: its corners
  std::vector<Middle> centres_;
  std::vector<std::array<std::uint32_t, 3>> sides_;  // by facets of tetrahedra, in their order
  std::vector<Middle> new_centres_;                  // of q and side i
  Shares<T> shares_;
};

template <class T>
SharesFound shares_of_volume(const std::vector<Tetrahedron>& cavity, const glm::dvec3& q) {
  return SharesOfVolume<T>(cavity, q).compute();
}

// A triangle of a plane of space.
struct SpaceTriangle {
  std::array<std::uint32_t, 3> rows;
  std::array<glm::dvec3, 3> at;
};

// Shares computed in numbers as wide as it takes.
std::vector<NaturalNeighbour> wide_shares_of_area(const std::vector<Triangle<double>>& cavity,
                                                  const glm::dvec2& q);
std::vector<NaturalNeighbour> wide_shares_of_volume(const std::vector<Tetrahedron>& cavity,
                                                    const glm::dvec3& q);
// Triangles lie in the plane of three points, counterclockwise as these are.
std::vector<NaturalNeighbour> wide_shares_in_plane(const std::vector<SpaceTriangle>& cavity,
                                                   const std::array<glm::dvec3, 3>& plane,
                                                   const glm::dvec3& q);

}  // namespace delray::delaunay::internal
