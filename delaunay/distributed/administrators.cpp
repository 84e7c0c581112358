// Administrators (Kohout 2004, chapter 8): every simplex has one rank that may change it, its
// administrator, and nobody stands between the ranks.
//
// Candidates for the post are the ranks whose areas have a corner of the simplex; the one with the
// fewest posts gets it. The other candidates share the simplex: messages that nobody waits for keep
// their copies up to date. A rank walks towards a point over its simplices and copies. Where the
// simplex that it comes to is another's, the point is sent on to its administrator; what the
// insertion then needs beyond that, its administrator is asked for, and the asker waits: it applies
// for the post for the time of the insertion (remote_nodes.h).
//
// Copies may be out of date, so that walks over them could go in circles; what a rank is home of is
// not. A point that has been sent on several times goes over those alone. Cost: no message for a
// point whose cavity lies inside an area.
#include <algorithm>
#include <chrono>
#include <deque>
#include <unordered_set>
#include <utility>

#include "delaunay/distributed/method_sources.h"
#include "delaunay/distributed/online_insertion.h"
#include "delaunay/distributed/remote_insertion.h"

namespace delray::delaunay {
namespace {

// Points of an area that are under way elsewhere. More of them would come before the simplices that
// the first of them make, and so be inserted far from their area as well.
constexpr std::size_t kMostSentOn = 4;
// Copies that the walk of a point looks at on one rank, and ranks on which it looks at any.
constexpr int kMostCopies = 1000;
constexpr std::uint64_t kMostRanksWithCopies = 3;

template <int D>
class Administrators final : public RankInserter<D> {
 public:
  explicit Administrators(const InsertionSite<D>& site)
      : site_(site),
        nodes_(site.communicator, site.statistics),
        posts_(static_cast<std::size_t>(site.communicator.size())) {
    nodes_.on_message(
        [this](std::uint32_t, int, Unpacker& content) { tasks_.push_back(content.value<Task>()); });
    nodes_.on_changes([this](int source, const Changes<D>& changes) { note(source, changes); });
    // All ranks appoint the same administrators of the first simplices.
    std::vector<Node<D>> nodes = first_nodes<D>(site.first);
    std::vector<std::uint32_t> homes;
    homes.reserve(nodes.size());
    for (const Node<D>& node : nodes) homes.push_back(appoint(node));
    for (Node<D>& node : nodes) {
      for (NodeId& id : node.neighbours) id.home = homes[id.number];
      node.id.home = homes[node.id.number];
      if (nodes_.is_home_of(node.id)) {
        nodes_.put(node);
      } else {
        take_copy(node);
      }
    }
    start_ = nodes.front().id;
  }

  void insert(std::span<const RowPoint> points) override {
    std::size_t next = 0;
    for (;;) {
      while (nodes_.serve(comm::Deadline::now())) continue;
      if (!tasks_.empty()) {
        const Task task = tasks_.front();
        tasks_.pop_front();
        carry_on(task);
      } else if (next < points.size() && sent_on_.size() < kMostSentOn) {
        carry_on({points[next++], start_, {++time_, static_cast<std::uint64_t>(nodes_.rank())}});
      } else if (!nodes_.wait_for_work()) {
        return;
      }
    }
  }
  const RemoteNodes<D>& nodes() const override { return nodes_; }

 private:
  // A point to be inserted, and where to look for it first.
  struct Task {
    RowPoint point;
    NodeId start;
    Priority priority;
    std::uint64_t attempts = 0;
    std::uint64_t ranks = 0;  // that have sent it on
  };

  void carry_on(Task task) {
    int copies = task.ranks < kMostRanksWithCopies ? kMostCopies : 0;
    const WalkEnd end =
        walk<D>(site_.first, task.point.position, task.start, [&](const NodeId& id) {
          return nodes_.is_home_of(id) ? find(id) : copies-- > 0 ? find_copy(id) : nullptr;
        });
    task.start = end.node;
    if (!nodes_.is_home_of(end.node)) {
      send_on(task);
      return;
    }
    nodes_.begin(task.priority);
    if (try_to_insert(task)) return;
    nodes_.rollback();
    ++site_.statistics.rollbacks;
    nodes_.serve(pause_after(task.attempts++));
    tasks_.push_back(task);
  }

  // Longer and longer, so that refused insertions do not keep others from their ends.
  static comm::Deadline pause_after(std::uint64_t attempts) {
    return comm::Deadline::in(
        std::chrono::microseconds(1U << std::min<std::uint64_t>(attempts, 10)));
  }

  void send_on(Task& task) {
    ++task.ranks;
    if (site_.areas.rank_of(task.point.position) == nodes_.rank()) sent_on_.insert(task.point.row);
    ++site_.statistics.points_sent;
    auto message = nodes_.message_of(RemoteNodes<D>::kFirstKind);
    message.value(task);
    nodes_.send(static_cast<int>(task.start.home), std::move(message));
  }

  bool try_to_insert(Task& task) {
    const Node<D>* node = nodes_.lock(task.start);
    // Dead if another rank's insertion was faster: the next walk goes on from its successor.
    if (node == nullptr || node->is_dead()) return false;
    const auto cavity = lock_cavity(nodes_, task.start, site_.first, task.point.position);
    if (!cavity) return false;
    nodes_.commit(make_star<D>(nodes_, *cavity, task.point,
                               [&](const Node<D>& made) { return appoint(made); }),
                  [&](const Node<D>& of, std::vector<int>& ranks) { add_candidates(of, ranks); });
    return true;
  }

  void add_candidates(const Node<D>& node, std::vector<int>& ranks) const {
    for (const RowPoint& corner : node.corners) {
      if (corner.row != kInfiniteRow) ranks.push_back(site_.areas.rank_of(corner.position));
    }
  }

  std::uint32_t appoint(const Node<D>& node) {
    std::vector<int> candidates;
    add_candidates(node, candidates);
    const int chosen = *std::ranges::min_element(candidates, {}, [&](int rank) {
      return std::pair(posts_[static_cast<std::size_t>(rank)], rank);
    });
    ++posts_[static_cast<std::size_t>(chosen)];
    return static_cast<std::uint32_t>(chosen);
  }

  // REQUIRES: it has its home here.
  const Node<D>* find(const NodeId& id) {
    const Node<D>* node = nodes_.find(id);
    // Its maker's message is under way.
    for (; node == nullptr; node = nodes_.find(id)) nodes_.serve(comm::Deadline::never());
    return node;
  }
  const Node<D>* find_copy(const NodeId& id) const {
    const auto at = copies_.find(id);
    return at == copies_.end() ? nullptr : &at->second;
  }

  // A change that came before the copy that it is about, from another rank, is kept until then.
  void take_copy(const Node<D>& node) {
    if (gone_.erase(node.id) == 0) copies_.insert_or_assign(node.id, node);
  }
  void note(int source, const Changes<D>& changes) {
    posts_[static_cast<std::size_t>(source)] = changes.nodes_at_sender;
    for (const auto& relink : changes.relinked) {
      const auto at = copies_.find(relink.node);
      if (at == copies_.end()) continue;
      std::ranges::replace(at->second.neighbours, relink.before, relink.after);
    }
    for (const NodeId& id : changes.killed) {
      if (!nodes_.is_home_of(id) && copies_.erase(id) == 0) gone_.insert(id);
    }
    for (const Node<D>& node : changes.made) {
      if (!nodes_.is_home_of(node.id)) take_copy(node);
      start_ = node.id;
    }
    sent_on_.erase(changes.row);
    if (site_.progress != nullptr && source == nodes_.rank() && changes.row != kInfiniteRow) {
      site_.progress->advance();
    }
  }

  InsertionSite<D> site_;
  RemoteNodes<D> nodes_;
  std::vector<std::uint64_t> posts_;  // of each rank, as far as is known here
  std::unordered_map<NodeId, Node<D>, NodeIdHash> copies_;
  std::unordered_set<NodeId, NodeIdHash> gone_;  // before their copies came
  std::deque<Task> tasks_;                       // sent here, or to be tried again
  std::unordered_set<std::uint64_t> sent_on_;    // rows of this rank's points
  NodeId start_;                                 // of the next walk
  std::uint64_t time_ = 0;
};

constexpr InsertionMethod kAdministrators = {
    [](const InsertionSite<2>& site) -> std::unique_ptr<RankInserter<2>> {
      return std::make_unique<Administrators<2>>(site);
    },
    [](const InsertionSite<3>& site) -> std::unique_ptr<RankInserter<3>> {
      return std::make_unique<Administrators<3>>(site);
    },
    [](int) { return 0; }};

}  // namespace

DistributedTriangulation administrators(comm::Communicator& communicator,
                                        std::span<const RowPoint> points,
                                        const DistributedOptions& options) {
  return insert_all(communicator, points, options, kAdministrators);
}

std::unique_ptr<OnlineTriangulation> administrators_on_line(comm::Communicator& communicator,
                                                            const DistributedOptions& options) {
  return insert_on_line(communicator, options, kAdministrators);
}

}  // namespace delray::delaunay
