// --memory, --allow-outside and streams, through the program.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include "image/io.h"
#include "tests/support/run_program.h"

namespace delray::tests {
namespace {

const std::string kObj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n";

void write_png(const Folder& folder, const std::string& name, int side) {
  const std::vector<image::Rgba8> texels(static_cast<std::size_t>(side) * side, {9, 9, 9, 255});
  const std::vector<std::byte> png = image::encode_png(side, side, texels);
  folder.write(name, {reinterpret_cast<const char*>(png.data()), png.size()});
}

TEST(Limits, MemoryIsPromisedBeforeItIsTaken) {
  const Folder folder;
  write_png(folder, "big.png", 5000);
  folder.write("a.mtl", "newmtl m\nmap_Kd big.png\n");
  folder.write("a.obj", "mtllib a.mtl\n" + kObj);
  for (const std::string command :
       {"delray info a.obj", "delray render a.obj -o b.png --size 16x16",
        "delray triangulate big.png -o b.obj", "delray render big.png -o b.png --size 16x16"}) {
    const Ran ran = run(command + " --memory 90MB", folder.path());
    EXPECT_EQ(ran.exit_code, 1) << command << ran.err;
    EXPECT_NE(ran.err.find("big.png: takes "), std::string::npos) << command << ran.err;
    EXPECT_NE(ran.err.find("85.8 MiB (--memory)"), std::string::npos) << command << ran.err;
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "b.png"));
  EXPECT_EQ(run("delray info a.obj --memory 1GiB", folder.path()).exit_code, 0);
  EXPECT_EQ(run("delray info a.obj --memory much", folder.path()).exit_code, 2);
}

TEST(Limits, TriangulatingIsPartOfThePromise) {
  const Folder folder;
  ASSERT_EQ(
      run("delray generate points uniform -n 300000 --dim 2 -o p.ply", folder.path()).exit_code, 0);
  for (const std::string command : {"delray triangulate p.ply -o m.obj",
                                    "delray render p.ply -o a.png --size 16x16 --draw surface"}) {
    const Ran ran = run(command + " --memory 40MB", folder.path());
    EXPECT_EQ(ran.exit_code, 1) << command << ran.err;
    EXPECT_NE(ran.err.find("triangulation of 300000 points: takes 20.0 MiB"), std::string::npos)
        << command << ran.err;
  }
  EXPECT_EQ(folder.files(), std::vector<std::string>{"p.ply"});
}

TEST(Limits, PicturesStructuresAndGeneratedScenesArePartOfThePromise) {
  const Folder folder;
  for (const auto& [command, what] : std::vector<std::pair<std::string, std::string>>{
           {"render gen:city:100000000 --memory 500MB", "gen:city:100000000: takes 9.78 GiB"},
           {"info gen:city:100000000 --memory 500MB", "gen:city:100000000: takes 9.78 GiB"},
           {"render gen:cornell --size 32768x32768 --memory 1GiB",
            "32768 x 32768 pixels (as .tif or .exr they would be written in bands): takes 12"},
           {"render gen:cornell --size 32768x32768 --ranks 4 --memory 1GiB", "in bands): takes 36"},
           {"render gen:cornell --size 30000x30000 --engine raytrace --memory 1GiB",
            "30000 x 30000 pixels (as .tif or .exr they would be written in bands): takes 27"},
           {"render gen:city:1000000 --engine raytrace --size 16x16 --memory 180MB",
            "Embree's structures of 999996 triangles: takes 62.0 MiB"}}) {
    const bool writes = command.starts_with("render");
    const Ran ran = run("delray " + command + (writes ? " -o a.png" : ""), folder.path());
    EXPECT_EQ(ran.exit_code, 1) << command << ran.err;
    EXPECT_NE(ran.err.find(what), std::string::npos) << command << "\n" << ran.err;
    EXPECT_NE(ran.err.find("(--memory)"), std::string::npos) << command << "\n" << ran.err;
  }
  EXPECT_TRUE(folder.files().empty());
}

// What is refused was noticed before it was there.
TEST(Limits, TextOfStlIsReadWithinMemory) {
  const Folder folder;
  std::string text = "solid\n";
  for (int i = 0; i < 1500000; ++i)
    text += "facet\nvertex 1 2 3\nvertex 1 2 4\nvertex 1 3 5\nendfacet\n";
  folder.write("a.stl", text + "endsolid\n");
  const Ran ran = run("delray info a.stl --memory 90MB", folder.path());
  EXPECT_EQ(ran.exit_code, 1) << ran.err;
  std::smatch has;
  ASSERT_TRUE(std::regex_search(ran.err, has, std::regex("the program has ([0-9.]+) MiB")))
      << ran.err;
  EXPECT_LT(std::stod(has[1]), 100) << ran.err;
}

TEST(Limits, TheRayTracerHasNoCopiesOfTextures) {
  const Folder folder;
  constexpr int kSide = 5000;
  write_png(folder, "big.png", kSide);
  folder.write("a.mtl", "newmtl m\nmap_Kd big.png\n");
  folder.write("a.obj", "mtllib a.mtl\n" + kObj);
  const auto peak = [&](const std::string& engine) {
    const Ran ran = run("delray render a.obj -o b.png -q --size 16x16 --stats - --engine " + engine,
                        folder.path());
    EXPECT_EQ(ran.exit_code, 0) << ran.err;
    return nlohmann::json::parse(ran.out)["ranks"][0]["peak_rss"].get<double>();
  };
  EXPECT_LT(peak("raytrace") - peak("raster"), 0.5 * kSide * kSide * sizeof(image::Rgba8));
}

TEST(Limits, OnlyWithAllowOutsideAreFilesElsewhereRead) {
  const Folder folder;
  std::filesystem::create_directory(folder / "scene");
  write_png(folder, "wall.png", 4);
  folder.write("scene/a.mtl", "newmtl m\nmap_Kd ../wall.png\n");
  folder.write("scene/a.obj", "mtllib a.mtl\n" + kObj);
  const auto textures = [&](const std::string& options) {
    const Ran ran = run("delray info scene/a.obj -q --stats - " + options, folder.path());
    EXPECT_EQ(ran.exit_code, 0) << ran.err;
    return nlohmann::json::parse(ran.out)["textures"].size();
  };
  EXPECT_EQ(textures(""), 0U);
  EXPECT_EQ(textures("--allow-outside"), 1U);
  EXPECT_NE(run("delray info scene/a.obj", folder.path()).err.find("--allow-outside"),
            std::string::npos);
  folder.write("p.xyz", "0 0\n1 0\n0 1\n");
  for (const std::string command : {"delray info p.xyz", "delray render p.xyz -o a.png",
                                    "delray render gen:spheres -o a.png"}) {
    EXPECT_EQ(run(command + " --allow-outside", folder.path()).exit_code, 2) << command;
  }
}

TEST(Limits, StreamsAreReadWhereFilesAre) {
  const Folder folder;
  folder.write("a.obj", kObj);
  folder.write("p.xyz", "0 0\n1 0\n0 1\n");
  write_png(folder, "a.png", 8);
  const auto out = [&](const std::string& command) {
    const Ran ran = run(command, folder.path());
    EXPECT_EQ(ran.exit_code, 0) << command << "\n" << ran.err;
    return ran.out;
  };
  for (const std::string file : {"a.obj", "p.xyz", "a.png"}) {
    const std::string whole = out("delray info " + file);
    EXPECT_EQ(out("cat " + file + " | delray info -"), whole) << file;
    EXPECT_EQ(out("cat " + file + " | delray info /dev/stdin"), whole) << file;
    EXPECT_EQ(out("mkfifo pipe; cat " + file + " >pipe & delray info pipe; rm pipe"), whole)
        << file;
  }
  out("cat a.obj | delray render - -o b.png --size 16x16");
  EXPECT_TRUE(std::filesystem::exists(folder / "b.png"));
}

TEST(Limits, StreamsWithoutEndAreBadInput) {
  const Folder folder;
  folder.write("p.xyz", "0 0\n1 0\n0 1\n");
  folder.write("m.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  for (const std::string device : {"/dev/zero", "/dev/urandom"}) {
    for (const std::string& command :
         {"info " + device, "triangulate " + device + " -o a.ply", "render " + device + " -o a.png",
          "verify " + device + " --points p.xyz", "verify m.off --points " + device,
          "compose " + device + " -o a.png",
          "render gen:spheres -o a.png --memory 200MB --camera-path " + device,
          "render gen:spheres -o a.png --engine raytrace --resume --checkpoint " + device}) {
      const Ran ran = run("delray " + command, folder.path());
      EXPECT_EQ(ran.exit_code, 3) << command << "\n" << ran.err;
      EXPECT_NE(ran.err.find(device), std::string::npos) << command << "\n" << ran.err;
    }
  }
  const Ran endless =
      run("yes '0 1' | delray triangulate - --memory 100MB -o a.ply", folder.path());
  EXPECT_EQ(endless.exit_code, 3) << endless.err;
  EXPECT_NE(endless.err.find("does not end within the 95.4 MiB"), std::string::npos) << endless.err;
}

}  // namespace
}  // namespace delray::tests
