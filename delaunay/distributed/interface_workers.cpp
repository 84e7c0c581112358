// Interface and workers (Kohout 2004, chapter 8, Figures 8.2 to 8.6): every rank but the first, a
// worker, has an area and the simplices whose corners all lie in it; the first, the interface, has
// those that are shared.
//
// A worker inserts a point by itself where the point's cavity and the simplices around it are its
// own. Otherwise it calls the interface and goes on with other points. The interface deals with one
// call after the other, a critical section of all: it takes what it needs of the workers' simplices
// (remote_nodes.h), and tells those whose simplices change. As it is the only one that locks
// simplices of others, nothing can wait in a circle.
//
// Cost: the interface does all work along the borders, so its share grows with the number of
// workers. A single rank is worker alone: nothing is shared.
#include <algorithm>
#include <deque>
#include <optional>
#include <unordered_set>
#include <utility>

#include "delaunay/distributed/method_sources.h"
#include "delaunay/distributed/online_insertion.h"
#include "delaunay/distributed/remote_insertion.h"

namespace delray::delaunay {
namespace {

// A worker's calls that have not been answered. More of them would be of points that the worker can
// insert by itself once the first are in.
constexpr std::size_t kMostCalls = 4;
// Points that a worker tries meanwhile.
constexpr std::size_t kMostSetAside = 64;

template <int D>
class InterfaceWorkers final : public RankInserter<D> {
 public:
  explicit InterfaceWorkers(const InsertionSite<D>& site)
      : site_(site), nodes_(site.communicator, site.statistics) {
    nodes_.on_message([this](std::uint32_t kind, int source, Unpacker& content) {
      if (kind == kCall) {
        const auto point = content.value<RowPoint>();
        calls_.push_back({point, content.value<WalkEnd>(), source});
      } else if (kind == kWalk) {
        const auto q = content.value<glm::dvec3>();
        auto message = nodes_.message_of(kWalkEnd);
        message.value(walk_here(q, content.value<NodeId>()));
        nodes_.send(source, std::move(message));
      } else if (kind == kWalkEnd) {
        walk_end_ = content.value<WalkEnd>();
      } else {
        const auto row = content.value<std::uint64_t>();
        comm::check_message(called_.erase(row) == 1);
        shared_ = content.value<NodeId>();
      }
    });
    nodes_.on_changes([this](int, const Changes<D>& changes) { note(changes); });
    std::vector<Node<D>> nodes = first_nodes<D>(site.first);
    std::vector<std::uint32_t> homes;
    homes.reserve(nodes.size());
    for (const Node<D>& node : nodes) homes.push_back(home_of(node));
    for (Node<D>& node : nodes) {
      for (NodeId& id : node.neighbours) id.home = homes[id.number];
      node.id.home = homes[node.id.number];
      if (!nodes_.is_home_of(node.id)) continue;
      nodes_.put(node);
      local_ = node.id;
    }
    shared_ = nodes.front().id;
  }

  void insert(std::span<const RowPoint> points) override {
    std::size_t next = 0;
    for (;;) {
      while (nodes_.serve(comm::Deadline::now())) continue;
      if (!calls_.empty()) {
        const Call call = calls_.front();
        calls_.pop_front();
        answer(call);
      } else if (!set_aside_.empty() && called_.size() < kMostCalls) {
        const RowPoint point = set_aside_.front();
        set_aside_.pop_front();
        insert_or_call(point);
      } else if (next < points.size() && set_aside_.size() < kMostSetAside) {
        insert_or_call(points[next++]);
      } else if (!nodes_.wait_for_work()) {
        return;
      }
    }
  }
  const RemoteNodes<D>& nodes() const override { return nodes_; }

 private:
  enum Kind : std::uint32_t { kCall = RemoteNodes<D>::kFirstKind, kDone, kWalk, kWalkEnd };
  struct Call {
    RowPoint point;
    WalkEnd start;
    int worker = 0;
  };

  // The worker whose area has all corners, else the interface.
  std::uint32_t home_of(const Node<D>& node) const {
    int home = -1;
    for (const RowPoint& corner : node.corners) {
      if (corner.row == kInfiniteRow) continue;
      const int rank = site_.areas.rank_of(corner.position);
      if (home >= 0 && rank != home) return 0;
      home = rank;
    }
    return static_cast<std::uint32_t>(home);
  }
  Changes<D> star(const Cavity<D>& cavity, const RowPoint& point) {
    return make_star<D>(nodes_, cavity, point, [&](const Node<D>& made) { return home_of(made); });
  }

  // Of a worker. Calls if it cannot insert the point by itself, or sets it aside.
  void insert_or_call(const RowPoint& point) {
    const WalkEnd end = walk_here(point.position, local_.value_or(shared_));
    nodes_.begin({}, /*only_here=*/true);
    if (end.found && nodes_.lock(end.node) != nullptr) {
      if (const auto cavity = lock_cavity(nodes_, end.node, site_.first, point.position)) {
        nodes_.commit(star(*cavity, point), nullptr);
        return;
      }
    }
    nodes_.rollback();
    if (called_.size() >= kMostCalls) {
      set_aside_.push_back(point);
      return;
    }
    called_.insert(point.row);
    ++site_.statistics.points_sent;
    auto message = nodes_.message_of(kCall);
    message.value(point).value(end);
    nodes_.send(0, std::move(message));
  }

  // Of the interface. Workers grant all that is asked for: they lock nothing for long.
  void answer(const Call& call) {
    WalkEnd start = call.start;
    nodes_.begin({});
    for (;;) {
      while (!start.found) start = walk_anywhere(call.point.position, start.node);
      const Node<D>* node = nodes_.lock(start.node);
      comm::check_message(node != nullptr);
      if (!node->is_dead()) break;
      start = {node->successor, false};  // the worker was faster
    }
    const auto cavity = lock_cavity(nodes_, start.node, site_.first, call.point.position);
    comm::check_message(cavity.has_value());
    const Changes<D> changes = star(*cavity, call.point);
    nodes_.commit(changes, nullptr);
    auto message = nodes_.message_of(kDone);
    message.value(call.point.row).value(changes.successor);
    nodes_.send(call.worker, std::move(message));
  }

  // Over nodes that are at home here.
  WalkEnd walk_here(const glm::dvec3& q, const NodeId& start) const {
    return walk<D>(site_.first, q, start, [&](const NodeId& id) {
      return nodes_.is_home_of(id) ? nodes_.find(id) : nullptr;
    });
  }

  // Of the interface: a worker walks over its own nodes.
  WalkEnd walk_anywhere(const glm::dvec3& q, const NodeId& start) {
    if (nodes_.is_home_of(start)) return walk_here(q, start);
    ++site_.statistics.requests;
    ++site_.statistics.waits;
    auto message = nodes_.message_of(kWalk);
    message.value(q).value(start);
    nodes_.send(static_cast<int>(start.home), std::move(message));
    while (!walk_end_) nodes_.serve(comm::Deadline::never());
    return *std::exchange(walk_end_, std::nullopt);
  }

  void note(const Changes<D>& changes) {
    for (const Node<D>& node : changes.made) {
      if (nodes_.is_home_of(node.id)) local_ = node.id;
    }
    if (site_.progress != nullptr && nodes_.is_home_of(changes.successor)) {
      site_.progress->advance();
    }
  }

  InsertionSite<D> site_;
  RemoteNodes<D> nodes_;
  std::deque<Call> calls_;                    // of the interface
  std::unordered_set<std::uint64_t> called_;  // rows of a worker's points that the interface has
  std::deque<RowPoint> set_aside_;
  std::optional<NodeId> local_;      // where a walk begins, if there is one
  NodeId shared_;                    // and otherwise
  std::optional<WalkEnd> walk_end_;  // that a worker has answered
};

constexpr InsertionMethod kInterfaceWorkers = {
    [](const InsertionSite<2>& site) -> std::unique_ptr<RankInserter<2>> {
      return std::make_unique<InterfaceWorkers<2>>(site);
    },
    [](const InsertionSite<3>& site) -> std::unique_ptr<RankInserter<3>> {
      return std::make_unique<InterfaceWorkers<3>>(site);
    },
    [](int ranks) { return ranks > 1 ? 1 : 0; }};

}  // namespace

DistributedTriangulation interface_workers(comm::Communicator& communicator,
                                           std::span<const RowPoint> points,
                                           const DistributedOptions& options) {
  return insert_all(communicator, points, options, kInterfaceWorkers);
}

std::unique_ptr<OnlineTriangulation> interface_workers_on_line(comm::Communicator& communicator,
                                                               const DistributedOptions& options) {
  return insert_on_line(communicator, options, kInterfaceWorkers);
}

}  // namespace delray::delaunay
