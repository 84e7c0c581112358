#include "apps/terminal/progress_text.h"

#include <gtest/gtest.h>

namespace delray::apps {
namespace {

constexpr std::size_t kWide = 200;

bool tells_time_left(const TaskState& state) {
  return progress_text("render", state, kWide).find("left") != std::string::npos;
}

TEST(ProgressText, TellsTheTimeLeftOnceThereIsSomethingToGoBy) {
  EXPECT_FALSE(tells_time_left({0, 1000, 5}));
  EXPECT_FALSE(tells_time_left({9, 1000, 5}));
  EXPECT_FALSE(tells_time_left({500, 1000, 0.5}));
  EXPECT_TRUE(tells_time_left({10, 1000, 5}));
  EXPECT_TRUE(tells_time_left({1000, 1000, 5}));
  EXPECT_FALSE(tells_time_left({7, 0, 5})) << "the total is not known";
}

TEST(ProgressText, EstimatesFromWhatIsDone) {
  EXPECT_EQ(progress_text("render", {25, 100, 10}, kWide),
            "render: [#######.......................]  25 %  30 s left");
  EXPECT_EQ(progress_text("render", {100, 100, 10}, kWide),
            "render: [##############################] 100 %  0 s left");
  EXPECT_EQ(progress_text("render", {1, 100, 10}, kWide),
            "render: [..............................]   1 %  16 min left");
  EXPECT_EQ(progress_text("render", {1, 100, 1000}, kWide),
            "render: [..............................]   1 %  28 h left");
  EXPECT_EQ(progress_text("render", {0, 100, 10}, kWide),
            "render: [..............................]   0 %");
  EXPECT_EQ(progress_text("render", {300, 100, 10}, kWide),
            "render: [##############################] 100 %  0 s left");
  EXPECT_EQ(progress_text("load", {3, 0, 10}, kWide), "load: 3  10 s");
}

TEST(ProgressText, FitsTheTerminal) {
  EXPECT_EQ(progress_text("render", {25, 100, 10}, 20), "render: [#######....");
  EXPECT_EQ(progress_text("render", {25, 100, 10}, 0), "");
}

}  // namespace
}  // namespace delray::apps
