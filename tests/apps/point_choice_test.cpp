// Several files of points as one input of the program, and options that choose points.
#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/run_program.h"

namespace delray::tests {
namespace {

using nlohmann::json;

// A lattice of so many columns and rows, with the class of its column.
std::string classified(int columns, int rows, int first_row) {
  std::string text = "x,y,z,class\n";
  for (int i = 0; i < columns * rows; ++i) {
    const int x = i % columns, y = first_row + i / columns;
    text += std::to_string(x) + "," + std::to_string(y) + "," + std::to_string(x * y) + "," +
            std::to_string(x % 3) + "\n";
  }
  return text;
}

// LAS 1.2 of two points of format 0: the first and the second return of a pulse.
std::string las() {
  std::string bytes(227, '\0');
  const auto put = [&](std::size_t at, auto value) {
    std::memcpy(&bytes[at], &value, sizeof value);
  };
  bytes.replace(0, 4, "LASF");
  put(24, std::uint8_t{1});
  put(25, std::uint8_t{2});
  put(94, std::uint16_t{227});
  put(96, std::uint32_t{227});
  put(105, std::uint16_t{20});
  put(107, std::uint32_t{2});
  for (int k = 0; k < 3; ++k) put(131 + 8 * k, 0.5);
  bytes += std::string(14, '\0') + "\x11" + "\x02" + std::string(4, '\0');
  bytes +=
      std::string("\x04\0\0\0", 4) + std::string(10, '\0') + "\x12" + "\x05" + std::string(4, '\0');
  return bytes;
}

std::string hash_of(const Ran& ran) {
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  return ran.exit_code == 0 ? std::string(json::parse(ran.out)["result"]["hash"]) : "";
}

TEST(PointChoice, SeveralFilesAreOneInput) {
  const Folder folder;
  std::filesystem::create_directory(folder / "tiles");
  folder.write("tiles/a.csv", classified(20, 10, 0));
  folder.write("tiles/b.csv", classified(20, 10, 10));
  folder.write("all.csv", classified(20, 20, 0));
  const auto made = [&](const std::string& input) {
    return hash_of(run("delray triangulate " + input + " --stats -", folder.path()));
  };
  const std::string expected = made("all.csv");
  EXPECT_EQ(made("tiles"), expected);
  EXPECT_EQ(made("tiles/a.csv tiles/b.csv"), expected);
  EXPECT_EQ(made("'tiles/?.c*'"), expected);
  EXPECT_EQ(made("tiles --ranks 2"), expected);
  EXPECT_NE(made("tiles/b.csv tiles/a.csv"), expected);  // other rows

  ASSERT_EQ(run("delray triangulate tiles -o m.ply", folder.path()).exit_code, 0);
  EXPECT_EQ(run("delray verify m.ply --points tiles/a.csv tiles/b.csv", folder.path()).exit_code,
            0);
  EXPECT_EQ(run("delray verify --points tiles/a.csv tiles/b.csv m.ply", folder.path()).exit_code,
            0);
  EXPECT_EQ(run("delray verify m.ply --points tiles/a.csv", folder.path()).exit_code, 3);
  EXPECT_EQ(run("delray render tiles/*.csv -o a.png --size 32x32", folder.path()).exit_code, 0);
  EXPECT_EQ(run("delray render tiles m.ply -o a.png --size 32x32", folder.path()).exit_code, 2);
  // None of several inputs is overwritten.
  EXPECT_EQ(
      run("delray triangulate all.csv tiles/a.csv -o m.ply --stats tiles/a.csv", folder.path())
          .exit_code,
      2);
}

TEST(PointChoice, ChoosesTheSamePointsEverywhere) {
  const Folder folder;
  folder.write("all.csv", classified(20, 20, 0));
  const std::string options = " --class 1,2 --bounds 2,3,17,12,-1e9,100";
  const Ran made = run("delray triangulate all.csv -o m.ply --stats -" + options, folder.path());
  ASSERT_EQ(made.exit_code, 0) << made.err;
  // Columns 2, 4, 5, 7, 8, 10, 11, 13, 14, 16, 17, rows 3 to 12, but for products above 100.
  std::size_t expected = 0;
  for (const int x : {2, 4, 5, 7, 8, 10, 11, 13, 14, 16, 17}) {
    for (int y = 3; y <= 12; ++y) expected += x * y <= 100 ? 1 : 0;
  }
  EXPECT_EQ(json::parse(made.out)["input"]["points"], expected);
  const Ran told = run("delray info all.csv --stats -" + options, folder.path());
  EXPECT_EQ(json::parse(told.out)["points"], expected);
  EXPECT_EQ(json::parse(told.out)["classes"].size(), 2U);
  EXPECT_EQ(
      run("delray verify m.ply --complete --points all.csv" + options, folder.path()).exit_code, 0);
  EXPECT_EQ(run("delray verify m.ply --points all.csv --class 0", folder.path()).exit_code, 3);
}

TEST(PointChoice, RefusesOptionsWithoutEffect) {
  const Folder folder;
  folder.write("a.xyz", "0 0\n1 0\n0 1\n");
  folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const auto code = [&](const std::string& options) {
    return run("delray " + options, folder.path()).exit_code;
  };
  for (const char* option :
       {"--class 2", "--returns last", "--resolution 1", "--bounds 0,0,1,1,0,1", "--bounds 0,0,1",
        "--bounds 1,0,0,1", "--bounds 0,0,1,nan", "--class 256", "--class -1", "--class 2,",
        "--class two", "--returns lost", "--resolution 0"}) {
    EXPECT_EQ(code(std::string("triangulate a.xyz --stats - ") + option), 2) << option;
  }
  EXPECT_EQ(code("info a.obj --class 2"), 2);
  EXPECT_EQ(code("render a.obj -o a.png --bounds 0,0,1,1"), 2);
  EXPECT_EQ(code("triangulate a.xyz --stats - --bounds 5,5,6,6"), 3);
  EXPECT_EQ(code("triangulate '*.las' --stats -"), 3);
}

TEST(PointChoice, InfoTellsOfLasFiles) {
  const Folder folder;
  folder.write("a.las", las());
  folder.write("b.las", las());
  const json one = json::parse(run("delray info a.las --stats -", folder.path()).out);
  EXPECT_EQ(one["points"], 2);
  EXPECT_EQ(one["classes"], json({{"2", 1}, {"5", 1}}));
  EXPECT_EQ(one["returns"], json({{"1 of 2", 1}, {"2 of 2", 1}}));
  EXPECT_EQ(one["format"], "LAS 1.2");
  EXPECT_EQ(one["point_format"], 0);
  EXPECT_EQ(one["scale"], json({0.5, 0.5, 0.5}));
  EXPECT_EQ(one["high"], json({2, 0, 0}));
  const json last =
      json::parse(run("delray info *.las --returns last --stats -", folder.path()).out);
  EXPECT_EQ(last["points"], 2);
  ASSERT_EQ(last["files"].size(), 2U);
  EXPECT_EQ(last["files"][1]["file"], "b.las");
  EXPECT_EQ(last["files"][1]["points"], 1);
}

}  // namespace
}  // namespace delray::tests
