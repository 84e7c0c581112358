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

// Ranks have ascending intervals of primitives, of equal size in the first frame and then of equal
// work, as far as the work of the last frame tells. One per rank; rank 0's remembers and decides.
class PrimitiveShares {
 public:
  // This rank's interval [begin, end) of the next frame; those of all ranks cover all primitives
  // once. Equal shares where any rank was not part of the last frame, or has not measured it.
  // Collective: to rank 0 16 to 32 KiB from all ranks together, of more than 64 ranks 256 to 528
  // bytes from each, and 32; 8 for each rank back. O(ranks + segments) there.
  std::pair<std::uint64_t, std::uint64_t> next(comm::Communicator& communicator,
                                               std::uint64_t primitives);

  // Remembers the work, in any unit, that this rank had with its interval: so much for each
  // primitive, and `work_seen` for what is seen of them, spread evenly over the primitives `seen`,
  // samples of it, repeated where more is seen of one. If there are none, it is spread evenly over
  // the interval. O(samples).
  //
  // REQUIRES: finite, >= 0; samples ascend, and are of the interval. For the interval of next(),
  // once.
  void measure(double work_each, double work_seen, std::span<const std::uint64_t> seen);

 private:
  // What a rank had in the last frame: the work with the primitives from the end of one segment, or
  // `begin`, up to the end of the next.
  struct Segment {
    std::uint64_t end = 0;
    double work = 0;
  };
  struct Done {
    std::uint64_t begin = 0, end = 0;
    std::vector<Segment> segments;
  };

  bool remembers(std::span<const Done> done, std::uint64_t primitives) const;
  void cut(std::span<const Done> done);

  int ranks_ = 1;
  Done last_;                        // this rank's last frame
  std::vector<std::uint64_t> cuts_;  // on rank 0: where intervals begin, and the end
};

}  // namespace delray::raster
