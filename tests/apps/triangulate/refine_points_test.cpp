// delray triangulate --min-angle and --max-area, and delray generate outline.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/run_program.h"

namespace delray::tests {
namespace {

using nlohmann::json;

TEST(RefineCommand, RefinesAnOutlineAndSaysWhatWasReached) {
  const Folder folder;
  ASSERT_EQ(
      run("delray generate outline lake -n 200 --seed 3 -o lake.poly", folder.path()).exit_code, 0);
  const Ran ran =
      run("delray triangulate lake.poly --min-angle 25 --max-area 0.001 -o lake.node --stats -",
          folder.path());
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const json stats = json::parse(ran.out);
  EXPECT_EQ(stats["schema"], "delray.triangulate/1");
  EXPECT_EQ(stats["options"]["method"], "refine");
  const json& reached = stats["refinement"];
  EXPECT_GE(reached["min_angle"], 25.0);
  EXPECT_LE(reached["max_area"], 0.001);
  EXPECT_EQ(reached["points"], stats["input"]["points"].get<int>() +
                                   reached["on_segments"].get<int>() +
                                   reached["inside"].get<int>());
  EXPECT_TRUE(reached["small_corners"].is_array());
  EXPECT_NE(ran.err.find("angles from"), std::string::npos) << ran.err;
  EXPECT_EQ(run("delray verify lake.node --points lake.node --part", folder.path()).exit_code, 0);
  EXPECT_EQ(run("delray verify lake.node --points lake.node", folder.path()).exit_code, 4);
  // The domain is a part of the triangulation, all of which verifies.
  const Ran whole =
      run("delray triangulate lake.poly --min-angle 25 --whole -o whole.ply", folder.path());
  ASSERT_EQ(whole.exit_code, 0) << whole.err;
  EXPECT_EQ(run("delray verify whole.ply --points whole.ply --canonical", folder.path()).exit_code,
            0);
}

TEST(RefineCommand, RefinesPointsWithHeights) {
  const Folder folder;
  ASSERT_EQ(run("delray generate points terrain -n 300 --dim 3 -o t.xyz", folder.path()).exit_code,
            0);
  const Ran ran =
      run("delray triangulate t.xyz --max-area 0.002 -o t.ply --stats -", folder.path());
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const json stats = json::parse(ran.out);
  EXPECT_GE(stats["refinement"]["min_angle"], 20.0);
  EXPECT_LE(stats["refinement"]["max_area"], 0.002);
}

// Threads and processes of so many ranks write the same bytes.
TEST(RefineCommand, RanksRefineTogether) {
  const Folder folder;
  ASSERT_EQ(
      run("delray generate outline country -n 200 --seed 3 -o c.poly", folder.path()).exit_code, 0);
  const std::string refine = "delray triangulate c.poly --min-angle 25 --max-area 0.001 --whole ";
  const Ran ran = run(refine + "--ranks 3 --threads 1 -o threads.ply --stats -", folder.path());
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const json stats = json::parse(ran.out);
  EXPECT_EQ(stats["options"]["ranks"], 3);
  const json& reached = stats["refinement"];
  EXPECT_GE(reached["min_angle"], 25.0);
  EXPECT_LE(reached["max_area"], 0.001);
  EXPECT_GE(reached["rounds"], 1);
  ASSERT_EQ(reached["ranks"].size(), 3U);
  int points = 0;
  for (const json& rank : reached["ranks"]) {
    points += rank["points"].get<int>();
    EXPECT_GT(rank["bytes"], 0);
  }
  EXPECT_LE(points, reached["on_segments"].get<int>() + reached["inside"].get<int>());
  EXPECT_EQ(
      run("delray verify threads.ply --points threads.ply --canonical", folder.path()).exit_code,
      0);
  const Ran processes = run(mpirun(3) + refine + "--threads 1 -o processes.ply", folder.path());
  ASSERT_EQ(processes.exit_code, 0) << processes.err;
  EXPECT_EQ(folder.read("threads.ply"), folder.read("processes.ply"));
}

// A rank that cannot go on keeps no other waiting.
TEST(RefineCommand, RanksEndTogether) {
  const Folder folder;
  folder.write("open.poly", "3 2 0 0\n0 0 0\n1 1 0\n2 0 1\n2 0\n0 0 1\n1 1 2\n0\n");
  folder.write("good.poly", "3 2 0 0\n0 0 0\n1 1 0\n2 0 1\n3 0\n0 0 1\n1 1 2\n2 2 0\n0\n");
  for (const std::string& program :
       {std::string("delray triangulate --ranks 2 "), mpirun(2) + "delray triangulate "}) {
    Ran ran = run(program + "open.poly --min-angle 20 -o b.ply", folder.path());
    EXPECT_EQ(ran.exit_code, 3) << ran.err;
    EXPECT_NE(ran.err.find("open.poly: the segments enclose nothing"), std::string::npos)
        << ran.err;
    ran = run(program + "none.poly --min-angle 20 -o b.ply", folder.path());
    EXPECT_EQ(ran.exit_code, 3) << ran.err;
    ran = run(program + "good.poly --max-area 1e-9 --memory 200MiB -o b.ply", folder.path());
    EXPECT_EQ(ran.exit_code, 1) << ran.err;
    EXPECT_NE(ran.err.find("more than"), std::string::npos) << ran.err;
  }
  EXPECT_EQ(folder.files(), (std::vector<std::string>{"good.poly", "open.poly"}));
}

TEST(RefineCommand, WhatDoesNotGoTogetherIsRefused) {
  const Folder folder;
  folder.write("a.xyz", "0 0\n1 0\n1 1\n0 1\n");
  for (const char* options :
       {"--min-angle 31", "--min-angle x", "--max-area 0", "--min-angle 20 --dim 3",
        "--min-angle 20 --tiles 2", "--min-angle 20 --ranks 2 --refinement ruppert",
        "--min-angle 20 --record r.json", "--min-angle 20 --method sweep", "--whole",
        "--refinement ruppert", "--min-angle 20 --refinement none", "--min-angle 20 --seed 7"}) {
    const Ran ran = run(std::string("delray triangulate a.xyz -o b.ply ") + options, folder.path());
    EXPECT_EQ(ran.exit_code, 2) << options << ": " << ran.err;
  }
  EXPECT_EQ(folder.files(), std::vector<std::string>{"a.xyz"});
}

TEST(RefineCommand, BadOutlinesAndTooManyPointsEndWithTheirCodes) {
  const Folder folder;
  folder.write("open.poly", "3 2 0 0\n0 0 0\n1 1 0\n2 0 1\n2 0\n0 0 1\n1 1 2\n0\n");
  folder.write("broken.poly", "3 2 0 0\n0 0 0\n1 1 0\n2 0 1\n1 0\n0 0 9\n");
  folder.write("good.poly", "3 2 0 0\n0 0 0\n1 1 0\n2 0 1\n3 0\n0 0 1\n1 1 2\n2 2 0\n0\n");
  Ran ran = run("delray triangulate open.poly --min-angle 20 -o b.ply", folder.path());
  EXPECT_EQ(ran.exit_code, 3) << ran.err;
  EXPECT_NE(ran.err.find("open.poly: the segments enclose nothing"), std::string::npos) << ran.err;
  ran = run("delray triangulate broken.poly --min-angle 20 -o b.ply", folder.path());
  EXPECT_EQ(ran.exit_code, 3) << ran.err;
  EXPECT_NE(ran.err.find("broken.poly: line 6"), std::string::npos) << ran.err;
  ran = run("delray triangulate good.poly --max-area 1e-9 --memory 200MiB -o b.ply", folder.path());
  EXPECT_EQ(ran.exit_code, 1) << ran.err;
  EXPECT_NE(ran.err.find("more than"), std::string::npos) << ran.err;
  ran = run("delray triangulate good.poly -o b.off", folder.path());
  EXPECT_EQ(ran.exit_code, 0);
  EXPECT_NE(ran.err.find("3 segments left out"), std::string::npos) << ran.err;
  EXPECT_EQ(folder.files(),
            (std::vector<std::string>{"b.off", "broken.poly", "good.poly", "open.poly"}));
}

}  // namespace
}  // namespace delray::tests
