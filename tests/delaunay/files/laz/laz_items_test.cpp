#include "delaunay/files/laz/laz_items.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace delray::delaunay::laz {
namespace {

// Five sorted numbers, as the published description has it: the new one takes the place of the
// greatest or of the smallest.
class PlainMedian {
 public:
  std::int32_t get() const { return sorted_[2]; }
  void add(std::int32_t value) {
    const bool above = drop_greatest_ ? value >= sorted_[2] : value > sorted_[2];
    // Those on the other side of the median stay, but for the displaced one.
    if (drop_greatest_) {
      sorted_[4] = value;
      std::sort(sorted_.begin() + (above ? 3 : 0), sorted_.begin() + (above ? 3 : 5));
      if (above && value < sorted_[3]) std::swap(sorted_[3], sorted_[4]);
    } else {
      sorted_[0] = value;
      if (above) std::sort(sorted_.begin(), sorted_.end());
      if (!above && value > sorted_[1]) std::swap(sorted_[0], sorted_[1]);
    }
    drop_greatest_ = !above;
  }

 private:
  std::vector<std::int32_t> sorted_ = std::vector<std::int32_t>(5);
  bool drop_greatest_ = true;
};

TEST(StreamingMedian, KeepsFiveNumbers) {
  std::mt19937 random(5);
  for (const int range : {3, 10, 1000}) {
    StreamingMedian median;
    PlainMedian plain;
    std::uniform_int_distribution<int> number(-range, range);
    for (int i = 0; i < 2000; ++i) {
      const int value = number(random);
      median.add(value);
      plain.add(value);
      ASSERT_EQ(median.get(), plain.get()) << "number " << i << " of range " << range;
    }
  }
}

}  // namespace
}  // namespace delray::delaunay::laz
