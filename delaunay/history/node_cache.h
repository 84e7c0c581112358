// Slots of the history that one thread takes at a time.
#pragma once

#include <array>
#include <vector>

#include "delaunay/flip/dag.h"

namespace delray::delaunay::internal {

template <int D>
class NodeCache {
 public:
  NodeCache(Dag<D>& dag, std::uint32_t thread) : dag_(dag), thread_(thread) {}
  ~NodeCache() { abandon_rest(); }
  NodeCache(const NodeCache&) = delete;
  NodeCache& operator=(const NodeCache&) = delete;

  // Makes the next `count` nodes consecutive.
  void reserve(NodeNumber count) {
    if (end_ - next_ >= count) return;
    if (begin_ != next_) earlier_.push_back({begin_, next_});
    abandon_rest();
    next_ = dag_.allocate(thread_);
    end_ = next_ + Dag<D>::kCacheSize;
    begin_ = next_;
  }
  // Whether a node was created since the last call of forget_new().
  bool is_new(NodeNumber node) const {
    if (node >= begin_ && node < next_) return true;
    for (const Nodes& nodes : earlier_) {
      if (node >= nodes.first && node < nodes.last) return true;
    }
    return false;
  }
  void forget_new() {
    begin_ = next_;
    earlier_.clear();
  }
  // A leaf. REQUIRES: reserved.
  NodeNumber create(const std::array<VertexNumber, D + 1>& vertices, std::uint32_t owner) {
    const NodeNumber node = next_++;
    dag_.set_leaf(node, vertices, take_record(), owner);
    return node;
  }
  // Lets a record serve another leaf. REQUIRES: it serves none, and no thread holds it locked but
  // this one.
  void recycle(RecordNumber record) { free_.push_back(record); }

 private:
  struct Nodes {
    NodeNumber first, last;  // [first, last)
  };

  RecordNumber take_record() {
    if (!free_.empty()) {
      const RecordNumber record = free_.back();
      free_.pop_back();
      return record;
    }
    if (next_record_ == end_record_) {
      next_record_ = dag_.allocate_records();
      end_record_ = next_record_ + Dag<D>::kCacheSize;
    }
    return next_record_++;
  }
  void abandon_rest() {
    while (next_ != end_) dag_.abandon(next_++);
  }

  Dag<D>& dag_;
  std::uint32_t thread_;
  NodeNumber begin_ = 0, next_ = 0, end_ = 0;
  std::vector<Nodes> earlier_;  // new ones, apart from [begin_, next_)
  RecordNumber next_record_ = 0, end_record_ = 0;
  std::vector<RecordNumber> free_;  // the one used last comes first, and is in the cache
};

}  // namespace delray::delaunay::internal
