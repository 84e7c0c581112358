// A random sample of points that lie anywhere: what space is cut into tiles by.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "comm/communicator.h"

namespace delray::delaunay {

// Keeps the points whose numbers' hashes are lowest: all of them while they are few, and half of
// those kept whenever they are too many (Knuth 1998, 3.4.2, by hash). Which points these are
// depends on the numbers alone, so that samples of parts make up the sample of the whole.
class PointSample {
 public:
  // REQUIRES: most >= 1.
  explicit PointSample(std::size_t most) : most_(most) {}

  // Points have different numbers.
  void add(std::uint64_t number, const glm::dvec3& place) {
    const std::uint64_t hash = hash_of(number);
    if (hash <= highest_) keep(hash, place);
  }
  void add(const PointSample& other);

  std::size_t size() const { return kept_.size(); }

  // Collective: the sample of all ranks' points, on rank 0; empty on others. Each rank gives the
  // same `most`. O(sizes), and 512 bytes among ranks besides.
  std::vector<glm::dvec3> gather(comm::Communicator& communicator) &&;

 private:
  struct Kept {
    std::uint64_t hash;
    glm::dvec3 place;
  };

  static std::uint64_t hash_of(std::uint64_t number) {  // SplitMix64's (Steele et al. 2014)
    number += 0x9e3779b97f4a7c15;
    number = (number ^ (number >> 30)) * 0xbf58476d1ce4e5b9;
    number = (number ^ (number >> 27)) * 0x94d049bb133111eb;
    return number ^ (number >> 31);
  }
  void keep(std::uint64_t hash, const glm::dvec3& place) {
    kept_.push_back({hash, place});
    while (kept_.size() > most_ && highest_ > 0) lower(highest_ / 2);
  }
  void lower(std::uint64_t highest);

  std::size_t most_;
  std::uint64_t highest_ = ~std::uint64_t{0};  // hash that is kept: 2^k - 1
  std::vector<Kept> kept_;
};

}  // namespace delray::delaunay
