// delray pack, and what becomes of packs.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "packs/pack_reader.h"
#include "tests/support/run_program.h"

namespace delray::tests {
namespace {

using Json = nlohmann::json;

Json rendered(const Folder& folder, const std::string& scene, const std::string& options) {
  const Ran ran =
      run("delray render " + scene + " -o p.png --stats s.json -q --size 320x200 " + options,
          folder.path());
  EXPECT_EQ(ran.exit_code, 0) << scene << " " << options << "\n" << ran.err;
  return ran.exit_code == 0 ? Json::parse(folder.read("s.json")) : Json();
}

void expect_same_pictures(const Folder& folder, const std::string& scene,
                          const std::string& how = "") {
  SCOPED_TRACE(scene + how);
  ASSERT_EQ(
      run("delray pack " + scene + how + " -o s.pack -q --exact-only", folder.path()).exit_code, 0);
  const bool has_views = scene.starts_with("gen:terrain");
  for (const std::string view : {"", " --view iso"}) {
    if (!view.empty() && !has_views) continue;
    const Json expected = rendered(folder, scene, how + view);
    for (const std::string options :
         {"", "--ranks 3", "--strategy sort-first --ranks 3 --threads 2"}) {
      const Json found = rendered(folder, "s.pack", options + view);
      EXPECT_EQ(found["image"]["hash"], expected["image"]["hash"]) << options << view;
      EXPECT_EQ(found["scene"]["triangles"], expected["scene"]["triangles"]);
      EXPECT_GT(found["pack"]["clusters"], 0);
    }
  }
}

TEST(Pack, RendersAsItsSceneDoes) {
  const Folder folder;
  for (const std::string scene : {"gen:terrain:50000", "gen:field:30000"})
    expect_same_pictures(folder, scene);
}

TEST(Pack, OfModelsRendersAsTheyDo) {
  const Folder folder;
  const std::string data = DELRAY_SHARED_DATA "/";
  if (!std::filesystem::exists(data)) GTEST_SKIP() << data << " is not there";
  for (const std::string name : {"spot.obj", "2CylinderEngine.glb"})
    expect_same_pictures(folder, data + name);
  expect_same_pictures(folder, data + "autzen_trim.las", " --color-by z");
}

// Points with heights, some of them far off the others.
std::string points_with_heights(int n, double far_off) {
  std::mt19937 random(20261127);
  std::string text;
  for (int i = 0; i < n; ++i) {
    const double x = random() % 100000 * 1e-2 + 5e5, y = random() % 100000 * 1e-2 + 4e6;
    const double far = i % 997 == 5 ? far_off : 0;
    text += std::to_string(x + far) + " " + std::to_string(y) + " " +
            std::to_string(100 * std::sin(x * 0.02) * std::cos(y * 0.013)) + "\n";
  }
  return text;
}

TEST(Pack, OfAFolderHasThePictureOfTheMeshInOneFile) {
  const Folder folder;
  std::string points = points_with_heights(3000, 0);
  points += points.substr(0, points.find('\n', points.size() / 5) + 1);  // rows that are no corners
  folder.write("p.xyz", points);
  for (const std::string tiles : {"", " --tiles 3", " --threads 2 --method optimistic"}) {
    ASSERT_EQ(run("delray triangulate p.xyz -o m.ply -q" + tiles, folder.path()).exit_code, 0);
    ASSERT_EQ(run("delray triangulate p.xyz -o m/ -q --tiles 5", folder.path()).exit_code, 0);
    ASSERT_EQ(run("delray pack m/ -o m.pack -q", folder.path()).exit_code, 0);
    const Json expected = rendered(folder, "m.ply", "--view iso");
    EXPECT_EQ(rendered(folder, "m.pack", "--view iso")["image"]["hash"], expected["image"]["hash"]);
    EXPECT_EQ(rendered(folder, "m/", "--view iso")["image"]["hash"], expected["image"]["hash"]);
    std::filesystem::remove_all(folder / "m");
  }
}

TEST(Pack, OfAFolderHasThePictureOfItsMesh) {
  const Folder folder;
  folder.write("p.xyz", points_with_heights(3000, 1e5));
  for (const std::string format : {"", " --pieces ply"}) {
    ASSERT_EQ(run("delray triangulate p.xyz -o m/ --tiles 7 -q" + format, folder.path()).exit_code,
              0);
    for (const std::string how : {"", " --color-by material --up y", " --exaggeration 3"}) {
      ASSERT_EQ(run("delray pack m/ -o m.pack -q" + how, folder.path()).exit_code, 0);
      const Json expected = rendered(folder, "m/", how);
      const Json found = rendered(folder, "m.pack", "--ranks 2");
      EXPECT_EQ(found["image"]["hash"], expected["image"]["hash"]) << format << how;
      EXPECT_EQ(found["scene"]["triangles"], expected["scene"]["triangles"]);
    }
    std::filesystem::remove_all(folder / "m");
  }
  // Colours by number are those of the folder in memory, which numbers as its pieces do.
  ASSERT_EQ(run("delray triangulate p.xyz -o m/ --tiles 4 -q", folder.path()).exit_code, 0);
  ASSERT_EQ(run("delray pack m/ -o m.pack -q --color-by simplex", folder.path()).exit_code, 0);
  EXPECT_EQ(rendered(folder, "m.pack", "")["image"]["hash"],
            rendered(folder, "m/", "--color-by simplex")["image"]["hash"]);
  for (const std::string wrong : {"--color-by rgb", "--show-as points", "--duplicates min"})
    EXPECT_EQ(run("delray pack m/ -o n.pack " + wrong, folder.path()).exit_code, 2) << wrong;
  EXPECT_FALSE(std::filesystem::exists(folder / "n.pack"));
}

TEST(Pack, OfPointsHasTheirPicture) {
  const Folder folder;
  folder.write("p.xyz", points_with_heights(2000, 0));
  for (const std::string how :
       {" --show-as points", " --show-as discs --point-size 3", " --show-as spheres --radius 4"}) {
    ASSERT_EQ(run("delray pack p.xyz -o p.pack -q" + how, folder.path()).exit_code, 0) << how;
    for (const std::string options : {"", " --ranks 3", " --engine raytrace"}) {
      if (how == " --show-as points" && !options.ends_with('3') && !options.empty()) continue;
      const Json expected = rendered(folder, "p.xyz", how + options);
      const Json found = rendered(folder, "p.pack", options);
      EXPECT_EQ(found["image"]["hash"], expected["image"]["hash"]) << how << options;
      EXPECT_EQ(found["scene"]["points"], expected["scene"]["points"]);
    }
    const Json coarse = rendered(folder, "p.pack", "--error 20");
    EXPECT_GT(coarse["pack"]["levels"].size(), 1U) << how;
  }
}

// A LAS-like cloud as PLY, with colours, in which some places are there several times.
std::string cloud_with_colours(int n) {
  std::mt19937 random(20261127);
  std::string header =
      "ply\nformat ascii 1.0\nelement vertex " + std::to_string(n) +
      "\nproperty double x\nproperty double y\nproperty double z\nproperty uchar red\n"
      "property uchar green\nproperty uchar blue\nend_header\n";
  std::string rows;
  for (int i = 0; i < n; ++i) {
    const bool shared = i % 10 == 3;
    const double x = shared ? 50 : random() % 100000 * 1e-3,
                 y = shared ? 50 : random() % 100000 * 1e-3;
    const double z = i == 7 ? 1e6 : shared ? 8 : random() % 1000 * 1e-2;  // one far off the others
    for (const double c : {x + 5e5, y + 4e6, z}) rows += std::to_string(c) + " ";
    rows += std::to_string(random() % 256) + " " + std::to_string(random() % 256) + " 90\n";
  }
  return header + rows;
}

TEST(Pack, OfPointsIsTheSameForEveryMemory) {
  const Folder folder;
  folder.write("p.ply", cloud_with_colours(70000));
  std::string expected;
  for (const std::string how : {"", " --memory 64MiB --threads 1", " --memory 80MiB --threads 2"}) {
    const Ran ran =
        run("delray pack p.ply -o p.pack -q --show-as spheres --stats -" + how, folder.path());
    ASSERT_EQ(ran.exit_code, 0) << how << ran.err;
    if (expected.empty()) {
      expected = folder.read("p.pack");
      EXPECT_EQ(rendered(folder, "p.pack", "")["image"]["hash"],
                rendered(folder, "p.ply", "--show-as spheres")["image"]["hash"]);
      continue;
    }
    EXPECT_TRUE(folder.read("p.pack") == expected) << how;
    EXPECT_LE(Json::parse(ran.out)["memory"]["peak_rss"], std::uint64_t{80} << 20);
  }
}

TEST(Pack, KeepsTheLegend) {
  const Folder folder;
  folder.write("p.xyz", points_with_heights(500, 0));
  for (const std::string how : {"", " --show-as discs"}) {
    ASSERT_EQ(run("delray pack p.xyz -o p.pack -q --exaggeration 2" + how, folder.path()).exit_code,
              0);
    const auto picture = [&](const std::string& scene) {
      EXPECT_EQ(
          run("delray render " + scene + " -o p.png -q --size 480x300", folder.path()).exit_code,
          0);
      return folder.read("p.png");
    };
    const std::string expected = picture("p.xyz --legend --exaggeration 2" + how);
    EXPECT_TRUE(picture("p.pack --legend") == expected) << how;
    EXPECT_FALSE(picture("p.pack") == expected) << how;
  }
  ASSERT_EQ(run("delray pack gen:cornell -o c.pack -q", folder.path()).exit_code, 0);
  EXPECT_EQ(run("delray render c.pack -o a.png --legend", folder.path()).exit_code, 2);
}

TEST(Pack, IsVerifiedAsAWhole) {
  const Folder folder;
  ASSERT_EQ(run("delray pack gen:terrain:5000 -o s.pack -q", folder.path()).exit_code, 0);
  const Ran good = run("delray verify s.pack", folder.path());
  EXPECT_EQ(good.exit_code, 0) << good.err;
  EXPECT_NE(good.out.find("valid: yes"), std::string::npos);
  EXPECT_EQ(run("delray verify s.pack --points s.pack", folder.path()).exit_code, 2);
  EXPECT_EQ(run("delray verify s.pack --canonical", folder.path()).exit_code, 2);
  std::uint64_t place = 0, last = 0;
  {
    const packs::PackReader pack(folder / "s.pack");
    place = pack.pages()[7].offset;
    last = pack.pages().back().offset;
  }
  std::string content = folder.read("s.pack");
  content[place] = static_cast<char>(content[place] ^ 1);
  content[last] = static_cast<char>(content[last] ^ 1);
  folder.write("t.pack", content);
  const Ran bad = run("delray verify t.pack --threads 2", folder.path());
  EXPECT_EQ(bad.exit_code, 3);
  EXPECT_NE(bad.err.find("t.pack: page 7, byte " + std::to_string(place)), std::string::npos)
      << bad.err;
}

TEST(Pack, FramesInTimeHaveTheErrorThatFits) {
  const Folder folder;
  ASSERT_EQ(run("delray pack gen:terrain:20000 -o s.pack -q", folder.path()).exit_code, 0);
  const auto errors_of = [&](const std::string& time, const std::string& how = "") {
    const Ran ran =
        run("delray render s.pack -o a.png --size 160x100 --turntable 8 -q --stats - "
            "--frame-time " +
                time + how,
            folder.path());
    EXPECT_EQ(ran.exit_code, 0) << ran.err;
    return Json::parse(ran.out)["animation"]["each"];
  };
  const Json hasty = errors_of("0.1"), patient = errors_of("100000", " --ranks 2");
  ASSERT_EQ(hasty.size(), 8U);
  EXPECT_LT(patient[7]["error"], 0.1);
  EXPECT_GT(patient[7]["triangles"], patient[0]["triangles"]);
  // No frames fall faster than those with time to spare; by how much is the machine's affair.
  for (std::size_t i = 0; i < hasty.size(); ++i)
    EXPECT_GE(hasty[i]["error"], patient[i]["error"]) << i;
  for (const std::string wrong : {"s.pack -o a.png --frame-time 10",
                                  "s.pack -o a.png --turntable 3 --frame-time 10 --error 1",
                                  "gen:cornell -o a.png --turntable 3 --frame-time 10"})
    EXPECT_EQ(run("delray render " + wrong, folder.path()).exit_code, 2) << wrong;
}

TEST(Pack, IsUnpackedForWhatDoesNotReadPages) {
  const Folder folder;
  ASSERT_EQ(run("delray pack gen:spheres:2000 -o s.pack -q --exact-only", folder.path()).exit_code,
            0);
  for (const std::string options :
       {"--strategy sort-middle --ranks 2", "--strategy hybrid --ranks 2", "--engine raytrace",
        "--strategy sort-first --schedule stealing --ranks 2"}) {
    EXPECT_EQ(rendered(folder, "s.pack", options)["image"]["hash"],
              rendered(folder, "gen:spheres:2000", options)["image"]["hash"])
        << options;
  }
}

TEST(Pack, IsReadWhileRaysAreTraced) {
  const Folder folder;
  for (const std::string scene : {"gen:terrain:20000", "gen:field:30000"}) {  // with instances
    ASSERT_EQ(run("delray pack " + scene + " -o s.pack -q --exact-only", folder.path()).exit_code,
              0);
    const Json expected = rendered(folder, scene, "--engine raytrace");
    for (const std::string options : {"--cache 1", "--ranks 3", "--ranks 2 --cache 0.2"}) {
      const Json found = rendered(folder, "s.pack", "--engine raytrace --data object " + options);
      EXPECT_EQ(found["image"]["hash"], expected["image"]["hash"]) << scene << " " << options;
      EXPECT_GT(found["ranks"][0]["data"]["clusters_fetched"], 0) << scene << " " << options;
    }
  }
}

TEST(Pack, AnimationsReadWhatTheyShow) {
  const Folder folder;
  ASSERT_EQ(
      run("delray pack gen:terrain:100000 -o s.pack -q --exact-only", folder.path()).exit_code, 0);
  for (const std::string scene : {"s.pack", "gen:terrain:100000"}) {
    const std::string picture = scene == "s.pack" ? "a.png" : "b.png";
    const Ran ran = run("delray render " + scene + " -o " + picture +
                            " --turntable 5 --size 160x100 -q --threads 2",
                        folder.path());
    ASSERT_EQ(ran.exit_code, 0) << ran.err;
  }
  for (int frame = 0; frame < 5; ++frame) {
    const std::string number = "-000" + std::to_string(frame) + ".png";
    EXPECT_EQ(folder.read("a" + number), folder.read("b" + number)) << frame;
  }
}

TEST(Pack, IsDescribed) {
  const Folder folder;
  const Ran packed = run("delray pack gen:terrain:20000 -o s.pack --stats -", folder.path());
  ASSERT_EQ(packed.exit_code, 0) << packed.err;
  const Json statistics = Json::parse(packed.out);
  EXPECT_EQ(statistics["schema"], "delray.pack/1");
  EXPECT_EQ(statistics["result"]["bytes"], std::filesystem::file_size(folder / "s.pack"));
  const Ran described = run("delray info s.pack --stats -", folder.path());
  ASSERT_EQ(described.exit_code, 0) << described.err;
  const Json description = Json::parse(described.out);
  EXPECT_EQ(description["triangles"], statistics["result"]["triangles"]);
  EXPECT_EQ(description["pages"], statistics["result"]["pages"]);
  EXPECT_GT(description["levels"], 2);
  EXPECT_EQ(description["levels"], statistics["result"]["levels"]);
}

TEST(Pack, OfPointsHasNoTriangles) {
  const Folder folder;
  ASSERT_EQ(
      run("delray generate points uniform -n 3000 --dim 3 -o p.ply -q", folder.path()).exit_code,
      0);
  const Ran packed =
      run("delray pack p.ply --show-as points -o s.pack --stats s.json", folder.path());
  ASSERT_EQ(packed.exit_code, 0) << packed.err;
  EXPECT_NE(packed.err.find("s.pack: 3000 points and lines in "), std::string::npos) << packed.err;
  const Json statistics = Json::parse(folder.read("s.json"))["result"];
  EXPECT_EQ(statistics["triangles"], 0);
  EXPECT_EQ(statistics["points"], 3000);
  const Json description = Json::parse(run("delray info s.pack --stats -", folder.path()).out);
  EXPECT_EQ(description["triangles"], 0);
  EXPECT_EQ(description["stored_triangles"], 0);
  EXPECT_EQ(description["points"], 3000);
  const Ran drawn = run("delray render s.pack -o p.png --size 64x48 --stats r.json", folder.path());
  EXPECT_NE(drawn.err.find("64 x 48, 3000 points and lines"), std::string::npos) << drawn.err;
  const Json scene = Json::parse(folder.read("r.json"))["scene"];
  EXPECT_EQ(scene["triangles"], 0);
  EXPECT_EQ(scene["points"], 3000);
}

TEST(Pack, CountsOneAsOne) {
  const Folder folder;
  folder.write("t.off", "OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  const Ran packed = run("delray pack t.off -o t.pack", folder.path());
  ASSERT_EQ(packed.exit_code, 0) << packed.err;
  EXPECT_NE(packed.err.find("t.pack: 1 triangle in 1 page, "), std::string::npos) << packed.err;
  const Ran verified = run("delray verify t.pack", folder.path());
  EXPECT_NE(verified.out.find("checked: 1 page, "), std::string::npos) << verified.out;
}

TEST(Pack, TerminationLeavesNothing) {
  const Folder folder;
  // Told to end once the program catches SIGTERM, in a minute of work.
  const Ran ran =
      run("delray pack gen:terrain:5000000 -o s.pack & pid=$!; "
          "until grep -q '^SigCgt:.*[4-7c-f]...$' /proc/$pid/status || ! kill -0 $pid; "
          "do sleep 0.1; done; sleep 2; kill -TERM $pid; wait $pid",
          folder.path());
  EXPECT_EQ(ran.exit_code, 130) << ran.err;
  EXPECT_EQ(run("ls -A | wc -l", folder.path()).out, "0\n");
}

TEST(Pack, VerifyNamesWhatIsNone) {
  const Folder folder;
  folder.write("bad.pack", "not one");
  folder.write("mesh.off", "OFF 0 0 0");
  const Ran bad = run("delray verify bad.pack", folder.path());
  EXPECT_EQ(bad.exit_code, 3);
  EXPECT_NE(bad.err.find("bad.pack: this is not a pack"), std::string::npos) << bad.err;
  const Ran mesh = run("delray verify mesh.off", folder.path());
  EXPECT_EQ(mesh.exit_code, 2);
  EXPECT_NE(mesh.err.find("mesh.off"), std::string::npos) << mesh.err;
}

TEST(Pack, WrongUsageIsTwo) {
  const Folder folder;
  ASSERT_EQ(run("delray pack gen:cornell -o s.pack -q", folder.path()).exit_code, 0);
  for (const std::string command :
       {"pack", "pack gen:cornell", "pack gen:cornell -o a.png", "pack gen:cornell -o -",
        "pack s.pack -o s.pack", "pack gen:nothing -o a.pack",
        "render s.pack -o a.png --color-by z", "render s.pack -o a.png --exaggeration 2",
        "render s.pack -o a.png --draw points", "render s.pack -o a.png --wall 2x2 --error 1",
        "render s.pack -o a.png --engine raytrace --error 1"}) {
    EXPECT_EQ(run("delray " + command, folder.path()).exit_code, 2) << command;
  }
  EXPECT_EQ(folder.files(), std::vector<std::string>{"s.pack"});
}

TEST(Pack, DamagedIsThreeAndAFailingDiskIsOne) {
  const Folder folder;
  ASSERT_EQ(run("delray pack gen:terrain:50000 -o s.pack -q --exact-only", folder.path()).exit_code,
            0);
  const std::string content = folder.read("s.pack");
  std::uint64_t place = 0, end = 0;
  {
    const packs::PackReader pack(folder / "s.pack");
    const packs::PageRow& row = pack.pages()[pack.pages().size() / 3];
    place = row.offset;
    end = row.offset + row.bytes;
  }
  const std::string options = " -o p.png --size 160x100 -q --memory 256MiB";
  folder.write("cut.pack", content.substr(0, content.size() * 2 / 3));
  const Ran cut = run("delray render cut.pack" + options, folder.path());
  EXPECT_EQ(cut.exit_code, 3);
  EXPECT_NE(cut.err.find("cut.pack: the pack is cut short"), std::string::npos) << cut.err;

  std::string flipped = content;
  flipped[place + 7] = static_cast<char>(flipped[place + 7] ^ 4);
  folder.write("flipped.pack", flipped);
  for (const std::string how : {"", " --ranks 3", " --ranks 3 --strategy sort-first"}) {
    const Ran ran = run("delray render flipped.pack" + options + how, folder.path());
    EXPECT_EQ(ran.exit_code, 3) << how;
    EXPECT_NE(ran.err.find("flipped.pack: page "), std::string::npos) << ran.err;
    EXPECT_NE(ran.err.find("damaged"), std::string::npos) << ran.err;
  }
#ifdef DELRAY_FAILING_READS
  for (const std::string how : {"", " --ranks 3", " --ranks 3 --strategy sort-first"}) {
    const Ran ran =
        run("LD_PRELOAD=" DELRAY_FAILING_READS " DELRAY_FAIL_FROM=" + std::to_string(place) +
                " DELRAY_FAIL_TO=" + std::to_string(end) + " " DELRAY_PROGRAM " render s.pack" +
                options + how,
            folder.path());
    EXPECT_EQ(ran.exit_code, 1) << how;
    EXPECT_NE(ran.err.find("s.pack: byte " + std::to_string(place) + ": cannot read"),
              std::string::npos)
        << ran.err;
  }
#endif
  EXPECT_FALSE(std::filesystem::exists(folder / "p.png"));
}

TEST(Pack, WithABoundOfErrorShowsCoarserLevels) {
  const Folder folder;
  ASSERT_EQ(run("delray pack gen:terrain:60000 -o s.pack -q", folder.path()).exit_code, 0);
  const Json exact = rendered(folder, "s.pack", "");
  EXPECT_EQ(exact["image"]["hash"], rendered(folder, "gen:terrain:60000", "")["image"]["hash"]);
  EXPECT_EQ(exact["pack"]["levels"].size(), 1U);
  const Json coarse = rendered(folder, "s.pack", "--error 2");
  EXPECT_GT(coarse["pack"]["levels"].size(), 1U);
  EXPECT_EQ(coarse["options"]["error"], 2);
  EXPECT_LT(coarse["raster"]["triangles"]["in"], exact["raster"]["triangles"]["in"]);
  for (const std::string options :
       {"--error 2 --ranks 3", "--error 2 --strategy sort-first --ranks 3"}) {
    EXPECT_EQ(rendered(folder, "s.pack", options)["image"]["hash"], coarse["image"]["hash"]);
  }
  for (const std::string command : {"gen:cornell -o a.png --error 1", "s.pack -o a.png --error -1",
                                    "s.pack -o a.png --error 1 --engine raytrace",
                                    "s.pack -o a.png --error 1 --strategy hybrid"}) {
    EXPECT_EQ(run("delray render " + command, folder.path()).exit_code, 2) << command;
  }
}

TEST(Pack, KeepsItsMemory) {
  const Folder folder;
  ASSERT_EQ(
      run("delray pack gen:terrain:1000000 -o s.pack -q --exact-only", folder.path()).exit_code, 0);
  const Json free = rendered(folder, "s.pack", "--memory 4GiB");
  const Json tight = rendered(folder, "s.pack", "--memory 96MiB");
  EXPECT_EQ(tight["image"]["hash"], free["image"]["hash"]);
  EXPECT_LE(tight["ranks"][0]["peak_rss"], std::uint64_t{96} << 20);
  EXPECT_GT(tight["pack"]["bytes_read"], free["pack"]["bytes_read"]);
}

}  // namespace
}  // namespace delray::tests
