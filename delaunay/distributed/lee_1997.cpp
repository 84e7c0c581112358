// Edges in rounds (Lee 1997; Kohout 2004, 5.1.2): every rank knows all points and has some of them.
// It finds the nearest point to each of its own; rank 0 collects these edges, drops those that it
// has had, and shares the rest out. A rank makes the triangles on both sides of the edges that it
// gets, whose other edges go back to rank 0, until there are no new ones.
//
// The edge to the nearest point is Delaunay: the circle with it as diameter holds no other point,
// nor one on it, so that no tie is to be broken. Every edge is given to one rank once, and a
// triangle is kept by the rank of the least of its edges. In the plane only: an edge has two sides.
// All points on all ranks, 3 n edges through rank 0, rounds as many as edges that a way across the
// points crosses.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <span>
#include <unordered_set>
#include <utility>
#include <vector>

#include "comm/agree_on_failure.h"
#include "comm/collectives.h"
#include "delaunay/construction/apex_search.h"
#include "delaunay/distributed/areas.h"
#include "delaunay/distributed/method_sources.h"
#include "delaunay/insertion/first_triangle.h"
#include "delaunay/insertion/insertion_order.h"
#include "delaunay/mesh/mesh.h"
#include "delaunay/predicates.h"
#include "delaunay/predicates/as_integers.h"
#include "delaunay/tiles/box_tree.h"

namespace delray::delaunay {
namespace {

// Numbers of points, the lower one first.
using Edge = std::array<VertexNumber, 2>;

Edge edge_between(VertexNumber a, VertexNumber b) { return {std::min(a, b), std::max(a, b)}; }
std::uint64_t key_of(const Edge& edge) { return std::uint64_t{edge[0]} << 32 | edge[1]; }

// Whether a is nearer to v than b is. Exact.
bool is_nearer(const glm::dvec2& v, const glm::dvec2& a, const glm::dvec2& b) {
  const glm::dvec2 to_a = a - v, to_b = b - v;
  const double first = glm::dot(to_a, to_a), second = glm::dot(to_b, to_b);
  // A difference, a product and a sum each: 4 roundings, doubled.
  constexpr double kRoom = 8 * internal::kRoundOff;
  const double error = kRoom * (first + second) + internal::kUnderflow;
  if (first < second - error) return true;
  if (second < first - error) return false;
  const auto n = internal::as_integers(std::array<double, 6>{v.x, v.y, a.x, a.y, b.x, b.y});
  const auto square = [&](std::size_t i) {
    const internal::Integer x = n[i] - n[0], y = n[i + 1] - n[1];
    return internal::Integer(x * x + y * y);
  };
  return square(2) < square(4);
}

// The points of all ranks, numbered alike on all, neighbours near each other.
class AllPoints {
 public:
  // Collective.
  AllPoints(comm::Communicator& communicator, std::span<const RowPoint> points)
      : points_(gathered(communicator, points)), search_(positions()), runs_(boxes()) {}

  VertexNumber size() const { return static_cast<VertexNumber>(points_.size()); }
  const glm::dvec2& at(VertexNumber v) const { return search_.points()[v]; }
  std::uint64_t row(VertexNumber v) const { return points_[v].row; }
  std::span<const glm::dvec2> places() const { return search_.points(); }

  // REQUIRES: there are two points.
  VertexNumber nearest(VertexNumber v) const {
    VertexNumber best = v > 0 ? v - 1 : 1;
    const auto reach = [&] { return std::hypot(at(best).x - at(v).x, at(best).y - at(v).y); };
    double within = reach() * (1 + 0x1p-50);
    runs_.find(
        [&](const geometry::Box<glm::dvec2>& box) {
          const glm::dvec2 away = glm::max(box.low - at(v), at(v) - box.high);
          return std::max(away.x, away.y) <= within;
        },
        [&](std::uint32_t run) {
          for (VertexNumber p = run * kBucket; p < std::min(size(), (run + 1) * kBucket); ++p) {
            if (p == v || p == best || !is_nearer(at(v), at(p), at(best))) continue;
            best = p;
            within = reach() * (1 + 0x1p-50);
          }
        });
    return best;
  }

  // The apex to the left of the way from a to b.
  std::optional<VertexNumber> apex(VertexNumber a, VertexNumber b) const {
    return search_.find({at(a), at(b)});
  }

 private:
  static constexpr VertexNumber kBucket = 8;

  static std::vector<RowPoint> gathered(comm::Communicator& communicator,
                                        std::span<const RowPoint> own) {
    std::vector<RowPoint> all;
    for (const comm::Buffer& each : comm::all_gather(communicator, comm::Buffer::of(own))) {
      const auto some = each.as<RowPoint>();
      all.insert(all.end(), some.begin(), some.end());
    }
    all = distinct_points(std::move(all), 2);
    std::vector<glm::dvec2> places;
    for (const RowPoint& point : all) places.emplace_back(point.position);
    std::vector<RowPoint> ordered;
    for (const std::uint32_t i :
         insertion_order(std::span<const glm::dvec2>(places), "hilbert", 1)) {
      ordered.push_back(all[i]);
    }
    return ordered;
  }
  std::vector<glm::dvec2> positions() const {
    std::vector<glm::dvec2> result;
    for (const RowPoint& point : points_) result.emplace_back(point.position);
    return result;
  }
  std::vector<geometry::Box<glm::dvec2>> boxes() const {
    std::vector<geometry::Box<glm::dvec2>> result((points_.size() + kBucket - 1) / kBucket);
    for (VertexNumber v = 0; v < points_.size(); ++v) result[v / kBucket].include(at(v));
    return result;
  }

  std::vector<RowPoint> points_;
  ApexSearch<2> search_;
  BoxTree<glm::dvec2> runs_;
};

// What rank 0 does: those of the edges of all ranks that it has not had, shared out evenly.
class EdgeCollector {
 public:
  // Collective. Returns the rank's share.
  std::vector<Edge> exchange(comm::Communicator& communicator, const std::vector<Edge>& found) {
    std::vector<std::vector<Edge>> shares(static_cast<std::size_t>(communicator.size()));
    std::size_t next = 0;
    for (const comm::Buffer& each :
         comm::gather(communicator, 0, comm::Buffer::of(std::span<const Edge>(found)))) {
      for (const Edge& edge : each.as<Edge>()) {
        if (known_.insert(key_of(edge)).second) shares[next++ % shares.size()].push_back(edge);
      }
    }
    std::vector<comm::Parcel> parcels;
    for (int rank = 0; communicator.rank() == 0 && rank < communicator.size(); ++rank) {
      const std::vector<Edge>& share = shares[static_cast<std::size_t>(rank)];
      parcels.push_back({rank, comm::Buffer::of(std::span<const Edge>(share))});
    }
    std::vector<Edge> own;
    for (const comm::Parcel& parcel : comm::exchange(communicator, std::move(parcels))) {
      const auto some = parcel.message.as<Edge>();
      own.assign(some.begin(), some.end());
    }
    return own;
  }

 private:
  std::unordered_set<std::uint64_t> known_;  // on rank 0
};

// The triangles on both sides of an edge, or the end of the hull.
void make_triangles(const AllPoints& points, const Edge& edge, std::vector<Edge>& found,
                    TiledTriangulation& result) {
  for (const auto& [a, b] : {std::pair(edge[0], edge[1]), std::pair(edge[1], edge[0])}) {
    const std::optional<VertexNumber> c = points.apex(a, b);
    if (!c) {
      ++result.hull_facets;
      continue;
    }
    const Edge second = edge_between(b, *c), third = edge_between(*c, a);
    found.push_back(second);
    found.push_back(third);
    if (edge < second && edge < third) {
      for (const VertexNumber v : {a, b, *c}) result.vertices.push_back(points.row(v));
    }
  }
}

}  // namespace

DistributedTriangulation lee_1997(comm::Communicator& communicator,
                                  std::span<const RowPoint> points,
                                  const DistributedOptions& options) {
  const AllPoints all(communicator, points);
  const auto rank = static_cast<std::uint64_t>(communicator.rank()),
             ranks = static_cast<std::uint64_t>(communicator.size());
  const auto first = static_cast<VertexNumber>(all.size() * rank / ranks),
             last = static_cast<VertexNumber>(all.size() * (rank + 1) / ranks);
  DistributedTriangulation result;
  result.part.distinct = last - first;
  result.statistics.points_sent = points.size() * (ranks - 1);
  if (!internal::first_triangle(all.places())) return result;
  std::vector<Edge> found;
  comm::all_or_none(communicator, comm::Phase::other, [&] {
    for (VertexNumber v = first; v < last; ++v) found.push_back(edge_between(v, all.nearest(v)));
  });
  EdgeCollector collector;
  for (int round = 0;; ++round) {
    const std::vector<Edge> own = collector.exchange(communicator, found);
    const std::uint64_t any = own.empty() ? 0 : 1;
    if (comm::all_reduce_value(communicator, any, std::plus<>()) == 0) {
      result.part.rounds = round;
      if (options.triangulate.progress != nullptr) {
        options.triangulate.progress->advance(result.part.distinct);
      }
      return result;
    }
    found.clear();
    comm::all_or_none(communicator, comm::Phase::other, [&] {
      for (const Edge& edge : own) {
        if (options.triangulate.progress != nullptr) options.triangulate.progress->advance(0);
        make_triangles(all, edge, found, result.part);
      }
    });
  }
}

}  // namespace delray::delaunay
