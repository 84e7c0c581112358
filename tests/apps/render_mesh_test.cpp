// delray render of what delray triangulate wrote: every format gives the picture of the others.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "image/io.h"
#include "tests/support/run_program.h"

namespace delray::tests {
namespace {

using nlohmann::json;

// A hill of 12 x 12 points whose coordinates single precision holds, so that STL keeps them.
std::string hill() {
  std::string rows;
  for (int y = 0; y < 12; ++y) {
    for (int x = 0; x < 12; ++x) {
      const int height = (x - 5) * (x - 5) + (y - 6) * (y - 6);
      rows += std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(-height) +
              (x == 3 ? ".125" : ".25") + "\n";
    }
  }
  return rows;
}

void must(const std::string& command, const Folder& folder) {
  const Ran ran = run(command, folder.path());
  EXPECT_EQ(ran.exit_code, 0) << command << "\n" << ran.err;
}

std::string hash_of(const std::string& arguments, const Folder& folder) {
  must("delray render " + arguments + " -o a.png --size 96x64 --stats stats.json -q", folder);
  return json::parse(folder.read("stats.json"))["image"]["hash"];
}

std::size_t colours_of(const std::filesystem::path& path) {
  const image::Image8 picture = image::read_image8(path);
  std::set<std::array<int, 3>> colours;
  for (std::size_t i = 0; i < picture.pixels(); ++i) {
    const image::Rgba8 c = picture.colour[i];
    colours.insert({c.r, c.g, c.b});
  }
  return colours.size();
}

TEST(RenderMesh, EveryFormatLiesFlatInTheSameColours) {
  const Folder folder;
  folder.write("p.xyz", hill());
  must("delray triangulate p.xyz -o m.ply -q", folder);
  const std::string picture = hash_of("m.ply", folder);
  for (const std::string name : {"m.obj", "m.off", "m.vtu", "m.node"}) {
    must("delray triangulate p.xyz -o " + name + " -q", folder);
    EXPECT_EQ(hash_of(name, folder), picture) << name;
  }
  // Of STL the normals of vertices are sums in another order.
  const image::Image8 expected = image::read_image8(folder / "a.png");
  must("delray triangulate p.xyz -o m.stl -q", folder);
  hash_of("m.stl", folder);
  const image::Image8 actual = image::read_image8(folder / "a.png");
  int largest = 0;
  for (std::size_t i = 0; i < expected.pixels(); ++i) {
    const image::Rgba8 a = actual.colour[i], b = expected.colour[i];
    largest = std::max({largest, std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
  }
  EXPECT_LE(largest, 2);
}

TEST(RenderMesh, ObjKeepsTheColoursOfPoints) {
  const Folder folder;
  folder.write("p.xyz", "0 0 0 255 0 7\n1 0 0 1 2 3\n0 1 1 128 254 99\n1 1 0 5 200 31\n");
  must("delray triangulate p.xyz -o m.ply -q", folder);
  must("delray triangulate p.xyz -o m.obj -q", folder);
  EXPECT_EQ(hash_of("m.obj", folder), hash_of("m.ply", folder));
}

TEST(RenderMesh, UpMayBeSaid) {
  const Folder folder;
  const std::string scene = "v 0 0 0\nv 1 0 0.5\nv 0 1 0.25\nf 1 2 3\n";
  folder.write("plain.obj", scene);
  folder.write("z.obj", "# up: z\n" + scene);
  folder.write("y.obj", "# up: y\n" + scene);
  const std::string plain = hash_of("plain.obj", folder), z = hash_of("z.obj", folder);
  EXPECT_NE(z, plain);
  EXPECT_EQ(hash_of("y.obj", folder), plain);
  EXPECT_EQ(hash_of("plain.obj --up z", folder), z);
  EXPECT_EQ(hash_of("z.obj --up y", folder), plain);
  folder.write("p.xyz", hill());
  EXPECT_NE(hash_of("p.xyz --up y", folder), hash_of("p.xyz", folder));
  EXPECT_EQ(hash_of("p.xyz --up z", folder), hash_of("p.xyz", folder));
  EXPECT_EQ(run("delray render plain.obj -o a.png --up x", folder.path()).exit_code, 2);
}

TEST(RenderMesh, TetrahedraOfANodeAreShown) {
  const Folder folder;
  must("delray generate points uniform -n 60 --dim 3 -o p.xyz -q", folder);
  must("delray triangulate p.xyz --dim 3 -o m.node -q", folder);
  must("delray triangulate p.xyz --dim 3 -o m.vtu -q", folder);
  const std::string picture = hash_of("m.vtu", folder);
  EXPECT_EQ(hash_of("m.ele", folder), picture);
  EXPECT_EQ(hash_of("m.node", folder), picture);
  const Ran info = run("delray info m.node", folder.path());
  EXPECT_NE(info.out.find("simplex: tetrahedron"), std::string::npos) << info.out;
  // Its points alone where somebody asks for points.
  EXPECT_NE(hash_of("m.node --show-as points", folder), picture);
}

TEST(RenderMesh, LevelMeshesShowTheirTriangles) {
  const Folder folder;
  must("delray generate points uniform -n 40 -o p.ply -q", folder);
  must("delray triangulate p.ply -o m.ply -q", folder);
  const std::string picture = hash_of("m.ply", folder);
  EXPECT_GT(colours_of(folder / "a.png"), 40U);
  for (const std::string name : {"m.vtu", "m.obj", "m.off", "m.node"}) {
    must("delray triangulate p.ply -o " + name + " -q", folder);
    EXPECT_EQ(hash_of(name, folder), picture) << name;
  }
  must("delray triangulate p.ply -o m.stl -q", folder);
  hash_of("m.stl", folder);
  EXPECT_GT(colours_of(folder / "a.png"), 40U);
  // Dots have no triangles, but are there.
  hash_of("p.ply --draw points --background '#000000'", folder);
  EXPECT_GT(colours_of(folder / "a.png"), 5U);
}

TEST(RenderMesh, SaysWhyPointsHaveNoSurface) {
  const Folder folder;
  folder.write("line.xyz", "0 0\n1 1\n2 2\n");
  folder.write("wall.xyz", "0 0 0\n1 1 0\n2 2 0\n0 0 3\n1 1 4\n2 2 5\n");
  const auto reason = [&](const std::string& name) {
    const Ran ran = run("delray render " + name + " -o a.png --show-as relief", folder.path());
    EXPECT_EQ(ran.exit_code, 3);
    EXPECT_NE(ran.err.find("--show-as points"), std::string::npos) << ran.err;
    return ran.err;
  };
  EXPECT_NE(reason("line.xyz").find("equal or on one line"), std::string::npos);
  EXPECT_NE(reason("wall.xyz").find("lie above one point or line"), std::string::npos);
  must("delray render wall.xyz -o a.png --show-as points -q", folder);
}

TEST(RenderMesh, ReadsLineEndsOfEveryKindAndRefusesUtf16) {
  const Folder folder;
  std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  folder.write("lf.ply", ply);
  std::ranges::replace(ply, '\n', '\r');
  folder.write("cr.ply", ply);
  EXPECT_EQ(hash_of("cr.ply", folder), hash_of("lf.ply", folder));
  std::string wide = "\xff\xfe";
  for (const char c : std::string("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")) {
    wide += std::string{c, '\0'};
  }
  folder.write("wide.obj", wide);
  const Ran ran = run("delray render wide.obj -o a.png", folder.path());
  EXPECT_EQ(ran.exit_code, 3);
  EXPECT_NE(ran.err.find("wide.obj: UTF-16 text is not read"), std::string::npos) << ran.err;
}

}  // namespace
}  // namespace delray::tests
