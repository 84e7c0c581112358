// Virtual shared memory (Kohout 2004, chapter 8, Figure 8.1): the optimistic method with the
// history of the triangulation spread over the ranks, each node named by rank and number.
//
// A point is located down the history, from the first simplices, which rank 0 has: one of the nodes
// that replaced a node in conflict with a point is in conflict with it, too. Nodes of other ranks
// are read through a cache, all that one insertion made at a time; what is to change is locked at
// the rank that has it, and the cache is never asked. A lock that might end in a deadlock is
// answered by null, and the insertion rolls back.
//
// Why the history finds a leaf: the ball of a node that went, shrunk, has the point that it went
// for and the new one on its border and no other inside, so both are joined by an edge, which lies
// in a simplex that conflicts with the new point before that one is in.
//
// Cost: a message there and back for nearly every node that an insertion looks at.
#include <algorithm>
#include <chrono>
#include <utility>

#include "delaunay/distributed/lru_cache.h"
#include "delaunay/distributed/method_sources.h"
#include "delaunay/distributed/online_insertion.h"
#include "delaunay/distributed/remote_insertion.h"

namespace delray::delaunay {
namespace {

constexpr std::size_t kCachedPages = 4096;  // of a dozen nodes each

template <int D>
class VirtualSharedMemory final : public RankInserter<D> {
 public:
  explicit VirtualSharedMemory(const InsertionSite<D>& site)
      : site_(site), nodes_(site.communicator, site.statistics), cache_(kCachedPages) {
    if (nodes_.rank() != 0) return;
    for (const Node<D>& node : first_nodes<D>(site.first)) nodes_.put(node);
  }

  void insert(std::span<const RowPoint> points) override {
    for (const RowPoint& point : points) {
      while (nodes_.serve(comm::Deadline::now())) continue;
      insert_one(point);
      if (site_.progress != nullptr) site_.progress->advance();
    }
    while (nodes_.wait_for_work()) continue;
  }
  const RemoteNodes<D>& nodes() const override { return nodes_; }

 private:
  // Nodes that one insertion made, in one place.
  struct Page {
    NodeId first;
    std::uint64_t count = 0;
  };

  void insert_one(const RowPoint& point) {
    nodes_.begin({++time_, static_cast<std::uint64_t>(nodes_.rank())});
    Page page{{0, 0, 0}, D + 2};
    for (int attempt = 0;; ++attempt) {
      if (try_to_insert(point, page)) return;
      nodes_.rollback();
      ++site_.statistics.rollbacks;
      nodes_.serve(pause_after(attempt));
    }
  }

  // Longer and longer, so that refused insertions do not keep others from their ends.
  static comm::Deadline pause_after(int attempt) {
    return comm::Deadline::in(std::chrono::microseconds(1 << std::min(attempt, 10)));
  }

  // Moves `page` down the history to where the point may be looked for again.
  bool try_to_insert(const RowPoint& point, Page& page) {
    for (;;) {
      const Node<D>* node = nodes_.lock(find_leaf(point.position, page));
      if (node == nullptr) return false;
      if (!node->is_dead()) {
        const auto cavity = lock_cavity(nodes_, node->id, site_.first, point.position);
        if (!cavity) return false;
        const auto here = static_cast<std::uint32_t>(nodes_.rank());
        nodes_.commit(make_star<D>(nodes_, *cavity, point, [&](const Node<D>&) { return here; }),
                      nullptr);
        return true;
      }
      forget_that_it_lived(page, *node);
      page = {node->successor, node->successors};
    }
  }

  // What the cache has of a node that turned out to be dead.
  void forget_that_it_lived(const Page& page, const Node<D>& node) {
    std::vector<Node<D>>* cached = cache_.find(page.first);
    if (cached == nullptr) return;
    for (Node<D>& each : *cached) {
      if (each.id == node.id) each = node;
    }
  }

  // A node that is in conflict with the point and, for all that is known here, lives.
  NodeId find_leaf(const glm::dvec3& q, Page& page) {
    for (;;) {
      const std::vector<Node<D>> nodes = read(page);
      const auto found = std::ranges::find_if(
          nodes, [&](const Node<D>& node) { return conflict(node, site_.first, q); });
      comm::check_message(found != nodes.end());
      if (!found->is_dead()) return found->id;
      page = {found->successor, found->successors};
    }
  }

  std::vector<Node<D>> read(const Page& page) {
    if (nodes_.is_home_of(page.first)) return nodes_.read(page.first, page.count);
    if (const auto* cached = cache_.find(page.first)) {
      ++site_.statistics.cached_reads;
      return *cached;
    }
    return cache_.put(page.first, nodes_.read(page.first, page.count));
  }

  InsertionSite<D> site_;
  RemoteNodes<D> nodes_;
  LruCache<NodeId, std::vector<Node<D>>, NodeIdHash> cache_;
  std::uint64_t time_ = 0;
};

constexpr InsertionMethod kVirtualSharedMemory = {
    [](const InsertionSite<2>& site) -> std::unique_ptr<RankInserter<2>> {
      return std::make_unique<VirtualSharedMemory<2>>(site);
    },
    [](const InsertionSite<3>& site) -> std::unique_ptr<RankInserter<3>> {
      return std::make_unique<VirtualSharedMemory<3>>(site);
    },
    [](int) { return 0; }};

}  // namespace

DistributedTriangulation virtual_shared_memory(comm::Communicator& communicator,
                                               std::span<const RowPoint> points,
                                               const DistributedOptions& options) {
  return insert_all(communicator, points, options, kVirtualSharedMemory);
}

std::unique_ptr<OnlineTriangulation> virtual_shared_memory_on_line(
    comm::Communicator& communicator, const DistributedOptions& options) {
  return insert_on_line(communicator, options, kVirtualSharedMemory);
}

}  // namespace delray::delaunay
