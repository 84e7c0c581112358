// One picture, however the work is shared out. A part of the product in every run; with
// DELRAY_FULL_TESTS (`./test --full`) all of it.
#include "raster/combinations.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <random>
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
  // Without it every combination is looked at for some kinds, one in so many, each with some number
  // of ranks and threads. Some combinations have twelve kinds; those of a kind recur by fours.
#ifdef __SANITIZE_THREAD__
  constexpr std::size_t kOneIn = 11;
#else
  constexpr std::size_t kOneIn = 7;
#endif
  const std::size_t one_in = full ? 1 : kOneIn;
  struct Looked {
    std::size_t kinds, times;
  };
  std::map<std::string, Looked> looked;
  std::mt19937 random(20261129);
  for (const KindOfPicture& kind : kinds_of_picture(53, 39)) {
    const Picture expected = rendered(kind, kind.options, 1, 1);
    for (const RenderOptions& options : combinations(kind.options)) {
      // Combinations begin at kinds of their own.
      Looked& of_it = looked.try_emplace(name_of(options), Looked{looked.size(), 0}).first->second;
      if (++of_it.kinds % one_in != 0) continue;
      ++of_it.times;
      const int some_ranks = 1 + static_cast<int>(random() % 9);
      const int some_threads = 1 + static_cast<int>(random() % 3);
      for (int ranks = full ? 1 : some_ranks; ranks <= (full ? 9 : some_ranks); ++ranks) {
        for (int threads = full ? 1 : some_threads; threads <= (full ? 3 : some_threads);
             ++threads) {
          ASSERT_TRUE(same_bytes(rendered(kind, options, ranks, threads), expected))
              << kind.name << ": " << name_of(options) << " " << ranks << " x " << threads;
        }
      }
    }
  }
  for (const auto& [name, of_it] : looked) EXPECT_GE(of_it.times, 1U) << name;
  EXPECT_EQ(looked.size(), combinations({}).size());
}

}  // namespace
}  // namespace delray::raster
