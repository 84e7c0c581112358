// The history of a triangulation: every simplex that ever was, with those that replaced it.
//
// Nodes are simplices; a node without children is a leaf, a simplex of the triangulation as it is
// now. A node's vertices never change and its slot is never used again: it is written, made
// reachable, and later given children, once. So any number of threads may go down the graph while
// others insert points, and a thread that comes to a simplex too late finds its children there.
// (The report's leaves are modified in place, and it keeps bits that say which children are leaves;
// here the list of children says it.) Only leaves have neighbours that mean something.
#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <new>
#include <vector>

#include "delaunay/array.h"
#include "delaunay/mesh.h"

namespace delray::delaunay {

using NodeNumber = std::uint32_t;  // below 2^30; corners are numbered as in a mesh

constexpr NodeNumber kNoNode = 0xffffffffU;
// In place of the first child: the slot was never used, or its insertion was undone.
constexpr NodeNumber kAbandoned = 0xfffffffeU;

template <int D>
class Dag {
 public:
  static constexpr unsigned kCorners = D + 1;
  // Slots are given to threads by so many at a time (Kohout 2004, 7.1).
  static constexpr NodeNumber kCacheSize = 512;

  // Vertices first, beside the children: going down needs nothing else.
  struct Node {
    std::array<VertexNumber, kCorners> vertices;
    std::array<NodeNumber, kCorners> children;
    std::array<CornerNumber, kCorners> neighbours;
    std::uint32_t owner;  // 1 + the number of the thread that has locked it, or 0
  };

  // The first of kCacheSize slots for the calling thread alone, which calls itself `maker`. Errors:
  // std::bad_alloc, also for more than kMaximumSimplices nodes.
  NodeNumber allocate(std::uint32_t maker) {
    const std::lock_guard guard(growing_);
    if (size_ + kCacheSize > kMaximumSimplices) throw std::bad_alloc();
    const unsigned block = block_of(size_);
    if (bases_[block] == nullptr) {
      blocks_[block] = Array<Node>(std::size_t{kFirstBlock} << block);
      bases_[block] = blocks_[block].data();
    }
    makers_.push_back(maker);
    const NodeNumber first = size_;
    size_ += kCacheSize;
    return first;
  }

  // Slots that were handed out. REQUIRES for this and the next three: no thread inserts.
  NodeNumber size() const { return size_; }
  // Whether a slot holds a simplex of the triangulation.
  bool is_live(NodeNumber node) const { return slot(node).children[0] == kNoNode; }
  bool is_ghost(NodeNumber node) const {
    bool ghost = false;
    for (const VertexNumber vertex : slot(node).vertices) ghost |= vertex == kInfiniteVertex;
    return ghost;
  }

  std::uint32_t maker(NodeNumber node) const { return makers_[node / kCacheSize]; }

  VertexNumber vertex(CornerNumber corner) const {
    return slot(simplex_of(corner)).vertices[corner & 3];
  }
  // Makes a slot a leaf. REQUIRES: it is the caller's alone.
  void set_leaf(NodeNumber node, const std::array<VertexNumber, kCorners>& vertices,
                std::uint32_t owner) {
    Node& slot = this->slot(node);
    slot.vertices = vertices;
    slot.children.fill(kNoNode);
    set_owner(node, owner);
  }

  CornerNumber neighbour(CornerNumber corner) const {
    return atomic(slot(simplex_of(corner)).neighbours[corner & 3]).load(std::memory_order_acquire);
  }
  void set_neighbour(CornerNumber corner, CornerNumber beyond) {
    atomic(slot(simplex_of(corner)).neighbours[corner & 3])
        .store(beyond, std::memory_order_release);
  }

  // Child k, or kNoNode. The first is written last, so whoever sees it sees the others.
  NodeNumber child(NodeNumber node, unsigned k) const {
    return atomic(slot(node).children[k]).load(std::memory_order_acquire);
  }
  bool is_leaf(NodeNumber node) const { return child(node, 0) == kNoNode; }
  void set_children(NodeNumber node, const std::array<NodeNumber, kCorners>& children) {
    Node& slot = this->slot(node);
    for (unsigned k = kCorners; k-- > 0;) {
      atomic(slot.children[k]).store(children[k], std::memory_order_release);
    }
  }
  void abandon(NodeNumber node) {
    atomic(slot(node).children[0]).store(kAbandoned, std::memory_order_release);
  }

  std::uint32_t owner(NodeNumber node) const {
    return atomic(slot(node).owner).load(std::memory_order_acquire);
  }
  void set_owner(NodeNumber node, std::uint32_t owner) {
    atomic(slot(node).owner).store(owner, std::memory_order_release);
  }
  // Makes a free node the thread's. Returns the owner before: 0 on success.
  std::uint32_t try_lock(NodeNumber node, std::uint32_t thread) {
    std::uint32_t before = 0;
    atomic(slot(node).owner)
        .compare_exchange_strong(before, thread, std::memory_order_acq_rel,
                                 std::memory_order_acquire);
    return before;
  }

 private:
  // Blocks double in size, so that a handful of pointers leads to all nodes and none ever moves.
  static constexpr NodeNumber kFirstBlock = 1024;
  static constexpr unsigned kBlocks = 21;
  static_assert(kFirstBlock % kCacheSize == 0);

  static unsigned block_of(NodeNumber node) {
    return static_cast<unsigned>(std::bit_width(node + kFirstBlock) - std::bit_width(kFirstBlock));
  }
  Node& slot(NodeNumber node) const {
    const unsigned block = block_of(node);
    return bases_[block][node + kFirstBlock - (kFirstBlock << block)];
  }
  static std::atomic_ref<std::uint32_t> atomic(std::uint32_t& number) {
    return std::atomic_ref<std::uint32_t>(number);
  }

  std::mutex growing_;
  NodeNumber size_ = 0;
  std::vector<std::uint32_t> makers_;  // of each kCacheSize slots
  std::array<Node*, kBlocks> bases_{};
  std::array<Array<Node>, kBlocks> blocks_;
};

}  // namespace delray::delaunay
