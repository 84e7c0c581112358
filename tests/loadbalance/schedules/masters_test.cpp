// How many ranks work below a master.
#include "loadbalance/schedules/masters.h"

#include <gtest/gtest.h>

#include <vector>

namespace delray::loadbalance::internal {
namespace {

TEST(MasterTree, CountsWhoWorksBelow) {
  for (const int fan_out : {1, 2, 3, 7, 40}) {
    for (int ranks = 1; ranks <= 30; ++ranks) {
      for (const bool masters_work : {true, false}) {
        const MasterTree tree{ranks, fan_out, masters_work};
        std::vector<int> seen(static_cast<std::size_t>(ranks));
        std::vector<std::uint64_t> workers(seen.size());
        for (int k = ranks - 1; k >= 0; --k) {
          const bool is_master = tree.first_below(k) < tree.end_below(k);
          workers[k] += masters_work || !is_master ? 1 : 0;
          EXPECT_EQ(tree.workers(k), workers[k]) << fan_out << ' ' << ranks << ' ' << k;
          if (k > 0) workers[tree.master(k)] += workers[k];
          for (int below = tree.first_below(k); below < tree.end_below(k); ++below) {
            EXPECT_EQ(tree.master(below), k);
            ++seen[below];
          }
        }
        for (int k = 1; k < ranks; ++k) EXPECT_EQ(seen[k], 1);
      }
    }
  }
}

}  // namespace
}  // namespace delray::loadbalance::internal
