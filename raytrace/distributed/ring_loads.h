// Ring: when a rank tells the one before it how loaded it is, and when it gives a cluster to the
// one behind it, which told it the same (Kim et al. 1996: neighbours even out their loads).
#pragma once

#include <cstdint>

namespace delray::raytrace {

// Loads are rays against clusters so far; they only grow.
class RingLoads {
 public:
  // Rays against clusters from one telling, or giving, to the next at least.
  static constexpr std::uint64_t kTestsBetween = 8192;
  // A cluster changes rank where this one is so many times as loaded as the next.
  static constexpr double kMuchMore = 1.2;

  // Whether to tell now; if so it counts as told.
  bool tell(std::uint64_t load);
  void hear(std::uint64_t load_of_next) { next_ = load_of_next; }
  bool should_give(std::uint64_t load) const;
  void gave(std::uint64_t load) { given_at_ = load; }

 private:
  std::uint64_t next_ = kTestsBetween;  // at most that, until it tells
  std::uint64_t told_ = 0, given_at_ = 0;
};

}  // namespace delray::raytrace
