// What picture files tell besides the picture: nothing, unless --metadata is given.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/run_program.h"

namespace delray::tests {
namespace {

constexpr const char* kSuffixes[] = {".png", ".exr", ".tif", ".jpg"};

void expect_success(const std::string& command, const Folder& folder) {
  const Ran ran = run(command, folder.path());
  EXPECT_EQ(ran.exit_code, 0) << command << "\n" << ran.err;
}

nlohmann::json attributes(const std::string& picture, const Folder& folder) {
  const Ran ran = run("delray info " + picture + " --stats -", folder.path());
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  return nlohmann::json::parse(ran.out)["attributes"];
}

TEST(Metadata, EqualPicturesAreEqualFiles) {
  const Folder folder;
  const std::string raster = "delray render gen:spheres:300 --size 64x48 -q ";
  const std::string rays = raster + "--engine raytrace --spp 2 ";
  for (const std::string suffix : kSuffixes) {
    for (const std::string& command : {raster, rays}) {
      const std::string other = (folder / ("other" + suffix)).string();
      expect_success(command + "-o a" + suffix + " --threads 1", folder);
      expect_success(command + "-o " + other + " --threads 2 --ranks 3 --stats s.json", folder);
      expect_success("cmp a" + suffix + " " + other, folder);
      EXPECT_EQ(folder.read("a" + suffix).find("render"), std::string::npos) << suffix;
    }
  }
}

TEST(Metadata, MergedPicturesAreEqualFilesToo) {
  const Folder folder;
  for (const std::string name : {"p", "q"})
    expect_success("delray render gen:spheres:300 --size 64x48 -q -o " + name + ".exr", folder);
  for (const std::string suffix : kSuffixes) {
    expect_success("delray compose p.exr q.exr -o a" + suffix, folder);
    expect_success("delray compose p.exr q.exr --ranks 2 -o other" + suffix, folder);
    expect_success("cmp a" + suffix + " other" + suffix, folder);
  }
  EXPECT_EQ(run("delray compose p.exr -o b.exr --metadata --in-pieces", folder.path()).exit_code,
            2);
}

TEST(Metadata, IsWrittenWhereItIsAskedFor) {
  const Folder folder;
  for (const std::string suffix : kSuffixes) {
    const std::string name = "with-a-name-of-its-own" + suffix;
    expect_success("delray render gen:cornell --size 16x16 -q --engine raytrace --spp 4 -o " +
                       name + " --metadata",
                   folder);
    const nlohmann::json told = attributes(name, folder);
    const char* key = told.contains("CommandLine") ? "CommandLine" : "ImageDescription";
    ASSERT_TRUE(told.contains(key)) << suffix << told;
    EXPECT_NE(told[key].get<std::string>().find(name), std::string::npos) << told;
    EXPECT_EQ(told.value("delray:samples", 0.0), suffix == ".exr" ? 4.0 : 0.0) << told;
  }
}

}  // namespace
}  // namespace delray::tests
