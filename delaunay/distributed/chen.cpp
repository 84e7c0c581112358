// Local triangulations and interfaces (Chen, Chuang and Wu 2001; Kohout 2004, 5.3.2, Figure 5.5): a
// rank triangulates its area, keeps the triangles that no other area's points can meet, and builds
// on from their border by incremental construction, until every triangle with a corner in the area
// is there: its interface. It needs all points of the areas beside it for that.
//
// Two ranks build the interface of their border each; ranks tell each other its triangles, and the
// rank of the lowest row keeps it: the wall. What of the local triangulations overlaps it was never
// kept. A told triangle also lets a rank begin whose area has no triangle of its own.
//
// Areas are asked for when a circle touches them, the nearest first. Where circles are large, as
// along the hull, these are more than the paper's four, and exchanges more than one. If no local
// triangle is certain anywhere, an edge of the hull begins. In the plane only, as published (5.3.2:
// "intended to be used in E2 only").
#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <optional>
#include <set>
#include <unordered_set>
#include <utility>
#include <vector>

#include "comm/agree_on_failure.h"
#include "comm/collectives.h"
#include "delaunay/distributed/areas.h"
#include "delaunay/distributed/first_simplex.h"
#include "delaunay/distributed/known_points.h"
#include "delaunay/distributed/method_sources.h"
#include "delaunay/mesh/facets.h"
#include "delaunay/predicates/conflict.h"
#include "delaunay/tiles/circumball.h"

namespace delray::delaunay {
namespace {

using Triangle = std::array<RowPoint, 3>;  // counterclockwise
struct DirectedEdge {
  RowPoint start, end;
  DirectedEdge reversed() const { return {end, start}; }
};
using EdgeKey = std::pair<std::uint64_t, std::uint64_t>;
struct EdgeKeyHash {
  std::size_t operator()(const EdgeKey& key) const {
    const std::uint64_t x = (key.first * 0x9e3779b97f4a7c15U) ^ (key.second + (key.first >> 32));
    return static_cast<std::size_t>(x * 0xff51afd7ed558ccdU ^ x >> 29);
  }
};
EdgeKey key_of(const DirectedEdge& edge) { return {edge.start.row, edge.end.row}; }

// The rank's area, and what it builds on its border.
class BorderedArea {
 public:
  using AreaBox = geometry::Box<glm::dvec2>;

  BorderedArea(comm::Communicator& communicator, const Areas& areas, std::vector<RowPoint> own)
      : communicator_(communicator),
        areas_(areas),
        own_(std::move(own)),
        boxes_(share_boxes()),
        tree_(boxes_) {
    known_.add(communicator.rank(), own_);
  }

  // Keeps what is certain; the facets around it are the border to build on. Returns whether
  // anything is.
  bool triangulate_own(const Options& options);
  void begin_with_hull_edge();
  // Collective: exchanges points and triangles until nobody needs any. Returns how many times.
  int build_interfaces();

  TiledTriangulation& result() { return result_; }
  std::uint64_t shared() const { return shared_; }
  std::uint64_t points_sent() const { return points_sent_; }

 private:
  std::vector<AreaBox> share_boxes();
  bool is_own(const RowPoint& point) const {
    return areas_.rank_of(point.position) == communicator_.rank();
  }
  bool is_foreign(std::uint32_t area) const {
    return static_cast<int>(area) != communicator_.rank();
  }

  // To be built on, unless a triangle or the end of the hull is known there.
  void push(const DirectedEdge& edge) {
    if (!done_.contains(key_of(edge)) && (is_own(edge.start) || is_own(edge.end))) {
      front_.push_back(edge);
    }
  }
  void build_on(const DirectedEdge& edge);
  void keep(const Triangle& triangle, bool is_told);
  void fetch_wanted();
  void tell_triangles();

  comm::Communicator& communicator_;
  const Areas& areas_;
  std::vector<RowPoint> own_;
  std::vector<AreaBox> boxes_;
  BoxTree<glm::dvec2> tree_;
  KnownPoints known_;
  std::vector<DirectedEdge> front_, pending_;  // to be built on; once wanted areas are known
  std::unordered_set<EdgeKey, EdgeKeyHash> done_;
  std::set<int> wanted_;
  std::vector<std::pair<int, Triangle>> told_;  // to whom
  TiledTriangulation result_;
  std::uint64_t shared_ = 0, points_sent_ = 0;
};

std::vector<BorderedArea::AreaBox> BorderedArea::share_boxes() {
  AreaBox box;
  for (const RowPoint& point : own_) box.include(glm::dvec2(point.position));
  std::vector<AreaBox> boxes;
  for (const comm::Buffer& each : comm::all_gather(communicator_, comm::Buffer::of_value(box))) {
    boxes.push_back(each.as<AreaBox>()[0]);
  }
  return boxes;
}

bool BorderedArea::triangulate_own(const Options& options) {
  result_.distinct = own_.size();
  const PointView<double> view{reinterpret_cast<const std::byte*>(own_.data()), own_.size(),
                               sizeof(RowPoint)};
  const std::vector<std::uint32_t> corners = triangulate(view, options).triangulation.vertices;
  const std::vector<std::uint32_t> mates = match_facets(2, corners, own_.size()).mates;
  const auto at = [&](std::size_t corner) { return glm::dvec2(own_[corners[corner]].position); };
  std::vector<bool> is_certain(corners.size() / 3);
  for (std::size_t t = 0; t < is_certain.size(); ++t) {
    const Circumball<2> ball({at(3 * t), at(3 * t + 1), at(3 * t + 2)});
    bool meets = false;
    tree_.find([&](const AreaBox& box) { return !meets && ball.touches(box); },
               [&](std::uint32_t area) { meets = meets || is_foreign(area); });
    is_certain[t] = !meets;
  }
  for (std::size_t facet = 0; facet < corners.size(); ++facet) {
    const std::size_t t = facet / 3, k = facet % 3;
    if (!is_certain[t]) continue;
    result_.vertices.push_back(own_[corners[facet]].row);
    if (mates[facet] != FacetMates::kNone && is_certain[mates[facet] / 3]) continue;
    const DirectedEdge inner{own_[corners[3 * t + (k + 1) % 3]],
                             own_[corners[3 * t + (k + 2) % 3]]};
    done_.insert(key_of(inner));
    push(inner.reversed());
  }
  return !result_.vertices.empty();
}

// From the first point in lexicographic order to the next one around the hull.
void BorderedArea::begin_with_hull_edge() {
  const auto gathered = [&](const std::optional<RowPoint>& mine) {
    std::vector<RowPoint> all;
    for (const comm::Buffer& each :
         comm::all_gather(communicator_, mine ? comm::Buffer::of_value(*mine) : comm::Buffer())) {
      if (!each.empty()) all.push_back(each.as<RowPoint>()[0]);
    }
    return all;
  };
  const auto first_of = [](std::span<const RowPoint> points) {
    std::optional<RowPoint> first;
    for (const RowPoint& point : points) {
      if (!first || lexicographically_less(glm::dvec2(point.position), glm::dvec2(first->position)))
        first = point;
    }
    return first;
  };
  const RowPoint start = *first_of(gathered(first_of(own_)));
  const auto next_of = [&](std::span<const RowPoint> points) {
    std::optional<RowPoint> next;
    for (const RowPoint& point : points) {
      if (point.row == start.row) continue;
      const glm::dvec2 a(start.position), p(point.position);
      const glm::dvec2 b = next ? glm::dvec2(next->position) : p;
      const int side = next ? orient2d(a, b, p) : -1;
      if (side < 0 || (side == 0 && strictly_between(a, b, p))) next = point;
    }
    return next;
  };
  push({start, *next_of(gathered(next_of(own_)))});
}

void BorderedArea::keep(const Triangle& triangle, bool is_told) {
  std::set<int> owners;
  for (unsigned k = 0; k < 3; ++k) {
    owners.insert(areas_.rank_of(triangle[k].position));
    const DirectedEdge edge{triangle[k], triangle[(k + 1) % 3]};
    done_.insert(key_of(edge));
    push(edge.reversed());
  }
  if (!is_told) {
    for (const int owner : owners) {
      if (owner != communicator_.rank()) told_.emplace_back(owner, triangle);
    }
  }
  if (!is_own(*std::ranges::min_element(triangle, {}, &RowPoint::row))) return;
  for (const RowPoint& corner : triangle) result_.vertices.push_back(corner.row);
  shared_ += owners.size() > 1 ? 1 : 0;
}

void BorderedArea::build_on(const DirectedEdge& edge) {
  if (done_.contains(key_of(edge))) return;
  const glm::dvec2 a(edge.start.position), b(edge.end.position);
  const std::optional<RowPoint> apex = known_.apex_of(edge.start, edge.end);
  // Of the unknown areas that could have another apex, the nearest: its points make circles
  // smaller.
  const glm::dvec2 middle = a * 0.5 + b * 0.5;
  std::optional<std::pair<double, int>> nearest;
  const auto consider = [&](std::uint32_t area) {
    if (known_.has(static_cast<int>(area))) return;
    const AreaBox& box = boxes_[area];
    const glm::dvec2 away = glm::max(glm::max(box.low - middle, middle - box.high), glm::dvec2(0));
    const std::pair candidate(glm::length(away), static_cast<int>(area));
    if (!nearest || candidate < *nearest) nearest = candidate;
  };
  if (apex) {
    const Circumball<2> ball({a, b, glm::dvec2(apex->position)});
    tree_.find([&](const AreaBox& box) { return ball.touches(box); }, consider);
  } else {
    tree_.find([&](const AreaBox& box) { return reaches_beyond({b, a}, box); }, consider);
  }
  if (nearest) {
    wanted_.insert(nearest->second);
    pending_.push_back(edge);
  } else if (apex) {
    keep({edge.start, edge.end, *apex}, /*is_told=*/false);
  } else {
    done_.insert(key_of(edge));
    result_.hull_facets += is_own(edge.start.row < edge.end.row ? edge.start : edge.end) ? 1 : 0;
  }
}

void BorderedArea::fetch_wanted() {
  std::vector<comm::Parcel> requests;
  for (const int area : std::exchange(wanted_, {})) requests.push_back({area, comm::Buffer(1)});
  std::vector<comm::Parcel> answers;
  for (const comm::Parcel& request : comm::exchange(communicator_, std::move(requests))) {
    answers.push_back({request.rank, comm::Buffer::of(std::span<const RowPoint>(own_))});
    points_sent_ += own_.size();
  }
  for (const comm::Parcel& answer : comm::exchange(communicator_, std::move(answers))) {
    const auto points = answer.message.as<RowPoint>();
    known_.add(answer.rank, std::vector<RowPoint>(points.begin(), points.end()));
  }
}

void BorderedArea::tell_triangles() {
  std::ranges::stable_sort(told_, {}, &std::pair<int, Triangle>::first);
  std::vector<comm::Parcel> parcels;
  for (std::size_t i = 0; i < told_.size();) {
    const int to = told_[i].first;
    std::vector<Triangle> triangles;
    for (; i < told_.size() && told_[i].first == to; ++i) triangles.push_back(told_[i].second);
    parcels.push_back({to, comm::Buffer::of(std::span<const Triangle>(triangles))});
  }
  told_.clear();
  for (const comm::Parcel& parcel : comm::exchange(communicator_, std::move(parcels))) {
    for (const Triangle& triangle : parcel.message.as<Triangle>()) {
      if (!done_.contains({triangle[0].row, triangle[1].row})) keep(triangle, /*is_told=*/true);
    }
  }
}

int BorderedArea::build_interfaces() {
  for (int round = 0;; ++round) {
    comm::all_or_none(communicator_, comm::Phase::other, [&] {
      front_.insert(front_.end(), pending_.begin(), pending_.end());
      pending_.clear();
      while (!front_.empty()) {
        const DirectedEdge edge = front_.back();
        front_.pop_back();
        build_on(edge);
      }
    });
    const std::uint64_t open = pending_.size() + told_.size();
    if (comm::all_reduce_value(communicator_, open, std::plus<>()) == 0) return round;
    fetch_wanted();
    tell_triangles();
  }
}

}  // namespace

DistributedTriangulation chen(comm::Communicator& communicator, std::span<const RowPoint> points,
                              const DistributedOptions& options) {
  const Areas areas(communicator, points, options);
  std::vector<RowPoint> own = areas.own_points(communicator, points, 2);
  DistributedTriangulation result;
  result.part.distinct = own.size();
  if (!find_first_simplex<2>(communicator, own)) return result;
  BorderedArea area(communicator, areas, std::move(own));
  std::uint64_t certain = 0;
  comm::all_or_none(communicator, comm::Phase::other,
                    [&] { certain = area.triangulate_own(options.triangulate) ? 1 : 0; });
  if (comm::all_reduce_value(communicator, certain, std::plus<>()) == 0) {
    area.begin_with_hull_edge();
  }
  const int rounds = area.build_interfaces();
  result.part = std::move(area.result());
  result.part.rounds = rounds;
  result.statistics.shared_simplices = area.shared();
  result.statistics.points_sent = area.points_sent();
  return result;
}

}  // namespace delray::delaunay
