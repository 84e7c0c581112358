// A bounded queue with one writer and one reader.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <vector>

#include "delaunay/flip/dag.h"

namespace delray::delaunay::internal {

// A point and a node that contains it.
struct Request {
  VertexNumber vertex;
  NodeNumber node;
};

// Neither end ever waits here; each says whether it could. The ends touch each other's counter only
// when their own view of it says full or empty (Lamport 1983).
class RequestQueue {
 public:
  explicit RequestQueue(std::size_t places) : requests_(std::max<std::size_t>(places, 1)) {}

  // The writer's, who may use so many of the places for now.
  bool put(const Request& request, std::size_t places) {
    places = std::clamp<std::size_t>(places, 1, requests_.size());
    if (written_ - seen_read_ >= places) {
      seen_read_ = shared_read_.load(std::memory_order_acquire);
      if (written_ - seen_read_ >= places) return false;
    }
    requests_[written_++ % requests_.size()] = request;
    shared_written_.store(written_, std::memory_order_release);
    return true;
  }
  // The reader's.
  bool take(Request& request) {
    if (read_ == seen_written_) {
      seen_written_ = shared_written_.load(std::memory_order_acquire);
      if (read_ == seen_written_) return false;
    }
    request = requests_[read_++ % requests_.size()];
    shared_read_.store(read_, std::memory_order_release);
    return true;
  }

 private:
  static constexpr std::size_t kCacheLine = 64;

  std::vector<Request> requests_;
  alignas(kCacheLine) std::size_t written_ = 0;
  std::size_t seen_read_ = 0;
  alignas(kCacheLine) std::size_t read_ = 0;
  std::size_t seen_written_ = 0;
  alignas(kCacheLine) std::atomic<std::size_t> shared_written_{0};
  alignas(kCacheLine) std::atomic<std::size_t> shared_read_{0};
};

}  // namespace delray::delaunay::internal
