// The history of a triangulation: every simplex that ever was, with those that replaced it.
//
// Nodes are simplices; a node without children is a leaf, a simplex of the triangulation as it is
// now. A node's vertices never change and its slot is never used again: it is written, made
// reachable, and later given children, once. So any number of threads may go down the graph while
// others insert points, and a thread that comes to a simplex too late finds its children there.
// (The report's leaves are modified in place, and it keeps bits that say which children are leaves;
// here the list of children says it.) Only leaves have neighbours that mean something.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cassert>
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

  // All that going down needs. In the plane children are consecutive and take one number, 4 times
  // the first and how many they are: four nodes in a cache line.
  struct Node {
    std::array<VertexNumber, kCorners> vertices;
    std::array<NodeNumber, D == 2 ? 1 : kCorners> children;
  };
  // What only leaves need.
  struct Leaf {
    std::array<CornerNumber, kCorners> neighbours;
    std::uint32_t owner;  // 1 + the number of the thread that has locked it, or 0
  };
  static constexpr std::size_t kBytesPerNode = sizeof(Node) + sizeof(Leaf);

  // So many nodes will be found fastest.
  explicit Dag(std::size_t expected = 0)
      : first_block_(static_cast<NodeNumber>(
            std::bit_ceil(std::clamp<std::size_t>(expected, kSmallestBlock, kMaximumSimplices)))) {}

  // The first of kCacheSize slots for the calling thread alone, which calls itself `maker`. Errors:
  // std::bad_alloc, also for more than kMaximumSimplices nodes.
  NodeNumber allocate(std::uint32_t maker) {
    const std::lock_guard guard(growing_);
    if (size_ + kCacheSize > kMaximumSimplices) throw std::bad_alloc();
    const unsigned block = block_of(size_);
    if (bases_[block].nodes == nullptr) {
      const std::size_t slots = std::size_t{first_block_} << block;
      blocks_[block] = {Array<Node>(slots), Array<Leaf>(slots)};
      bases_[block] = {blocks_[block].nodes.data(), blocks_[block].leaves.data()};
    }
    makers_.push_back(maker);
    const NodeNumber first = size_;
    size_ += kCacheSize;
    return first;
  }

  // Slots that were handed out. REQUIRES for this and the next three: no thread inserts.
  NodeNumber size() const { return size_; }
  // Whether a slot holds a simplex of the triangulation.
  bool is_live(NodeNumber node) const { return this->node(node).children[0] == kNoNode; }
  bool is_ghost(NodeNumber node) const {
    bool ghost = false;
    for (const VertexNumber vertex : this->node(node).vertices) ghost |= vertex == kInfiniteVertex;
    return ghost;
  }

  std::uint32_t maker(NodeNumber node) const { return makers_[node / kCacheSize]; }

  VertexNumber vertex(CornerNumber corner) const {
    return node(simplex_of(corner)).vertices[corner & 3];
  }
  // Makes a slot a leaf. REQUIRES: it is the caller's alone.
  void set_leaf(NodeNumber node, const std::array<VertexNumber, kCorners>& vertices,
                std::uint32_t owner) {
    Node& slot = this->node(node);
    slot.vertices = vertices;
    slot.children.fill(kNoNode);
    set_owner(node, owner);
  }

  CornerNumber neighbour(CornerNumber corner) const {
    return atomic(leaf(simplex_of(corner)).neighbours[corner & 3]).load(std::memory_order_acquire);
  }
  void set_neighbour(CornerNumber corner, CornerNumber beyond) {
    atomic(leaf(simplex_of(corner)).neighbours[corner & 3])
        .store(beyond, std::memory_order_release);
  }

  // Child k, or kNoNode. The first is written last, so whoever sees it sees the others.
  NodeNumber child(NodeNumber node, unsigned k) const {
    if constexpr (D == 2) {
      const NodeNumber family =
          atomic(this->node(node).children[0]).load(std::memory_order_acquire);
      if (family >= kAbandoned) return k == 0 ? family : kNoNode;
      return k < (family & 3) ? (family >> 2) + k : kNoNode;
    } else {
      return atomic(this->node(node).children[k]).load(std::memory_order_acquire);
    }
  }
  bool is_leaf(NodeNumber node) const { return child(node, 0) == kNoNode; }
  // REQUIRES: in the plane, children with consecutive numbers.
  void set_children(NodeNumber node, const std::array<NodeNumber, kCorners>& children) {
    Node& slot = this->node(node);
    if constexpr (D == 2) {
      const NodeNumber count = children[2] == kNoNode ? 2 : 3;
      assert(children[1] == children[0] + 1 && (count == 2 || children[2] == children[0] + 2));
      atomic(slot.children[0]).store(children[0] << 2 | count, std::memory_order_release);
    } else {
      for (unsigned k = kCorners; k-- > 0;) {
        atomic(slot.children[k]).store(children[k], std::memory_order_release);
      }
    }
  }
  void abandon(NodeNumber node) {
    atomic(this->node(node).children[0]).store(kAbandoned, std::memory_order_release);
  }

  std::uint32_t owner(NodeNumber node) const {
    return atomic(leaf(node).owner).load(std::memory_order_acquire);
  }
  void set_owner(NodeNumber node, std::uint32_t owner) {
    atomic(leaf(node).owner).store(owner, std::memory_order_release);
  }
  // Makes a free node the thread's. Returns the owner before: 0 on success.
  std::uint32_t try_lock(NodeNumber node, std::uint32_t thread) {
    const std::atomic_ref<std::uint32_t> owner = atomic(leaf(node).owner);
    // Mostly the thread itself is the owner, and looking is cheaper than trying.
    std::uint32_t before = owner.load(std::memory_order_acquire);
    if (before == 0) {
      owner.compare_exchange_strong(before, thread, std::memory_order_acq_rel,
                                    std::memory_order_acquire);
    }
    return before;
  }

 private:
  // Blocks double in size, so that a handful of pointers leads to all nodes and none ever moves.
  static constexpr NodeNumber kSmallestBlock = 1024;
  static constexpr unsigned kBlocks = 21;
  static_assert(kSmallestBlock % kCacheSize == 0);

  struct Block {
    Array<Node> nodes;
    Array<Leaf> leaves;
  };
  struct Base {
    Node* nodes = nullptr;
    Leaf* leaves = nullptr;
  };

  unsigned block_of(NodeNumber node) const {
    return static_cast<unsigned>(std::bit_width(node / first_block_ + 1) - 1);
  }
  NodeNumber place_in(unsigned block, NodeNumber node) const {
    return node + first_block_ - (first_block_ << block);
  }
  Node& node(NodeNumber node) const {
    return node < first_block_ ? bases_[0].nodes[node] : far_node(node);
  }
  Leaf& leaf(NodeNumber node) const {
    return node < first_block_ ? bases_[0].leaves[node] : far_leaf(node);
  }
  // Apart, so that the rest is small enough to be inlined everywhere.
  [[gnu::noinline]] Node& far_node(NodeNumber node) const {
    const unsigned block = block_of(node);
    return bases_[block].nodes[place_in(block, node)];
  }
  [[gnu::noinline]] Leaf& far_leaf(NodeNumber node) const {
    const unsigned block = block_of(node);
    return bases_[block].leaves[place_in(block, node)];
  }
  static std::atomic_ref<std::uint32_t> atomic(std::uint32_t& number) {
    return std::atomic_ref<std::uint32_t>(number);
  }

  std::mutex growing_;
  NodeNumber size_ = 0;
  std::vector<std::uint32_t> makers_;  // of each kCacheSize slots
  NodeNumber first_block_;
  std::array<Base, kBlocks> bases_{};
  std::array<Block, kBlocks> blocks_;
};

}  // namespace delray::delaunay
