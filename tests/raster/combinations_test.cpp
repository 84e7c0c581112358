// One picture, however the work is shared out. A part of the product in every run; with
// DELRAY_FULL_TESTS (`./test --full`) all of it.
#include "raster/combinations.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <set>

#include "comm/threads.h"
#include "raster/strategies.h"
#include "tests/raster/allow_threads.h"
#include "tests/raster/kinds_of_picture.h"

namespace delray::raster {
namespace {

Picture rendered(const KindOfPicture& kind, const RenderOptions& options, int ranks, int threads) {
  Picture picture;
  comm::run_threads(ranks, threads, [&](comm::Communicator& communicator) {
    Result mine = render(communicator, kind.scene, random_scene_camera(), options);
    if (communicator.rank() == 0) picture = std::move(mine.picture);
  });
  return picture;
}

TEST(Combinations, HaveNamesOfTheirOwnAndAllStrategies) {
  std::set<std::string> names, used;
  const std::vector<RenderOptions> ways = combinations({});
  for (const RenderOptions& way : ways) {
    names.insert(name_of(way));
    used.insert(way.strategy);
  }
  EXPECT_EQ(names.size(), ways.size());
  EXPECT_EQ(used.size(), strategies().size());
}

TEST(Combinations, GiveOnePicture) {
  const bool full = std::getenv("DELRAY_FULL_TESTS") != nullptr;
  // Without it every combination is looked at with some number of ranks and threads for some kinds.
#ifdef __SANITIZE_THREAD__
  constexpr int kStep = 1009;
#else
  constexpr int kStep = 101;
#endif
  const int step = full ? 1 : kStep;
  int turn = 0;
  for (const KindOfPicture& kind : kinds_of_picture(53, 39)) {
    const Picture expected = rendered(kind, kind.options, 1, 1);
    for (const RenderOptions& options : combinations(kind.options)) {
      for (int ranks = 1; ranks <= 9; ++ranks) {
        for (int threads = 1; threads <= 3; ++threads) {
          if (++turn % step != 0) continue;
          ASSERT_TRUE(same_bytes(rendered(kind, options, ranks, threads), expected))
              << kind.name << ": " << name_of(options) << " " << ranks << " x " << threads;
        }
      }
    }
  }
}

}  // namespace
}  // namespace delray::raster
