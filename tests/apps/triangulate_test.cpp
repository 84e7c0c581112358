// delray generate, triangulate, verify and info on points.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/run_program.h"

namespace delray::tests {
namespace {

using nlohmann::json;

TEST(TriangulateCommand, WritesStatisticsWithEveryKey) {
  const Folder folder;
  ASSERT_EQ(run("delray generate points gauss -n 1000 --seed 3 -o p.ply", folder.path()).exit_code,
            0);
  const Ran ran = run("delray triangulate p.ply -o m.ply --stats -", folder.path());
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const json stats = json::parse(ran.out);
  EXPECT_EQ(stats["schema"], "delray.triangulate/1");
  for (const char* key : {"file", "points", "distinct", "dim"}) {
    EXPECT_TRUE(stats["input"].contains(key)) << key;
  }
  for (const char* key : {"method", "location", "split", "order", "threads", "seed"}) {
    EXPECT_TRUE(stats["options"].contains(key)) << key;
  }
  for (const char* key :
       {"read", "triangulate", "write", "order", "locate", "subdivide", "legalize", "extract"}) {
    EXPECT_TRUE(stats["seconds"][key].is_number()) << key;
  }
  for (const char* key : {"lock_calls", "already_locked", "free", "waits", "deadlocks", "rollbacks",
                          "repaired", "fragments"}) {
    EXPECT_EQ(stats["sync"][key], 0) << key;
  }
  EXPECT_GT(stats["memory"]["peak_rss"], 0);
  EXPECT_EQ(stats["input"]["points"], 1000);
  // Euler: every distinct point is a vertex, so simplices = 2 n - 2 - hull.
  const int distinct = stats["input"]["distinct"], hull = stats["result"]["hull_facets"];
  EXPECT_EQ(stats["result"]["simplices"], 2 * distinct - 2 - hull);
  EXPECT_EQ(stats["result"]["hash"].get<std::string>().size(), 32U);
}

TEST(TriangulateCommand, EveryMeshFormatVerifies) {
  const Folder folder;
  for (const std::string dim : {"2", "3"}) {
    ASSERT_EQ(run("delray generate points cluster -n 500 --dim " + dim + " -o p.ply", folder.path())
                  .exit_code,
              0);
    std::string hash;
    for (const std::string suffix : {"ply", "obj", "off", "vtu", "node"}) {
      const std::string mesh = "m." + suffix;
      ASSERT_EQ(run("delray triangulate p.ply -o " + mesh, folder.path()).exit_code, 0) << mesh;
      const Ran ran =
          run("delray verify " + mesh + " --points p.ply --canonical --stats -", folder.path());
      ASSERT_EQ(ran.exit_code, 0) << mesh << ran.err;
      const json stats = json::parse(ran.out);
      if (hash.empty()) hash = stats["result"]["hash"];
      EXPECT_EQ(stats["result"]["hash"], hash) << mesh;
    }
  }
}

TEST(TriangulateCommand, StreamsThroughStandardInputAndOutput) {
  const Folder folder;
  const Ran ran =
      run("delray generate points uniform -n 300 -o - | delray triangulate - -o - -q >m.ply && "
          "delray generate points uniform -n 300 -o p.xyz && delray verify m.ply --points p.xyz",
          folder.path());
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
}

TEST(TriangulateCommand, DegenerateInputIsAWarning) {
  const Folder folder;
  folder.write("equal.xyz", "1 2\n1 2\n1 2\n");
  folder.write("line.xyz", "0 0\n1 1\n2 2\n-5 -5\n");
  folder.write("one.xyz", "4 5\n");
  for (const std::string name : {"equal", "line", "one"}) {
    const Ran ran = run("delray triangulate " + name + ".xyz -o m.ply", folder.path());
    EXPECT_EQ(ran.exit_code, 0) << name << ran.err;
    EXPECT_NE(ran.err.find("no simplices"), std::string::npos) << ran.err;
    EXPECT_EQ(run("delray verify m.ply --points " + name + ".xyz", folder.path()).exit_code, 0);
  }
}

TEST(TriangulateCommand, DuplicatesChooseTheHeight) {
  const Folder folder;
  folder.write("p.xyz", "0 0 5\n1 0 0\n0 1 0\n0 0 1\n0 0 3\n");
  for (const auto& [policy, height] : std::vector<std::pair<std::string, std::string>>{
           {"first", "5"}, {"min", "1"}, {"max", "5"}, {"mean", "3"}}) {
    const Ran ran = run("delray triangulate p.xyz -o m.obj --duplicates " + policy, folder.path());
    ASSERT_EQ(ran.exit_code, 0) << ran.err;
    EXPECT_NE(ran.err.find("1 places have several heights (3 rows)"), std::string::npos) << ran.err;
    EXPECT_NE(folder.read("m.obj").find("v 0 0 " + height + "\n"), std::string::npos)
        << folder.read("m.obj");
  }
}

TEST(VerifyCommand, FindsAWrongMesh) {
  const Folder folder;
  folder.write("p.xyz", "0 0\n4 0\n5 3\n0 3\n");
  folder.write("good.off", "OFF\n4 2 0\n0 0 0\n4 0 0\n5 3 0\n0 3 0\n3 0 1 3\n3 1 2 3\n");
  folder.write("flipped.off", "OFF\n4 2 0\n0 0 0\n4 0 0\n5 3 0\n0 3 0\n3 0 1 2\n3 0 2 3\n");
  folder.write("hole.off", "OFF\n4 1 0\n0 0 0\n4 0 0\n5 3 0\n0 3 0\n3 0 1 3\n");
  folder.write("moved.off", "OFF\n4 2 0\n0 0 0\n4 1 0\n5 3 0\n0 3 0\n3 0 1 3\n3 1 2 3\n");
  EXPECT_EQ(run("delray verify good.off --points p.xyz", folder.path()).exit_code, 0);
  const Ran flipped = run("delray verify flipped.off --points p.xyz", folder.path());
  EXPECT_EQ(flipped.exit_code, 4);
  EXPECT_NE(flipped.err.find("simplex"), std::string::npos) << flipped.err;
  EXPECT_NE(flipped.out.find("valid: yes\ndelaunay: no\n"), std::string::npos) << flipped.out;
  EXPECT_EQ(run("delray verify hole.off --points p.xyz", folder.path()).exit_code, 4);
  EXPECT_EQ(run("delray verify moved.off --points p.xyz", folder.path()).exit_code, 3);
}

TEST(VerifyCommand, CanonicalIsReportedSeparately) {
  const Folder folder;
  folder.write("p.xyz", "0 0\n1 0\n1 1\n0 1\n");
  const std::string head = "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
  folder.write("a.off", head + "3 0 1 2\n3 0 2 3\n");
  folder.write("b.off", head + "3 0 1 3\n3 1 2 3\n");
  int canonical = 0;
  for (const std::string mesh : {"a.off", "b.off"}) {
    EXPECT_EQ(run("delray verify " + mesh + " --points p.xyz", folder.path()).exit_code, 0);
    const int code =
        run("delray verify " + mesh + " --points p.xyz --canonical", folder.path()).exit_code;
    EXPECT_TRUE(code == 0 || code == 4) << code;
    canonical += code == 0 ? 1 : 0;
  }
  EXPECT_EQ(canonical, 1);
}

TEST(InfoCommand, CountsPointsMeshesAndScenes) {
  const Folder folder;
  ASSERT_EQ(run("delray generate points grid -n 100 --dim 3 -o p.csv", folder.path()).exit_code, 0);
  const json points = json::parse(run("delray info p.csv --stats -", folder.path()).out);
  EXPECT_EQ(points["points"], 100);
  EXPECT_EQ(points["dim"], 3);
  ASSERT_EQ(run("delray triangulate p.csv -o m.ply -q", folder.path()).exit_code, 0);
  const json mesh = json::parse(run("delray info m.ply --stats -", folder.path()).out);
  EXPECT_EQ(mesh["points"], 100);
  EXPECT_GT(mesh["simplices"], 0);
  ASSERT_EQ(run("delray generate scene spheres -n 5000 -o s.glb", folder.path()).exit_code, 0);
  const json scene = json::parse(run("delray info s.glb --stats -", folder.path()).out);
  const json generated =
      json::parse(run("delray info gen:spheres:5000 --stats -", folder.path()).out);
  EXPECT_EQ(scene["triangles"], generated["triangles"]);
  EXPECT_EQ(scene["instances"], generated["instances"]);
}

}  // namespace
}  // namespace delray::tests
