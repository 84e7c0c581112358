// The points that threads insert at the moment, and which thread waits for which of them.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <vector>

#include "delaunay/mesh/mesh.h"

namespace delray::delaunay::internal {

constexpr VertexNumber kNoVertex = 0xffffffffU;

class CurrentPoints {
 public:
  explicit CurrentPoints(std::size_t threads) : points_(threads), awaited_(threads) {}

  std::size_t threads() const { return points_.size(); }

  // If two threads set a point and then look at the other's, at least one sees it: all of
  // these are in one order.
  void set(std::size_t thread, VertexNumber vertex) { points_[thread].vertex.store(vertex); }
  VertexNumber of(std::size_t thread) const { return points_[thread].vertex.load(); }

  // Notes that `thread` will wait until `other` is done with `vertex`, unless that would close a
  // circle: then returns false, and `other` waits until `thread` is done with its point.
  bool enter(std::size_t thread, std::size_t other, VertexNumber vertex) {
    const std::lock_guard guard(mutex_);
    Awaited wanted = {other, vertex};
    // A thread whose wish is fulfilled is about to go on, and one without a wish runs.
    while (wanted.vertex != kNoVertex && of(wanted.thread) == wanted.vertex) {
      if (wanted.thread == thread) return false;
      wanted = awaited_[wanted.thread];
    }
    awaited_[thread] = {other, vertex};
    return true;
  }
  void leave(std::size_t thread) {
    const std::lock_guard guard(mutex_);
    awaited_[thread] = {};
  }

 private:
  static constexpr std::size_t kCacheLine = 64;

  struct alignas(kCacheLine) Current {
    std::atomic<VertexNumber> vertex = kNoVertex;
  };
  struct Awaited {
    std::size_t thread = 0;
    VertexNumber vertex = kNoVertex;
  };

  std::vector<Current> points_;
  std::mutex mutex_;
  std::vector<Awaited> awaited_;
};

}  // namespace delray::delaunay::internal
