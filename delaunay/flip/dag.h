// The history of a triangulation: every simplex that ever was, with those that replaced it.
//
// Nodes are simplices; a node without children is a leaf, a simplex of the triangulation as it is
// now. A node's vertices never change and its slot is never used again: it is written, made
// reachable, and later given children, once. So any number of threads may go down the graph while
// others insert points, and a thread that comes to a simplex too late finds its children there.
// (The report's leaves are modified in place, and it keeps bits that say which children are leaves;
// here the list of children says it.)
//
// Neighbours and an owner, which only leaves have, are kept apart in records that are used again:
// they are few, and stay in the caches. A record says which node it serves, so that whoever comes
// to it by way of a node that has been replaced meanwhile sees that.
#pragma once

#include <array>
#include <atomic>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <vector>

#include "delaunay/mesh/growing_array.h"
#include "delaunay/mesh/mesh.h"

namespace delray::delaunay {

using NodeNumber = std::uint32_t;    // below 2^30; corners are numbered as in a mesh
using RecordNumber = std::uint32_t;  // of what a leaf has, below 2^30

constexpr NodeNumber kNoNode = 0xffffffffU;
constexpr RecordNumber kNoRecord = 0xffffffffU;
constexpr CornerNumber kNoCorner = 0xffffffffU;
// In place of an owner: the record does not serve the node any more.
constexpr std::uint32_t kReplaced = 0xffffffffU;

// The children of a node, which have consecutive numbers; none if it is a leaf or abandoned.
struct Children {
  NodeNumber first = kNoNode;
  unsigned count = 0;  // 0 or 2 to 4
};

template <int D>
class Dag {
 public:
  static constexpr unsigned kCorners = D + 1;
  // Nodes, and records, are given to threads by so many at a time (Kohout 2004, 7.1).
  static constexpr std::uint32_t kCacheSize = 512;

  // All that going down needs: in the plane four nodes in a cache line.
  struct Node {
    std::array<VertexNumber, kCorners> vertices;
    // 4 times the first child and one less than they are, or 4 times the record of a leaf.
    std::uint32_t family;
  };
  // The data that only leaves need.
  struct Record {
    std::array<CornerNumber, kCorners> neighbours;
    // Low half: the node; high half: 1 + the number of the thread that has locked it, or 0.
    alignas(8) std::uint64_t lock;
  };

  // So many nodes and leaves will be found fastest.
  explicit Dag(std::size_t nodes = 0, std::size_t leaves = 0)
      : nodes_(nodes, kMaximumSimplices), records_(leaves, kMaximumSimplices) {}

  // The first of kCacheSize nodes for the calling thread alone, which calls itself `thread`.
  // Errors: std::bad_alloc, also for more than kMaximumSimplices nodes.
  NodeNumber allocate(std::uint32_t thread) {
    NodeNumber first = 0;
    Node* ahead = nullptr;
    {
      const std::lock_guard guard(growing_);
      first = nodes_.extend(kCacheSize);
      created_by_.push_back(thread);
      ahead = nodes_.ahead_of(first, kCacheSize);
    }
    if (ahead != nullptr) atomic(ahead->family).fetch_or(0, std::memory_order_relaxed);
    return first;
  }
  // The first of kCacheSize records for the calling thread alone.
  RecordNumber allocate_records() {
    RecordNumber first = 0;
    Record* ahead = nullptr;
    {
      const std::lock_guard guard(growing_);
      first = records_.extend(kCacheSize);
      ahead = records_.ahead_of(first, kCacheSize);
    }
    if (ahead != nullptr) atomic(ahead->lock).fetch_or(0, std::memory_order_relaxed);
    return first;
  }

  // Slots that were handed out. REQUIRES for this and the next three: no thread inserts.
  NodeNumber size() const { return nodes_.size(); }
  // Whether a slot holds a simplex of the triangulation.
  bool is_live(NodeNumber node) const { return (nodes_[node].family & 3) == 0; }
  bool is_ghost(NodeNumber node) const {
    bool ghost = false;
    for (const VertexNumber vertex : nodes_[node].vertices) ghost |= vertex == kInfiniteVertex;
    return ghost;
  }
  // Bytes of all nodes and records.
  std::size_t bytes() const {
    return nodes_.size() * sizeof(Node) + records_.size() * sizeof(Record);
  }

  // The thread that the node was allocated for.
  std::uint32_t created_by(NodeNumber node) const { return created_by_[node / kCacheSize]; }

  VertexNumber vertex(CornerNumber corner) const {
    return nodes_[simplex_of(corner)].vertices[corner & 3];
  }
  // Makes a slot a leaf. REQUIRES: it and the record are the caller's alone.
  void set_leaf(NodeNumber node, const std::array<VertexNumber, kCorners>& vertices,
                RecordNumber record, std::uint32_t owner) {
    set_owner(node, record, owner);
    // Who walks by may look at them before they are known.
    for (CornerNumber& neighbour : records_[record].neighbours) {
      atomic(neighbour).store(kNoCorner, std::memory_order_release);
    }
    nodes_[node].vertices = vertices;
    atomic(nodes_[node].family).store(record << 2, std::memory_order_release);
  }

  // That of a leaf, else kNoRecord.
  RecordNumber record_if_leaf(NodeNumber node) const {
    const std::uint32_t family = family_of(node);
    return (family & 3) == 0 ? family >> 2 : kNoRecord;
  }
  // REQUIRES for these three: the node is a leaf, and will be for now.
  RecordNumber record_of(NodeNumber leaf) const {
    const std::uint32_t family = family_of(leaf);
    assert((family & 3) == 0);
    return family >> 2;
  }
  CornerNumber neighbour(CornerNumber corner) const {
    return atomic(records_[record_of(simplex_of(corner))].neighbours[corner & 3])
        .load(std::memory_order_acquire);
  }
  void set_neighbour(CornerNumber corner, CornerNumber beyond) {
    atomic(records_[record_of(simplex_of(corner))].neighbours[corner & 3])
        .store(beyond, std::memory_order_release);
  }

  // As neighbour(), of a node that may be no leaf any more, or become none meanwhile, or not be
  // complete: kNoCorner then, or its neighbour at some time.
  CornerNumber neighbour_if_leaf(CornerNumber corner) const {
    const NodeNumber node = simplex_of(corner);
    const RecordNumber record = record_if_leaf(node);
    if (record == kNoRecord) return kNoCorner;
    const CornerNumber beyond =
        atomic(records_[record].neighbours[corner & 3]).load(std::memory_order_acquire);
    // Whoever takes a record for another node says so before it writes neighbours.
    return owner(node, record) == kReplaced ? kNoCorner : beyond;
  }

  Children children(NodeNumber node) const {
    const std::uint32_t family = family_of(node);
    if ((family & 3) == 0 || family == kAbandoned) return {};
    return {family >> 2, (family & 3) + 1};
  }
  bool is_leaf(NodeNumber node) const { return (family_of(node) & 3) == 0; }
  bool is_abandoned(NodeNumber node) const { return family_of(node) == kAbandoned; }
  // The leaf's record has no node any more. REQUIRES: consecutive numbers, then kNoNode.
  void set_children(NodeNumber leaf, const std::array<NodeNumber, kCorners>& children) {
    std::uint32_t last = kCorners - 1;
    while (children[last] == kNoNode) --last;
    assert(last > 0 && children[last] == children[0] + last);
    atomic(nodes_[leaf].family).store(children[0] << 2 | last, std::memory_order_release);
  }
  // The slot was never used, or its insertion was undone.
  void abandon(NodeNumber node) {
    atomic(nodes_[node].family).store(kAbandoned, std::memory_order_release);
  }

  // 1 + the number of the thread that has locked what is or was the record of a node, 0, or
  // kReplaced.
  std::uint32_t owner(NodeNumber node, RecordNumber record) const {
    return owner_in(atomic(records_[record].lock).load(std::memory_order_acquire), node);
  }
  // Makes it the thread's if it is free. Returns the owner before: 0 on success.
  std::uint32_t try_lock(NodeNumber node, RecordNumber record, std::uint32_t thread) {
    const std::atomic_ref<std::uint64_t> lock = atomic(records_[record].lock);
    // Mostly the thread itself is the owner, and looking is cheaper than trying.
    std::uint64_t before = lock.load(std::memory_order_acquire);
    if (before == node) {
      lock.compare_exchange_strong(before, lock_of(node, thread), std::memory_order_acq_rel,
                                   std::memory_order_acquire);
    }
    return owner_in(before, node);
  }
  // `node` is kNoNode if the record does not serve it any more. REQUIRES: locked by the caller, or
  // nobody else knows of the node.
  void set_owner(NodeNumber node, RecordNumber record, std::uint32_t owner) {
    atomic(records_[record].lock).store(lock_of(node, owner), std::memory_order_release);
  }

 private:
  static constexpr std::uint32_t kAbandoned = 0xffffffffU;  // would be children beyond the last

  static std::uint64_t lock_of(NodeNumber node, std::uint32_t owner) {
    return std::uint64_t{owner} << 32 | node;
  }
  static std::uint32_t owner_in(std::uint64_t lock, NodeNumber node) {
    return static_cast<NodeNumber>(lock) == node ? static_cast<std::uint32_t>(lock >> 32)
                                                 : kReplaced;
  }
  std::uint32_t family_of(NodeNumber node) const {
    return atomic(nodes_[node].family).load(std::memory_order_acquire);
  }
  template <class Number>
  static std::atomic_ref<Number> atomic(Number& number) {
    return std::atomic_ref<Number>(number);
  }

  std::mutex growing_;
  std::vector<std::uint32_t> created_by_;  // of each kCacheSize nodes
  internal::GrowingArray<Node> nodes_;
  internal::GrowingArray<Record> records_;
};

}  // namespace delray::delaunay
