// Slots of the history that one thread takes at a time.
#pragma once

#include <array>
#include <vector>

#include "delaunay/dag.h"

namespace delray::delaunay::internal {

template <int D>
class NodeCache {
 public:
  NodeCache(Dag<D>& dag, std::uint32_t maker) : dag_(dag), maker_(maker) {}
  ~NodeCache() { abandon_rest(); }
  NodeCache(const NodeCache&) = delete;
  NodeCache& operator=(const NodeCache&) = delete;

  // Makes the next `count` nodes consecutive.
  void reserve(NodeNumber count) {
    if (end_ - next_ >= count) return;
    abandon_rest();
    next_ = dag_.allocate(maker_);
    end_ = next_ + Dag<D>::kCacheSize;
    begin_ = next_;
  }
  // From now on nodes that exist are not new any more.
  void begin_insertion() { begin_ = next_; }
  // Whether a node was certainly created since then.
  bool is_new(NodeNumber node) const { return node >= begin_ && node < next_; }
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
  std::uint32_t maker_;
  NodeNumber begin_ = 0, next_ = 0, end_ = 0;
  RecordNumber next_record_ = 0, end_record_ = 0;
  std::vector<RecordNumber> free_;  // the one used last comes first, and is in the cache
};

}  // namespace delray::delaunay::internal
