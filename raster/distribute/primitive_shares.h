// Which primitives each rank of sort-last draws, over the frames of an animation.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "comm/communicator.h"

namespace delray::raster {

// The first of `all` primitives that rank k of `holders` has where all have equally many, in order:
// the first all % holders ranks have one more. REQUIRES: 0 <= k <= holders; holders >= 1.
std::uint64_t begin_of_equal_share(std::uint64_t all, int holders, int k);

// Ranks have ascending intervals of primitives, of equal size in the first frame and then moved
// towards equal work by what each rank did in the frames before. One per rank; rank 0's remembers
// and decides.
class PrimitiveShares {
 public:
  // This rank's interval [begin, end) of the next frame; those of all ranks cover all primitives
  // once. Equal shares where any rank was not part of the last frame. Collective: 24 bytes to rank
  // 0 and 8 for each rank back. O(ranks + 1024).
  std::pair<std::uint64_t, std::uint64_t> next(comm::Communicator& communicator,
                                               std::uint64_t primitives);

  // Remembers the work, in any unit, that this rank had with its interval. REQUIRES: finite, >= 0.
  void measure(double work) { last_.work = work; }

 private:
  struct Done {
    std::uint64_t begin = 0, end = 0;
    double work = 0;
  };

  bool remembers(std::span<const Done> done, std::uint64_t primitives) const;
  void learn(std::span<const Done> done);
  void cut();

  Done last_;  // this rank's last frame
  // On rank 0: where intervals begin, and, after them, the number of primitives; the work that is
  // expected of each bucket, an equal part of all primitives.
  std::vector<std::uint64_t> cuts_;
  std::vector<double> work_of_bucket_;
};

}  // namespace delray::raster
