// With s across the line and t along it, relative to the third point, the lift of a point is
// w = (s - place)^2 - (s_c - place)^2 + t^2, and the turn is the sign of t_a w_b - t_b w_a; that
// t^2 is relative, too, adds a function linear in t, which turns nothing.
//
// The filter: differences of doubles are off by one rounding each, so that a square is by 3, w by 5
// of the sum of its absolute terms, and the determinant by 8 (Higham 2002, chapter 3). Beyond it
// integers of any size decide: there are few such calls, but for lattices.
#include "delaunay/distributed/dividing_path.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <unordered_set>

#include "comm/agree_on_failure.h"
#include "comm/collectives.h"
#include "delaunay/predicates.h"
#include "delaunay/predicates/as_integers.h"
#include "delaunay/predicates/conflict.h"

namespace delray::delaunay {
namespace {

using internal::as_integers, internal::Integer;

constexpr double kTurnError = 10 * internal::kRoundOff;

int exact_turn(const CutLine& line, const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  const int s = line.axis, t = 1 - s;
  const auto n = as_integers<7>({a[s], b[s], c[s], line.place, a[t], b[t], c[t]});
  const Integer pa = n[0] - n[3], pb = n[1] - n[3], pc = n[2] - n[3];
  const Integer qa = n[4] - n[6], qb = n[5] - n[6];
  const Integer wa = pa * pa - pc * pc + qa * qa, wb = pb * pb - pc * pc + qb * qb;
  const Integer turn = qa * wb - qb * wa;
  return turn.sign();
}

// Points as the hull and a set see them: by place.
bool is_before(const CutLine& line, const RowPoint& a, const RowPoint& b) {
  const int s = line.axis, t = 1 - s;
  if (a.position[t] != b.position[t]) return a.position[t] < b.position[t];
  if (a.position[s] == b.position[s]) return a.row < b.row;
  return is_lifted_less(line, glm::dvec2(a.position), glm::dvec2(b.position));
}

}  // namespace

int projected_turn(const CutLine& line, const glm::dvec2& a, const glm::dvec2& b,
                   const glm::dvec2& c) {
  const int s = line.axis, t = 1 - s;
  const double pa = a[s] - line.place, pb = b[s] - line.place, pc = c[s] - line.place;
  const double qa = a[t] - c[t], qb = b[t] - c[t];
  const double determinant =
      qa * (pb * pb - pc * pc + qb * qb) - qb * (pa * pa - pc * pc + qa * qa);
  const double error = kTurnError * (std::abs(qa) * (pb * pb + pc * pc + qb * qb) +
                                     std::abs(qb) * (pa * pa + pc * pc + qa * qa)) +
                       internal::kUnderflow * (1 + std::abs(qa) + std::abs(qb));
  if (determinant > error) return 1;
  if (-determinant > error) return -1;
  if (const int sign = exact_turn(line, a, b, c); sign != 0) return sign;

  // The point that is last in lexicographic order is raised most; how much that turns is how far
  // the other two are apart along the line.
  struct Raised {
    const glm::dvec2* point;
    int turn;
  };
  const auto sign_of = [](double x, double y) { return x > y ? 1 : x < y ? -1 : 0; };
  std::array<Raised, 3> raised = {
      {{&a, sign_of(c[t], b[t])}, {&b, sign_of(a[t], c[t])}, {&c, sign_of(b[t], a[t])}}};
  std::ranges::sort(raised, [](const Raised& x, const Raised& y) {
    return lexicographically_less(*y.point, *x.point);
  });
  for (const Raised& each : raised) {
    if (each.turn != 0) return each.turn;
  }
  return 0;
}

bool is_lifted_less(const CutLine& line, const glm::dvec2& a, const glm::dvec2& b) {
  const int s = line.axis;
  const double pa = a[s] - line.place, pb = b[s] - line.place;
  const double difference = std::abs(pa) - std::abs(pb);
  const double error = 4 * internal::kRoundOff * (std::abs(pa) + std::abs(pb));
  if (difference > error) return false;
  if (-difference > error) return true;
  const auto n = as_integers<3>({a[s], b[s], line.place});
  const Integer exact = abs(Integer(n[0] - n[2])) - abs(Integer(n[1] - n[2]));
  return exact.sign() != 0 ? exact.sign() < 0 : lexicographically_less(a, b);
}

std::vector<RowPoint> lower_hull(const CutLine& line, std::vector<RowPoint> points) {
  std::ranges::sort(points,
                    [&](const RowPoint& a, const RowPoint& b) { return is_before(line, a, b); });
  std::vector<RowPoint> hull;
  const int t = 1 - line.axis;
  for (const RowPoint& point : points) {
    // The first of those with one coordinate along the line is the lowest.
    if (!hull.empty() && hull.back().position[t] == point.position[t]) continue;
    while (hull.size() >= 2 &&
           projected_turn(line, glm::dvec2(hull[hull.size() - 2].position),
                          glm::dvec2(hull.back().position), glm::dvec2(point.position)) <= 0) {
      hull.pop_back();
    }
    hull.push_back(point);
  }
  return hull;
}

int DividingPath::side_of_edge(const glm::dvec3& low, const glm::dvec3& high,
                               const glm::dvec3& p) const {
  const int left = orient2d(glm::dvec2(low), glm::dvec2(high), glm::dvec2(p));
  return line_.axis == 0 ? -left : left;
}

int DividingPath::side_of(const glm::dvec3& position) const {
  const int s = line_.axis;
  const auto next = std::ranges::upper_bound(vertices_, along(position), {},
                                             [&](const RowPoint& v) { return along(v.position); });
  if (next == vertices_.begin()) return -1;  // not of those points
  const glm::dvec3& at = (next - 1)->position;
  if (along(at) == along(position) || next == vertices_.end()) {
    return position[s] < at[s] ? -1 : position[s] > at[s] ? 1 : 0;
  }
  return side_of_edge(at, next->position, position);
}

int DividingPath::side_of(const RowPoint& a, const RowPoint& b, const RowPoint& c) const {
  std::array<const glm::dvec3*, 3> corners = {&a.position, &b.position, &c.position};
  for (const glm::dvec3* corner : corners) {
    if (const int side = side_of(*corner); side != 0) return side;
  }
  // The path comes from the first to the second to the third along the line, the edge from the
  // first to the third passes the second on the triangle's side.
  std::ranges::sort(corners, {}, [&](const glm::dvec3* p) { return along(*p); });
  return -side_of_edge(*corners[0], *corners[2], *corners[1]);
}

std::vector<std::uint32_t> triangles_between(std::span<const RowPoint> points,
                                             std::span<const DividingPath> paths,
                                             std::span<const int> sides, const Options& options) {
  const PointView<double> positions{reinterpret_cast<const std::byte*>(points.data()),
                                    points.size(), sizeof(RowPoint)};
  const Triangulation all = triangulate(positions, options).triangulation;
  std::vector<std::uint32_t> kept;
  for (std::size_t i = 0; i < all.vertices.size(); i += 3) {
    const auto triangle = std::span<const std::uint32_t>(all.vertices).subspan(i, 3);
    bool is_between = true;
    for (std::size_t k = paths.size(); is_between && k > 0; --k) {
      is_between = paths[k - 1].side_of(points[triangle[0]], points[triangle[1]],
                                        points[triangle[2]]) == sides[k - 1];
    }
    if (is_between) kept.insert(kept.end(), triangle.begin(), triangle.end());
  }
  return kept;
}

DistributedTriangulation triangulate_between(comm::Communicator& communicator,
                                             std::span<const RowPoint> points,
                                             std::span<const DividingPath> paths,
                                             std::span<const int> sides, const Options& options) {
  DistributedTriangulation whole;
  TiledTriangulation& result = whole.part;
  std::vector<bool> is_on_path(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    bool counts = true;
    for (std::size_t k = 0; k < paths.size(); ++k) {
      if (paths[k].side_of(points[i].position) != 0) continue;
      is_on_path[i] = true;
      counts = counts && sides[k] < 0;
    }
    result.distinct += counts ? 1 : 0;
  }
  comm::all_or_none(communicator, comm::Phase::other, [&] {
    const auto kept = triangles_between(points, paths, sides, options);
    for (const std::uint32_t i : kept) result.vertices.push_back(points[i].row);
    for (std::size_t i = 0; i < kept.size(); i += 3) {
      const bool is_shared =
          is_on_path[kept[i]] || is_on_path[kept[i + 1]] || is_on_path[kept[i + 2]];
      whole.statistics.shared_simplices += is_shared ? 1 : 0;
    }
  });
  std::uint64_t all[] = {result.distinct, result.vertices.size() / 3};
  comm::all_reduce(communicator, std::span<std::uint64_t>(all), std::plus<>());
  // By Euler's formula, as no rank sees both sides of every edge.
  if (communicator.rank() == 0 && all[1] > 0) result.hull_facets = 2 * all[0] - 2 - all[1];
  return whole;
}

}  // namespace delray::delaunay
