// delray compose as a user runs it.
#include <gtest/gtest.h>

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>

#include "image/image.h"
#include "image/io.h"
#include "tests/support/run_program.h"

namespace delray::tests {
namespace {

using image::ImageF;
using nlohmann::json;

constexpr int kWidth = 37, kHeight = 23;

// Part k covers some pixels, half transparent if asked for.
ImageF part(int k, float alpha) {
  ImageF image(kWidth, kHeight);
  clear(image);
  for (std::size_t i = 0; i < image.pixels(); ++i) {
    if ((i * 7 + static_cast<std::size_t>(k) * 5) % 11 < 5) continue;
    const auto value = static_cast<float>(k + 1) / 8 * alpha;
    image.colour[i] = {value, value / 2, alpha / 8, alpha};
    image.depth[i] = static_cast<float>((i * 13 + static_cast<std::size_t>(k) * 3) % 5);
  }
  return image;
}

std::string write_parts(const Folder& folder, int parts, float alpha) {
  std::string names;
  for (int k = 0; k < parts; ++k) {
    const std::string name = "part-" + std::to_string(k) + ".exr";
    image::write_image(folder / name, part(k, alpha));
    names += name + " ";
  }
  return names;
}

TEST(ComposeCommand, ShowsTheNearestPart) {
  const Folder folder;
  const std::string parts = write_parts(folder, 5, 1);
  for (const std::string& command :
       {"delray compose " + parts + "-o out.exr",
        "delray compose " + parts + "-o out.exr --ranks 3",
        "delray compose " + parts + "-o out.exr --ranks 8 --compose tree --codec lz4 --interlace",
        "delray compose " + parts + "-o out.exr --ranks 3 --in-pieces",
        mpirun(3) + "delray compose " + parts + "-o out.exr --compose 2-3-swap",
        mpirun(3) + "delray compose " + parts + "-o out.exr --in-pieces"}) {
    SCOPED_TRACE(command);
    const Ran ran = run(command, folder.path());
    ASSERT_EQ(ran.exit_code, 0) << ran.err;
    const ImageF result = image::read_image_float(folder / "out.exr");
    ASSERT_EQ(result.width, kWidth);
    ASSERT_EQ(result.height, kHeight);
    for (std::size_t i = 0; i < result.pixels(); ++i) {
      image::RgbaF colour;
      float depth = image::kEmptyDepth;
      for (int k = 0; k < 5; ++k) {
        const ImageF one = part(k, 1);
        if (one.depth[i] < depth) {
          depth = one.depth[i];
          colour = one.colour[i];
        }
      }
      ASSERT_EQ(result.colour[i], colour) << i;
      ASSERT_EQ(result.depth[i], depth) << i;
    }
  }
}

TEST(ComposeCommand, PutsOrderedPartsOverEachOther) {
  const Folder folder;
  const std::string parts = write_parts(folder, 3, 0.5F);
  const Ran ran =
      run("delray compose " + parts + "-o out.exr --ordered --ranks 2 --stats -", folder.path());
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const json statistics = json::parse(ran.out);
  EXPECT_EQ(statistics["schema"], "delray.compose/1");
  EXPECT_EQ(statistics["image"]["width"], kWidth);
  EXPECT_EQ(statistics["image"]["hash"].get<std::string>().size(), 32U);
  EXPECT_GT(statistics["bytes"], 0);
  const ImageF result = image::read_image_float(folder / "out.exr");
  for (std::size_t i = 0; i < result.pixels(); ++i) {
    image::RgbaF sum;
    for (int k = 0; k < 3; ++k) {
      const image::RgbaF c = part(k, 0.5F).colour[i];
      const float through = 1 - sum.a;
      sum = {sum.r + through * c.r, sum.g + through * c.g, sum.b + through * c.b,
             sum.a + through * c.a};
    }
    EXPECT_NEAR(result.colour[i].r, sum.r, 1e-6);
    EXPECT_NEAR(result.colour[i].a, sum.a, 1e-6);
  }
}

TEST(ComposeCommand, RefusesWhatItCannotMerge) {
  const Folder folder;
  const std::string parts = write_parts(folder, 2, 1);
  image::write_image(folder / "flat.png", part(0, 1));
  ImageF small(3, 2);
  clear(small);
  image::write_image(folder / "small.exr", small);
  const auto code = [&](const std::string& arguments) {
    const Ran ran = run("delray compose " + arguments, folder.path());
    EXPECT_FALSE(ran.err.empty()) << arguments;
    return ran.exit_code;
  };
  EXPECT_EQ(code(parts + "flat.png -o out.png"), 3);  // no depth
  for (const std::string ranks : {"1", "3"}) {
    EXPECT_EQ(code(parts + "small.exr -o out.png --ranks " + ranks), 3);
  }
  EXPECT_EQ(code(parts + "missing.exr -o out.png --ranks 3"), 3);
  EXPECT_EQ(code("-o out.png"), 2);
  EXPECT_EQ(code(parts), 2);
  EXPECT_EQ(code(parts + "-o out.nothing"), 2);
  EXPECT_EQ(code(parts + "-o out.png --in-pieces"), 2);
  EXPECT_EQ(code(parts + "-o out.png --compose radix-k:0"), 2);
  EXPECT_EQ(code(parts + "-o out.png --codec zip"), 2);
  EXPECT_EQ(
      run("delray compose " + parts + "flat.png -o out.png --ordered", folder.path()).exit_code, 0);
}

}  // namespace
}  // namespace delray::tests
