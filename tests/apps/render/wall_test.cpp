// Walls of displays, crops and pictures larger than memory, with the built program.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "image/io.h"
#include "tests/support/run_program.h"

namespace delray::tests {
namespace {

using nlohmann::json;

const std::string kTerrain = "delray render gen:terrain:4000 -q ";
// What --wall 3x2 --size 70x50 --bezel 9x4 shows of, and the options.
const std::string kFrame = "--size 228x104 ";
const std::string kWall = "--wall 3x2 --size 70x50 --bezel 9x4 ";

json stats_of(const std::string& options, const Folder& folder) {
  const Ran ran = run(kTerrain + options + " --stats stats.json", folder.path());
  EXPECT_EQ(ran.exit_code, 0) << options << "\n" << ran.err;
  return ran.exit_code == 0 ? json::parse(folder.read("stats.json")) : json();
}

// Whether `part` is what `whole` has from (x0, y0) on, at place (x, y) of a larger part.
void expect_part(const image::Image8& whole, int x0, int y0, const image::Image8& part, int x,
                 int y, int width, int height, const std::string& what) {
  for (int j = 0; j < height; ++j) {
    for (int i = 0; i < width; ++i) {
      ASSERT_EQ(part.colour[static_cast<std::size_t>((y + j) * part.width + x + i)],
                whole.colour[static_cast<std::size_t>((y0 + j) * whole.width + x0 + i)])
          << what << " " << i << " " << j;
    }
  }
}

TEST(Wall, EveryDisplayIsAFileOfWhatItShows) {
  const Folder folder;
  for (const std::string engine : {"", "--engine raytrace ", "--engine raytrace --spp 3 "}) {
    stats_of(engine + kFrame + "-o whole.png", folder);
    const image::Image8 whole = image::read_image8(folder / "whole.png");
    std::string hash;
    for (const std::string options :
         {"", "--ranks 4 ", "--ranks 9 --threads 1 ", "--ranks 2 --strategy sort-first ",
          "--ranks 3 --strategy sort-middle ", "--ranks 6 --strategy sort-first --draw-at-home ",
          "--ranks 2 --frames 3 ", "--ranks 3 --data object ", "--ranks 3 --schedule stealing "}) {
      const bool is_raster = options.find("--strategy") != std::string::npos;
      const bool is_rays = options.find("--data") != std::string::npos ||
                           options.find("--schedule") != std::string::npos;
      if ((is_raster && !engine.empty()) || (is_rays && engine.empty())) continue;
      const json told = stats_of(engine + kWall + options + "-o wall.png", folder);
      if (hash.empty()) hash = told["image"]["hash"];
      EXPECT_EQ(told["image"]["hash"], hash) << engine << options;
      EXPECT_EQ(told["image"]["width"], 228);
      ASSERT_EQ(told["wall"]["displays"].size(), 6U);
      int last = 0;
      for (const json& display : told["wall"]["displays"]) {
        const int column = display["column"], row = display["row"], rank = display["rank"];
        EXPECT_GE(rank, last);
        last = rank;
        const std::string file = display["file"];
        EXPECT_EQ(file, "wall-" + std::to_string(column) + "-" + std::to_string(row) + ".png");
        const image::Image8 shown = image::read_image8(folder / file);
        ASSERT_EQ(shown.width, 70);
        ASSERT_EQ(shown.height, 50);
        expect_part(whole, column * 79, row * 54, shown, 0, 0, 70, 50, engine + options + file);
      }
    }
  }
}

TEST(Wall, InOneFileItsDisplaysLieSideBySide) {
  const Folder folder;
  stats_of(kFrame + "-o whole.png", folder);
  const image::Image8 whole = image::read_image8(folder / "whole.png");
  std::string hash;
  for (const std::string file : {"one.png", "one.tif", "one.exr"}) {
    const json told = stats_of(kWall + "--one-file --ranks 3 -o " + file, folder);
    EXPECT_EQ(told["image"]["width"], 210);
    EXPECT_EQ(told["image"]["height"], 100);
    if (hash.empty()) hash = told["image"]["hash"];
    EXPECT_EQ(told["image"]["hash"], hash) << file;
    const image::Image8 one = image::read_image8(folder / file);
    ASSERT_EQ(one.width, 210);
    ASSERT_EQ(one.height, 100);
    for (int k = 0; k < 6; ++k)
      expect_part(whole, k % 3 * 79, k / 3 * 54, one, k % 3 * 70, k / 3 * 50, 70, 50, file);
  }
}

TEST(Wall, ACropOfTheRasterizerIsAPartOfThePicture) {
  const Folder folder;
  stats_of(kFrame + "-o whole.png", folder);
  const image::Image8 whole = image::read_image8(folder / "whole.png");
  for (const std::string strategy : {"sort-last", "sort-first", "sort-middle", "hybrid"}) {
    const json told = stats_of(
        kFrame + "--crop 17,31,101,66 --ranks 3 -o part.png --strategy " + strategy, folder);
    EXPECT_EQ(told["image"]["width"], 101);
    const image::Image8 part = image::read_image8(folder / "part.png");
    expect_part(whole, 17, 31, part, 0, 0, 101, 66, strategy);
  }
}

// Colours and depths, what is seen at samples, and the libraries that write the file do not fit
// into the memory all at once.
TEST(Wall, APictureLargerThanMemoryIsWrittenInBands) {
  const Folder folder;
  const std::string options = "--size 2000x2000 --background studio ";
  const json whole = stats_of(options + "--memory 2GiB -o whole.tif", folder);
  for (const std::string engine : {"", "--ranks 2 --strategy sort-first "}) {
    const Ran ran = run("delray render gen:terrain:4000 " + options + engine +
                            "--memory 200MB -o bands.tif --stats stats.json",
                        folder.path());
    ASSERT_EQ(ran.exit_code, 0) << ran.err;
    EXPECT_NE(ran.err.find("bands"), std::string::npos) << ran.err;
    const json told = json::parse(folder.read("stats.json"));
    EXPECT_EQ(told["image"]["hash"], whole["image"]["hash"]);
    EXPECT_LE(told["ranks"][0]["peak_rss"].get<std::uint64_t>(), 200'000'000U);
  }
  const image::Image8 a = image::read_image8(folder / "whole.tif");
  const image::Image8 b = image::read_image8(folder / "bands.tif");
  ASSERT_EQ(a.pixels(), b.pixels());
  EXPECT_TRUE(std::ranges::equal(a.colour.span(), b.colour.span()));
  // A format that is written at once is refused.
  EXPECT_EQ(run(kTerrain + options + "--memory 60MB -o bands.png", folder.path()).exit_code, 1);
}

TEST(Wall, WhatDoesNotGoTogetherIsRefused) {
  const Folder folder;
  for (const std::string options :
       {"--wall 3", "--wall 0x2", "--wall 3x2x1", "--wall x2", "--wall 1000000x2",
        "--wall 3x2 --bezel -1", "--wall 3x2 --bezel 5x", "--bezel 5", "--one-file",
        "--draw-at-home", "--wall 3x2 --draw-at-home",
        "--wall 3x2 --strategy sort-first --draw-at-home --partition mahd",
        "--wall 3x2 --strategy sort-first --draw-at-home --one-file",
        "--wall 3x2 --strategy hybrid --draw-at-home", "--wall 40x2", "--wall 3x2 --turntable 4",
        "--wall 3x2 --crop 0,0,5,5", "--wall 3x2 --engine raytrace --noise 0.1",
        "--wall 3x2 --engine raytrace --denoise"}) {
    EXPECT_EQ(run(kTerrain + options + " -o a.png", folder.path()).exit_code, 2) << options;
  }
  EXPECT_EQ(run(kTerrain + "--wall 3x2 -o -", folder.path()).exit_code, 2);
  // A display's file is not the statistics'.
  EXPECT_EQ(run(kTerrain + "--wall 1x1 -o a.png --stats a-0-0.png", folder.path()).exit_code, 2);
}

}  // namespace
}  // namespace delray::tests
