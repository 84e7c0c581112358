// Shares of natural neighbours in numbers of any precision, with a bound of their error.
//
// What a neighbour loses is a sum of signed parts (areas or volumes) between the centres of
// circumscribed circles or spheres. Where simplices are almost flat the centres lie far away and
// the parts, large ones, cancel out. So each centre carries how far off it may be, each part adds
// what that makes of it, and shares count only if all of it together is a small part of the whole.
//
// With a relative error u of each operation and of each difference of two coordinates, in norms
// that are sums of absolute values: a determinant of a, b and c is off by at most 16 u |a| |b| |c|
// (3 u of its factors, 5 for a minor, 5 for the sum of three, and second orders), the numerator of
// a centre by 24 u |a| |b| |c| (|a| + |b| + |c|), and likewise in 2D. Constants are rounded up.
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

#include "delaunay/natural_neighbours.h"

namespace delray::delaunay::internal {

// The error that shares may have, all together, as a part of the whole.
constexpr double kShareError = 0x1p-32;

// u, and whether numbers overflow or underflow; for others than double see natural_shares.cpp.
template <class T>
struct Precision;
template <>
struct Precision<double> {
  static constexpr double kRelative = 0x1p-53;
  // Edges between these lengths leave all products of eight within the range of doubles.
  static bool in_range(double length) { return length > 0x1p-110 && length < 0x1p110; }
};

template <class T>
struct Vector2 {
  T x, y;
};
template <class T>
struct Vector3 {
  T x, y, z;
};

template <class T>
Vector2<T> operator-(const Vector2<T>& a, const Vector2<T>& b) {
  return {a.x - b.x, a.y - b.y};
}
template <class T>
Vector2<T> operator+(const Vector2<T>& a, const Vector2<T>& b) {
  return {a.x + b.x, a.y + b.y};
}
template <class T>
Vector3<T> operator-(const Vector3<T>& a, const Vector3<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T>
Vector3<T> operator+(const Vector3<T>& a, const Vector3<T>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T>
Vector3<T> operator*(const T& s, const Vector3<T>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class T>
T cross(const Vector2<T>& a, const Vector2<T>& b) {
  return a.x * b.y - a.y * b.x;
}
template <class T>
Vector3<T> cross(const Vector3<T>& a, const Vector3<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T>
T dot(const Vector3<T>& a, const Vector3<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
T norm(const Vector2<T>& a) {
  using std::abs;
  return abs(a.x) + abs(a.y);
}
template <class T>
T norm(const Vector3<T>& a) {
  using std::abs;
  return abs(a.x) + abs(a.y) + abs(a.z);
}

// In double, a difference of coordinates is off by u of itself.
template <class T>
Vector2<T> to_vector(const glm::dvec2& p) {
  return {T(p.x), T(p.y)};
}
template <class T>
Vector3<T> to_vector(const glm::dvec3& p) {
  return {T(p.x), T(p.y), T(p.z)};
}

// The middle of a circle or sphere, as seen from q; `error` is negative where it is not known.
template <class Vector, class T>
struct Centre {
  Vector at;
  T error;
  bool known() const { return error >= 0; }
};

// The circle through three points: `at` as they are, of which q is subtracted.
template <class T>
Centre<Vector2<T>, T> centre_of(const std::array<Vector2<T>, 3>& at, const Vector2<T>& q) {
  using std::abs;
  const Vector2<T> a = at[1] - at[0], b = at[2] - at[0], p = at[0] - q;
  const T kU = Precision<T>::kRelative, la = norm(a), lb = norm(b);
  const T determinant = cross(a, b), product = la * lb, off = T(12) * kU * product;
  if (!Precision<T>::in_range(la) || !Precision<T>::in_range(lb) ||
      !(abs(determinant) > T(2) * off)) {
    return {p, T(-1)};
  }
  const T aa = a.x * a.x + a.y * a.y, bb = b.x * b.x + b.y * b.y;
  const Vector2<T> sum = {b.y * aa - a.y * bb, a.x * bb - b.x * aa};
  const T scale = T(1) / (T(2) * determinant);
  const Vector2<T> h = {scale * sum.x, scale * sum.y};
  const T error = (T(20) * kU * product * (la + lb) + T(2) * norm(h) * off) /
                      (T(2) * (abs(determinant) - off)) +
                  T(6) * kU * (norm(h) + norm(p));
  return {p + h, error};
}

// The sphere through four points.
template <class T>
Centre<Vector3<T>, T> centre_of(const std::array<Vector3<T>, 4>& at, const Vector3<T>& q) {
  using std::abs;
  const Vector3<T> a = at[1] - at[0], b = at[2] - at[0], c = at[3] - at[0], p = at[0] - q;
  const T kU = Precision<T>::kRelative, la = norm(a), lb = norm(b), lc = norm(c);
  const Vector3<T> bc = cross(b, c);
  const T determinant = dot(a, bc), product = la * lb * lc, off = T(16) * kU * product;
  if (!Precision<T>::in_range(la) || !Precision<T>::in_range(lb) || !Precision<T>::in_range(lc) ||
      !(abs(determinant) > T(2) * off)) {
    return {p, T(-1)};
  }
  const Vector3<T> sum = dot(a, a) * bc + dot(b, b) * cross(c, a) + dot(c, c) * cross(a, b);
  const Vector3<T> h = (T(1) / (T(2) * determinant)) * sum;
  const T error = (T(24) * kU * product * (la + lb + lc) + T(2) * norm(h) * off) /
                      (T(2) * (abs(determinant) - off)) +
                  T(6) * kU * (norm(h) + norm(p));
  return {p + h, error};
}

// Parts of what neighbours lose.
template <class T>
class Shares {
 public:
  // `error`: that of the part, before it is rounded.
  void add(std::uint32_t row, const T& part, const T& error) {
    using std::abs;
    parts_.emplace_back(row, part);
    error_ += error;
    absolute_ += abs(part);
  }

  // Their sums, as shares of the whole; none where they are not precise enough. No share is
  // negative in truth, so that taking those that are for zero does not add to the error.
  std::optional<std::vector<NaturalNeighbour>> normalized() && {
    std::ranges::stable_sort(parts_, {}, [](const auto& part) { return part.first; });
    std::vector<std::pair<std::uint32_t, T>> sums;
    T whole = 0;
    for (auto& [row, part] : parts_) {
      if (sums.empty() || sums.back().first != row) {
        sums.emplace_back(row, part);
      } else {
        sums.back().second += part;
      }
      whole += part;
    }
    error_ += T(Precision<T>::kRelative) * T(static_cast<double>(parts_.size() + 2)) * absolute_;
    if (!(whole > 0 && error_ <= T(kShareError) * whole)) return std::nullopt;
    std::vector<NaturalNeighbour> shares;
    double sum = 0;
    for (auto& [row, part] : sums) {
      shares.push_back({row, std::max(0.0, static_cast<double>(T(part / whole)))});
      sum += shares.back().weight;
    }
    for (NaturalNeighbour& share : shares) share.weight /= sum;
    return shares;
  }

 private:
  std::vector<std::pair<std::uint32_t, T>> parts_;
  T error_ = 0, absolute_ = 0;
};

using SharesFound = std::optional<std::vector<NaturalNeighbour>>;

// Of triangles whose circles hold q, in the plane or in one of space. Sides are their edges that
// are no other's.
template <class T>
struct Triangle {
  std::array<std::uint32_t, 3> rows;
  std::array<Vector2<T>, 3> at;  // counterclockwise
};

// What a neighbour loses is a polygon about it: from the centre of q and an edge of the cavity that
// leaves it, over those of the triangles there, to that of q and the edge that enters it.
//
// REQUIRES: q is on the line of no side.
template <class T>
SharesFound shares_of_area(const std::vector<Triangle<T>>& cavity, const Vector2<T>& q) {
  using Middle = Centre<Vector2<T>, T>;
  struct Edge {
    std::uint32_t start, end;
    Middle centre;  // of the triangle on its left; of a side: of that with q
  };
  const auto ends = [](const Edge& edge) { return std::pair(edge.start, edge.end); };
  std::vector<Edge> edges, sides;
  for (const Triangle<T>& t : cavity) {
    const Middle centre = centre_of(t.at, q);
    if (!centre.known()) return std::nullopt;
    for (std::size_t k = 0; k < 3; ++k) edges.push_back({t.rows[k], t.rows[(k + 1) % 3], centre});
  }
  std::vector<Edge> sorted = edges;
  std::ranges::sort(sorted, {}, ends);
  Shares<T> shares;
  const auto add = [&](std::uint32_t row, const Middle& from, const Middle& to) {
    const T a = norm(from.at), b = norm(to.at);
    shares.add(row, cross(from.at, to.at),
               a * to.error + b * from.error + from.error * to.error +
                   T(4) * T(Precision<T>::kRelative) * a * b);
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
  return std::move(shares).normalized();
}

// Of tetrahedra whose spheres hold q.
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

// What a neighbour i loses is a polyhedron. Each of its faces lies half-way between i and a point
// j, another neighbour or q, and its edges are between the centres of tetrahedra that follow each
// other around the edge from i to j. So its volume is a sum of cones with the apex i over triangles
// of two centres and the middle of i and j: those of the tetrahedra in the cavity, less those of
// the tetrahedra that would replace them.
//
// REQUIRES: none of the sides is in a plane with q.
template <class T>
SharesFound shares_of_volume(const std::vector<Tetrahedron>& cavity, const glm::dvec3& place) {
  using Middle = Centre<Vector3<T>, T>;
  const Vector3<T> q = to_vector<T>(place);
  struct Place {
    std::uint32_t row;
    Vector3<T> p;  // as seen from q
  };
  Shares<T> shares;
  const T kU = Precision<T>::kRelative;
  const auto add_cone = [&](const Place& i, const Place& j, const Middle& from, const Middle& to,
                            int sign) {
    const Vector3<T> middle = T(0.5) * (i.p + j.p), axis = j.p - i.p;
    const Vector3<T> f = from.at - middle, t = to.at - middle;
    const T far = norm(i.p) + norm(j.p), lf = norm(f), lt = norm(t), length = norm(axis);
    const T from_off = from.error + T(3) * kU * (far + norm(from.at));
    const T to_off = to.error + T(3) * kU * (far + norm(to.at));
    const T volume = dot(axis, cross(f, t));
    shares.add(i.row, sign > 0 ? volume : T(-volume),
               length * (lf * to_off + lt * from_off + from_off * to_off) +
                   T(16) * kU * (length + far) * lf * lt);
  };
  // A tetrahedron of q and a side, by one of its edges.
  struct NewEdge {
    Place start, end;
    Middle centre;
  };
  struct Corners {
    std::array<Vector3<T>, 4> at;
    std::array<Place, 4> places;
    Middle centre;
  };
  std::vector<Corners> corners;
  corners.reserve(cavity.size());
  for (const Tetrahedron& t : cavity) {
    Corners& own = corners.emplace_back();
    for (std::size_t k = 0; k < 4; ++k) {
      own.at[k] = to_vector<T>(t.at[k]);
      own.places[k] = {t.rows[k], own.at[k] - q};
    }
    own.centre = centre_of(own.at, q);
    if (!own.centre.known()) return std::nullopt;
  }
  std::vector<NewEdge> edges;
  for (std::size_t number = 0; number < cavity.size(); ++number) {
    const Tetrahedron& t = cavity[number];
    const Corners& own = corners[number];
    for (std::size_t k = 0; k < 4; ++k) {
      const auto& facet = kFacets[k];
      const Middle other =
          t.is_side(k) ? centre_of({own.at[facet[0]], own.at[facet[1]], own.at[facet[2]], q}, q)
                       : corners[t.beyond[k]].centre;
      if (!other.known()) return std::nullopt;
      for (std::size_t i = 0; i < 3; ++i) {
        const Place &start = own.places[facet[i]], &end = own.places[facet[(i + 1) % 3]];
        add_cone(start, end, other, own.centre, 1);
        if (!t.is_side(k)) continue;
        add_cone(end, start, own.centre, other, 1);
        edges.push_back({end, start, other});
      }
    }
  }
  std::vector<std::size_t> order(edges.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  const auto key = [&](std::size_t i) { return std::pair(edges[i].start.row, edges[i].end.row); };
  std::ranges::sort(order, {}, key);
  const Place origin = {0, {T(0), T(0), T(0)}};
  for (const std::size_t i : order) {
    const NewEdge& edge = edges[i];
    const NewEdge& twin =
        edges[*std::ranges::lower_bound(order, std::pair(edge.end.row, edge.start.row), {}, key)];
    // Around its edge from `start` to `end` the tetrahedron follows its twin, and so it does from
    // `end` to q.
    add_cone(edge.start, edge.end, twin.centre, edge.centre, -1);
    add_cone(edge.end, origin, twin.centre, edge.centre, -1);
  }
  return std::move(shares).normalized();
}

// A triangle of a plane of space.
struct SpaceTriangle {
  std::array<std::uint32_t, 3> rows;
  std::array<glm::dvec3, 3> at;
};

// The same in numbers as wide as it takes.
std::vector<NaturalNeighbour> wide_shares_of_area(const std::vector<Triangle<double>>& cavity,
                                                  const glm::dvec2& q);
std::vector<NaturalNeighbour> wide_shares_of_volume(const std::vector<Tetrahedron>& cavity,
                                                    const glm::dvec3& q);
// Of triangles that lie in the plane of three points, counterclockwise as these are.
std::vector<NaturalNeighbour> wide_shares_in_plane(const std::vector<SpaceTriangle>& cavity,
                                                   const std::array<glm::dvec3, 3>& plane,
                                                   const glm::dvec3& q);

}  // namespace delray::delaunay::internal
