// Slots of the history that one thread takes at a time.
#pragma once

#include "delaunay/dag.h"

namespace delray::delaunay::internal {

template <int D>
class NodeCache {
 public:
  explicit NodeCache(std::uint32_t maker) : maker_(maker) {}

  NodeNumber take(Dag<D>& dag) {
    if (next_ == end_) {
      next_ = dag.allocate(maker_);
      end_ = next_ + Dag<D>::kCacheSize;
    }
    return next_++;
  }
  // Makes the next `count` slots consecutive.
  void reserve(Dag<D>& dag, NodeNumber count) {
    if (end_ - next_ >= count) return;
    abandon_rest(dag);
    next_ = dag.allocate(maker_);
    end_ = next_ + Dag<D>::kCacheSize;
  }
  // Marks what was not used. To be called at the end.
  void abandon_rest(Dag<D>& dag) {
    while (next_ != end_) dag.abandon(next_++);
  }

 private:
  std::uint32_t maker_;
  NodeNumber next_ = 0, end_ = 0;
};

}  // namespace delray::delaunay::internal
