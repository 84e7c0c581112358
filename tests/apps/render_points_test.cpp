// delray render of points as they come: with outliers, in degrees, in space, as pixels of a
// GeoTIFF.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "geometry/rect.h"
#include "image/io.h"
#include "tests/support/geotiff_file.h"
#include "tests/support/run_program.h"

namespace delray::tests {
namespace {

using nlohmann::json;

bool mentions(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

// What a picture on a transparent background shows.
struct Covered {
  geometry::Rect box;
  double part = 0;  // of the pixels

  int width() const { return box.x1 - box.x0; }
  int height() const { return box.y1 - box.y0; }
};

Covered covered(const std::filesystem::path& path) {
  const image::Image8 picture = image::read_image8(path);
  Covered result{{picture.width, picture.height, 0, 0}, 0};
  std::size_t count = 0;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const auto i = static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) +
                     static_cast<std::size_t>(x);
      if (picture.colour[i].a == 0) continue;
      ++count;
      result.box = {std::min(result.box.x0, x), std::min(result.box.y0, y),
                    std::max(result.box.x1, x + 1), std::max(result.box.y1, y + 1)};
    }
  }
  result.part = static_cast<double>(count) / static_cast<double>(picture.pixels());
  return result;
}

// Renders to a.png, 320 x 180.
Ran render(const std::string& arguments, const Folder& folder) {
  const Ran ran =
      run("delray render " + arguments + " -o a.png --size 320x180 --background transparent",
          folder.path());
  EXPECT_EQ(ran.exit_code, 0) << arguments << "\n" << ran.err;
  return ran;
}

// Hills of 1000 x 600 x 40 units, `more` rows behind them.
std::string site(double scale_x, double scale_y, const std::string& more = "") {
  std::string text;
  for (int i = 0; i < 50; ++i) {
    for (int j = 0; j < 30; ++j) {
      const double x = 20.0 * i, y = 20.0 * j;
      text += std::to_string(x * scale_x) + " " + std::to_string(y * scale_y) + " " +
              std::to_string(20 + 20 * std::sin(x / 130) * std::cos(y / 90)) + "\n";
    }
  }
  return text + more;
}

TEST(RenderPoints, LeavesEqualMarginsAroundThem) {
  const Folder folder;
  folder.write("site.xyz", site(1, 1));
  for (const char* view : {"default", "top", "iso"}) {
    render(std::string("site.xyz --view ") + view, folder);
    const geometry::Rect box = covered(folder / "a.png").box;
    EXPECT_NEAR(box.x0, 320 - box.x1, 1) << view;
    EXPECT_NEAR(box.y0, 180 - box.y1, 1) << view;
    EXPECT_TRUE(std::abs(box.x0 - 16) <= 1 || std::abs(box.y0 - 9) <= 1) << view;
  }
}

TEST(RenderPoints, AnOutlierDoesNotShrinkTheSite) {
  const Folder folder;
  folder.write("site.xyz", site(1, 1));
  folder.write("bird.xyz", site(1, 1, "500 300 90000\n"));
  const Ran clean = render("site.xyz", folder);
  EXPECT_FALSE(mentions(clean.err, "far off"));
  const Covered without = covered(folder / "a.png");
  const Ran ran = render("bird.xyz", folder);
  EXPECT_TRUE(mentions(ran.err, "1 of 1501 points lie far off all others")) << ran.err;
  const Covered with = covered(folder / "a.png");
  EXPECT_NEAR(with.width(), without.width(), 2);
  EXPECT_GT(with.part, 0.9 * without.part);
  EXPECT_EQ(with.box.y1, without.box.y1);
}

TEST(RenderPoints, DegreesAreDrawnInMetres) {
  const Folder folder;
  const double degree = 111000;
  // At 60 degrees a degree of longitude is half as long as one of latitude.
  const std::string rows = site(2 / degree, 1 / degree, "");
  std::string shifted;
  std::size_t begin = 0;
  while (begin < rows.size()) {
    const std::size_t end = rows.find('\n', begin);
    double x = 0, y = 0, z = 0;
    std::sscanf(rows.substr(begin, end - begin).c_str(), "%lf %lf %lf", &x, &y, &z);
    char line[100];
    std::snprintf(line, sizeof line, "%.9f,%.9f,%.6f\n", x + 24.9, y + 60, z);
    shifted += line;
    begin = end + 1;
  }
  folder.write("metres.xyz", site(1, 1));
  folder.write("named.csv", "lon,lat,height\n" + shifted);
  folder.write("bare.csv", shifted);
  render("metres.xyz", folder);
  const Covered metres = covered(folder / "a.png");
  for (const char* name : {"named.csv", "bare.csv"}) {
    const Ran ran = render(name, folder);
    EXPECT_TRUE(mentions(ran.err, "degrees of longitude and latitude")) << ran.err;
    const Covered degrees = covered(folder / "a.png");
    EXPECT_NEAR(degrees.width(), metres.width(), 2) << name;
    EXPECT_NEAR(degrees.height(), metres.height(), 2) << name;
    EXPECT_NEAR(degrees.part, metres.part, 0.02) << name;
  }
}

TEST(RenderPoints, PointsInSpaceAreSpheres) {
  const Folder folder;
  for (const char* kind : {"sphere", "uniform", "gauss"}) {
    const std::string generate =
        std::string("delray generate points ") + kind + " -n 2000 --dim 3 -o a.ply -q";
    ASSERT_EQ(run(generate, folder.path()).exit_code, 0);
    const Ran ran = render("a.ply --stats stats.json", folder);
    EXPECT_TRUE(mentions(ran.err, "shown as spheres")) << ran.err;
    EXPECT_EQ(json::parse(folder.read("stats.json"))["scene"]["points"], 2000) << kind;
    EXPECT_EQ(json::parse(folder.read("stats.json"))["scene"]["triangles"], 0) << kind;
    const Ran surface = render("a.ply --show-as relief --stats stats.json", folder);
    EXPECT_FALSE(mentions(surface.err, "shown as spheres")) << surface.err;
    EXPECT_LT(json::parse(folder.read("stats.json"))["scene"]["triangles"], 2 * 2000) << kind;
  }
  for (const char* rows : {"terrain", "uniform"}) {  // these are heights, and a plane
    const std::string dim = rows == std::string("terrain") ? "3" : "2";
    ASSERT_EQ(run(std::string("delray generate points ") + rows + " -n 2000 --dim " + dim +
                      " -o a.ply -q",
                  folder.path())
                  .exit_code,
              0);
    EXPECT_FALSE(mentions(render("a.ply", folder).err, "shown as spheres")) << rows;
    EXPECT_FALSE(mentions(render("a.ply --draw points", folder).err, "shown as spheres"));
  }
  const auto exit_code = [&](const std::string& arguments) {
    return run("delray render " + arguments + " -o a.png", folder.path()).exit_code;
  };
  EXPECT_EQ(exit_code("a.ply --show-as discs --duplicates min"), 2);
  EXPECT_EQ(exit_code("a.ply --show-as points --color-by simplex"), 2);
  EXPECT_EQ(exit_code("a.ply --show-as relief --radius 1"), 2);
  EXPECT_EQ(exit_code("a.ply --show-as points --draw points"), 2);
  EXPECT_EQ(exit_code("a.ply --point-size 3 --radius 1"), 2);
  EXPECT_EQ(exit_code("gen:cornell --show-as points"), 2);
  EXPECT_EQ(exit_code("gen:cornell --point-size 3"), 2);
  EXPECT_EQ(exit_code("gen:cornell --legend"), 2);
  EXPECT_EQ(exit_code("a.ply --legend --color-by z --wall 2x1"), 2);
  EXPECT_EQ(exit_code("a.ply --shading eye-dome --wall 2x1"), 2);
  EXPECT_EQ(exit_code("a.ply --shading eye-dome --crop 0,0,9,9"), 2);
}

// Bytes of the picture, by its hash.
TEST(RenderPoints, PointsHaveOnePictureForAllRanks) {
  const Folder folder;
  ASSERT_EQ(
      run("delray generate points terrain -n 5000 --dim 3 -o a.ply -q", folder.path()).exit_code,
      0);
  for (const std::string how :
       {"--show-as points --point-size 4 --shading eye-dome --legend --color-by z",
        "--show-as spheres --samples 2", "--show-as discs --radius 0.01"}) {
    const auto hash = [&](const std::string& sharing) {
      const Ran ran = render(fmt::format("a.ply {} --stats stats.json{}", how, sharing), folder);
      EXPECT_EQ(ran.exit_code, 0) << ran.err;
      return json::parse(folder.read("stats.json"))["image"]["hash"].get<std::string>();
    };
    const std::string alone = hash("");
    for (const char* strategy : {"sort-first", "sort-middle", "sort-last", "hybrid"})
      EXPECT_EQ(hash(std::string(" --ranks 3 --strategy ") + strategy), alone) << how << strategy;
  }
}

TEST(RenderPoints, ALegendIsDrawnOverTheLowerLeftCorner) {
  const Folder folder;
  folder.write("a.csv", "x,y,z,classification\n0,0,0,2\n1,0,1,6\n0,1,2,9\n1,1,3,2\n");
  for (const std::string by : {"z", "classification"}) {
    const auto picture = [&](const std::string& more) {
      const Ran ran = render(
          fmt::format("a.csv --show-as points --point-size 9 --color-by {}{}", by, more), folder);
      EXPECT_EQ(ran.exit_code, 0) << ran.err;
      return image::read_image8(folder / "a.png");
    };
    const auto without = picture(""), with = picture(" --legend");
    std::size_t changed = 0, outside = 0;
    for (int y = 0; y < with.height; ++y) {
      for (int x = 0; x < with.width; ++x) {
        const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(with.width) +
                              static_cast<std::size_t>(x);
        if (std::memcmp(&with.colour[i], &without.colour[i], sizeof(image::Rgba8)) == 0) continue;
        ++changed;
        outside += x > with.width / 2 ? 1 : 0;
      }
    }
    EXPECT_GT(changed, 1000U) << by;
    EXPECT_EQ(outside, 0U) << by;
  }
  EXPECT_EQ(
      run("delray render a.csv -o b.png --color-by material --legend", folder.path()).exit_code, 2);
}

TEST(RenderPoints, TellsOfEdgesThatItLeavesOut) {
  const Folder folder;
  folder.write("outline.txt", "4 3\n0 0\n10.5 0\n10.5 7\n0 7\n0 1\n1 2\n2 3\n");
  folder.write("edges.ply",
               "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
               "element edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n"
               "0 0\n1 0\n1 1\n0 1\n0 2\n");
  folder.write("lines.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nl 1 2\nl 2 3\n");
  const auto told = [&](const std::string& command) {
    const Ran ran = run(command, folder.path());
    EXPECT_EQ(ran.exit_code, 0) << ran.err;
    return ran.err;
  };
  for (const std::string command :
       {"delray info ", "delray render -o a.png ", "delray triangulate -o a.vtu "}) {
    EXPECT_TRUE(mentions(told(command + "outline.txt"), "outline.txt: 3 edges")) << command;
    EXPECT_TRUE(mentions(told(command + "edges.ply"), "edges.ply: 1 edge ")) << command;
    EXPECT_TRUE(mentions(told(command + "lines.obj"), "2 edges")) << command;
  }
}

TEST(RenderPoints, HeightsAreASingleChannel) {
  const Folder folder;
  std::string grey = "P5 20 10 255\n", colour = "P6 20 10 255\n";
  for (int i = 0; i < 200; ++i) {
    grey += static_cast<char>(40 + i / 4);
    colour += std::string({'\1', static_cast<char>(130 + i / 4), '\0'});
  }
  folder.write("grey.pgm", grey);
  folder.write("colour.ppm", colour);
  render("grey.pgm", folder);
  render("colour.ppm --terrain-rgb", folder);
  for (const std::string command : {"delray render -o b.png ", "delray triangulate -o b.ply "}) {
    const Ran ran = run(command + "colour.ppm", folder.path());
    EXPECT_EQ(ran.exit_code, 3);
    EXPECT_TRUE(mentions(ran.err, "heights are a single channel, this picture has 3 (R, G, B)"))
        << ran.err;
    EXPECT_TRUE(mentions(ran.err, "--terrain-rgb")) << ran.err;
    EXPECT_EQ(run(command + "grey.pgm --terrain-rgb", folder.path()).exit_code, 3);
  }
  const std::vector<std::string> left = folder.files();
  EXPECT_TRUE(std::ranges::none_of(left, [](const std::string& n) { return n.starts_with("b."); }));
}

TEST(RenderPoints, PixelsOfAGeoTiffLieWhereItSays) {
  const Folder folder;
  GeoTiffFile file;
  file.scale = {10, 20, 0};
  file.tie = {0, 0, 0, 400000, 5000000, 0};
  file.values = {1, 2, -9999, 4, 5, 6};
  file.no_data = "-9999";
  folder.write("heights.tif", file.bytes());
  const auto info = [&](const std::string& name) {
    const Ran ran = run("delray info --stats - " + name, folder.path());
    EXPECT_EQ(ran.exit_code, 0) << ran.err;
    return json::parse(ran.out);
  };
  EXPECT_EQ(info("heights.tif")["first_pixel"], json({400005, 4999990}));
  ASSERT_EQ(run("delray triangulate heights.tif -o mesh.ply", folder.path()).exit_code, 0);
  EXPECT_EQ(info("mesh.ply")["points"], 5);
  EXPECT_EQ(info("mesh.ply")["low"], json({400005.0, 4999970.0, 1.0}));
  EXPECT_EQ(info("mesh.ply")["high"], json({400025.0, 4999990.0, 6.0}));
  ASSERT_EQ(
      run("delray triangulate heights.tif --cell-size 2 -o mesh.ply", folder.path()).exit_code, 0);
  EXPECT_EQ(info("mesh.ply")["high"], json({4.0, 0.0, 6.0}));
  render("heights.tif", folder);
}

TEST(RenderCommand, RefusesATransparentBackgroundInJpeg) {
  const Folder folder;
  for (const char* name : {"a.jpg", "a.JPEG"}) {
    const std::string command = std::string("delray render gen:cornell -o ") + name;
    EXPECT_EQ(run(command + " --background transparent", folder.path()).exit_code, 2);
    EXPECT_TRUE(folder.files().empty());
  }
}

// Ranks that each make a part of the scene see it from where one rank does that has all of it.
TEST(RenderCommand, RanksAgreeOnViewsOfScenesInParts) {
  const Folder folder;
  const std::string base =
      "delray render gen:terrain:3000 -o a.png --size 96x54 --engine raytrace --stats s.json -q ";
  const auto hash = [&](const std::string& command) -> std::string {
    const Ran ran = run(command, folder.path());
    EXPECT_EQ(ran.exit_code, 0) << command << "\n" << ran.err;
    return json::parse(folder.read("s.json"))["image"]["hash"];
  };
  for (const std::string view : {"top", "iso"}) {
    const std::string expected = hash(base + "--view " + view);
    EXPECT_EQ(hash(mpirun(3) + base + "--data ray --view " + view), expected) << view;
    EXPECT_EQ(hash(base + "--ranks 3 --data ray --view " + view), expected) << view;
  }
  EXPECT_EQ(run(mpirun(2) + base + "--data ray --view inside", folder.path()).exit_code, 2);
}

// Processes read a part of a file each, and give the picture that one gives.
TEST(RenderCommand, ProcessesReadPartsOfAFile) {
  const Folder folder;
  ASSERT_EQ(run("delray generate scene terrain -n 4000 -o t.glb -q", folder.path()).exit_code, 0);
  const auto image = [&](const std::string& before, const std::string& options, int parts) {
    const Ran ran =
        run(before + "delray render t.glb -o a.png --size 96x54 --view iso --stats s.json -q " +
                options,
            folder.path());
    EXPECT_EQ(ran.exit_code, 0) << options << "\n" << ran.err;
    const json stats = json::parse(folder.read("s.json"));
    EXPECT_EQ(stats["scene"]["parts"], parts) << options;
    EXPECT_EQ(stats["scene"]["triangles"].get<int>() > 3500, true);
    return stats["image"]["hash"].get<std::string>();
  };
  const std::string raster = image("", "", 1);
  EXPECT_EQ(image(mpirun(3), "--strategy sort-last", 3), raster);
  EXPECT_EQ(image(mpirun(2), "--strategy sort-middle --up y", 2), raster);
  EXPECT_EQ(image(mpirun(2), "--strategy sort-first", 1), raster);
  EXPECT_EQ(image(mpirun(3), "--engine raytrace --data object", 3),
            image("", "--engine raytrace", 1));
}

}  // namespace
}  // namespace delray::tests
