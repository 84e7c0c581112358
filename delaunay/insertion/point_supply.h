// The points of a plan, handed out to the threads that insert them.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "delaunay/mesh/mesh.h"

namespace delray::delaunay::internal {

// Thread i begins with part i, in order. One that is through with its own takes over the later half
// of what another has left, so that all end together, however fast their cores are.
class PointSupply {
 public:
  struct Points {
    VertexNumber first = 0, last = 0;  // [first, last)
    VertexNumber size() const { return last - first; }
  };

  explicit PointSupply(std::size_t parts) : left_(parts) {}
  // REQUIRES: nobody takes points yet.
  void set(std::size_t part, std::size_t first, std::size_t last) {
    left_[part].points.store(
        packed({static_cast<VertexNumber>(first), static_cast<VertexNumber>(last)}),
        std::memory_order_relaxed);
  }

  // Calls f(vertex) for points that nobody has taken until there are none.
  template <class F>
  void for_each(std::size_t thread, F&& f) {
    for (;;) {
      const Points points = take(thread);
      for (VertexNumber vertex = points.first; vertex < points.last; ++vertex) f(vertex);
      if (points.size() == 0 && !take_over(thread)) return;
    }
  }

 private:
  // Takes no time beside that of inserting them, and yet at the end nobody waits for more.
  static constexpr VertexNumber kTaken = 16;
  static constexpr std::size_t kCacheLine = 64;

  struct alignas(kCacheLine) Left {
    std::atomic<std::uint64_t> points = 0;
  };

  static std::uint64_t packed(Points points) {
    return std::uint64_t{points.last} << 32 | points.first;
  }
  static Points unpacked(std::uint64_t points) {
    return {static_cast<VertexNumber>(points), static_cast<VertexNumber>(points >> 32)};
  }

  // The next ones of the thread's own.
  Points take(std::size_t thread) {
    std::uint64_t before = left_[thread].points.load(std::memory_order_relaxed);
    for (;;) {
      const Points points = unpacked(before);
      const VertexNumber taken = points.size() < kTaken ? points.size() : kTaken;
      if (left_[thread].points.compare_exchange_weak(
              before, packed({points.first + taken, points.last}), std::memory_order_relaxed)) {
        return {points.first, points.first + taken};
      }
    }
  }
  // REQUIRES: the thread has none. Returns false if it still has.
  bool take_over(std::size_t thread) {
    for (;;) {
      std::size_t most = thread;
      std::uint64_t before = 0;
      for (std::size_t other = 0; other < left_.size(); ++other) {
        const std::uint64_t points = left_[other].points.load(std::memory_order_relaxed);
        if (unpacked(points).size() > unpacked(before).size()) {
          most = other;
          before = points;
        }
      }
      const Points points = unpacked(before);
      if (points.size() == 0) return false;
      const VertexNumber middle = points.first + points.size() / 2;
      // A range is never the same twice, since no point is put back.
      if (left_[most].points.compare_exchange_strong(before, packed({points.first, middle}),
                                                     std::memory_order_relaxed)) {
        left_[thread].points.store(packed({middle, points.last}), std::memory_order_relaxed);
        return true;
      }
    }
  }

  std::vector<Left> left_;
};

}  // namespace delray::delaunay::internal
