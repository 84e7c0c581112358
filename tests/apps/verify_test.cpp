// delray verify on meshes that are not numbered as their points are.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/run_program.h"

namespace delray::tests {
namespace {

using nlohmann::json;

// Half of it flat, so that most points are not needed.
std::string wavy_slope() {
  std::string text;
  for (int i = 0; i < 400; ++i) {
    const double x = i % 20 + 0.1 * std::sin(i * 7.0), y = i / 20 + 0.1 * std::cos(i * 5.0);
    text += std::to_string(x) + " " + std::to_string(y) + " " +
            std::to_string(x < 10 ? 0 : (x - 10) * y / 5) + "\n";
  }
  return text;
}

TEST(VerifyCommand, ChecksMeshesThatLeaveOutPoints) {
  const Folder folder;
  folder.write("p.xyz", wavy_slope());
  for (const std::string format : {"ply", "obj", "off", "vtu", "stl", "node"}) {
    SCOPED_TRACE(format);
    const std::string mesh = "m." + format;
    const Ran made =
        run("delray triangulate p.xyz --max-error 0.1 --stats - -o " + mesh, folder.path());
    ASSERT_EQ(made.exit_code, 0) << made.err;
    const Ran ran =
        run("delray verify --canonical --points p.xyz --stats - " + mesh, folder.path());
    ASSERT_EQ(ran.exit_code, 0) << ran.err;
    EXPECT_NE(ran.err.find("are no vertex"), std::string::npos) << ran.err;
    const json result = json::parse(ran.out)["result"];
    EXPECT_EQ(result["points"], 400);
    EXPECT_EQ(result["distinct"], 400);
    const int vertices = result["vertices"], unused = result["unused"];
    EXPECT_EQ(vertices + unused, 400);
    EXPECT_GT(unused, 0);
    EXPECT_EQ(result["matched"], format == "stl" ? "32-bit coordinates" : "coordinates");
    EXPECT_EQ(result["hash"], json::parse(made.out)["result"]["hash"]);
    EXPECT_EQ(run("delray verify --complete --points p.xyz " + mesh, folder.path()).exit_code, 4);
  }
}

TEST(VerifyCommand, ChecksStl) {
  const Folder folder;
  folder.write("p.xyz", wavy_slope());
  ASSERT_EQ(run("delray triangulate p.xyz -o m.stl", folder.path()).exit_code, 0);
  const Ran ran = run("delray verify m.stl --canonical --complete --points p.xyz", folder.path());
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_NE(ran.out.find("0 of 400 distinct points are no vertex"), std::string::npos) << ran.out;
  // As text, with one edge of a square of points that are not on one circle.
  const auto facet = [](const std::string& a, const std::string& b, const std::string& c) {
    return "facet normal 0 0 1\nouter loop\nvertex " + a + "\nvertex " + b + "\nvertex " + c +
           "\nendloop\nendfacet\n";
  };
  const std::string a = "0 0 0", b = "1 0 0", c = "1.1 1.1 0", d = "0 1 0";
  folder.write("q.xyz", "0 0\n1 0\n1.1 1.1\n0 1\n");
  folder.write("good.stl", "solid q\n" + facet(a, b, d) + facet(b, c, d) + "endsolid q\n");
  folder.write("flipped.stl", "solid q\n" + facet(a, b, c) + facet(a, c, d) + "endsolid q\n");
  folder.write("moved.stl", "solid q\n" + facet(a, b, "0 1.5 0") + "endsolid q\n");
  EXPECT_EQ(run("delray verify good.stl --points q.xyz", folder.path()).exit_code, 0);
  EXPECT_EQ(run("delray verify flipped.stl --points q.xyz", folder.path()).exit_code, 4);
  const Ran moved = run("delray verify moved.stl --points q.xyz", folder.path());
  EXPECT_EQ(moved.exit_code, 3);
  EXPECT_NE(moved.err.find("vertex 2: (0, 1.5) is none of the points"), std::string::npos)
      << moved.err;
}

TEST(VerifyCommand, RefusesStlThatMayBeOfSeveralPoints) {
  const Folder folder;
  folder.write("p.xyz", "600000.0001 0\n600000.0002 1\n600000.0003 1\n600001 0\n");
  ASSERT_EQ(run("delray triangulate p.xyz -o m.stl", folder.path()).exit_code, 0);
  const Ran ran = run("delray verify m.stl --points p.xyz", folder.path());
  EXPECT_EQ(ran.exit_code, 3);
  EXPECT_NE(ran.err.find("row 1 or row 2"), std::string::npos) << ran.err;
}

TEST(VerifyCommand, ComparesHeights) {
  const Folder folder;
  folder.write("p.xyz", wavy_slope());
  for (const std::string format : {"ply", "obj", "off", "vtu", "node"}) {
    const std::string mesh = "m." + format;
    ASSERT_EQ(run("delray triangulate p.xyz -o " + mesh, folder.path()).exit_code, 0);
    const Ran ran = run("delray verify --points p.xyz " + mesh, folder.path());
    EXPECT_EQ(ran.exit_code, 0) << ran.err;
    EXPECT_NE(ran.out.find("heights are equal"), std::string::npos) << format << ran.out;
  }
  folder.write("q.xyz", "0 0 3.7\n4 0 1\n4 5 2\n0 4 3\n");
  const std::string faces = "3 0 1 3\n3 1 2 3\n";
  const std::string rest = "4 0 1\n4 5 2\n0 4 3\n" + faces;
  folder.write("bad.off", "OFF\n4 2 0\n0 0 999\n" + rest);
  folder.write("rows.off", "OFF\n4 2 0\n0 4 3\n0 0 3.7\n4 0 7\n4 5 2\n3 1 2 0\n3 2 3 0\n");
  folder.write("flat.off", "OFF\n4 2 0\n0 0 0\n4 0 0\n4 5 0\n0 4 0\n" + faces);
  const Ran bad = run("delray verify bad.off --points q.xyz --stats s.json", folder.path());
  EXPECT_EQ(bad.exit_code, 4);
  EXPECT_NE(bad.err.find("vertex 0: the height is 999"), std::string::npos) << bad.err;
  EXPECT_EQ(json::parse(folder.read("s.json"))["result"]["heights"], "different");
  const Ran rows = run("delray verify rows.off --points q.xyz", folder.path());
  EXPECT_EQ(rows.exit_code, 4);
  EXPECT_NE(rows.err.find("vertex 2: the height is 7"), std::string::npos) << rows.err;
  const Ran flat = run("delray verify flat.off --points q.xyz", folder.path());
  EXPECT_EQ(flat.exit_code, 0) << flat.err;
  EXPECT_NE(flat.out.find("the mesh has none"), std::string::npos) << flat.out;
}

TEST(VerifyCommand, OfSeveralHeightsOneCounts) {
  const Folder folder;
  folder.write("p.xyz", "0 0 1\n4 0 1\n4 5 2\n0 4 3\n0 0 2\n");
  ASSERT_EQ(run("delray triangulate p.xyz --duplicates mean -o m.off", folder.path()).exit_code, 0);
  const std::string verify = "delray verify m.off --points p.xyz";
  EXPECT_EQ(run(verify + " --duplicates mean", folder.path()).exit_code, 0);
  const Ran first = run(verify, folder.path());
  EXPECT_EQ(first.exit_code, 4);
  EXPECT_NE(first.err.find("--duplicates"), std::string::npos) << first.err;
}

TEST(VerifyCommand, TakesVerticesInAnyOrder) {
  const Folder folder;
  folder.write("p.xyz", "0 0\n4 0\n5 5\n0 4\n2 2\n2 2\n");
  folder.write("m.off",
               "OFF\n5 4 0\n2 2 0\n0 4 0\n5 5 0\n4 0 0\n0 0 0\n"
               "3 0 1 4\n3 0 4 3\n3 0 3 2\n3 0 2 1\n");
  const Ran ran = run("delray verify m.off --complete --points p.xyz --stats -", folder.path());
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  const json result = json::parse(ran.out)["result"];
  EXPECT_EQ(result["distinct"], 5);
  EXPECT_EQ(result["unused"], 0);
  // A vertex without triangles is one that is not covered.
  folder.write("h.off", "OFF\n4 1 0\n0 4 0\n4 0 0\n0 0 0\n5 5 0\n3 0 2 1\n");
  EXPECT_EQ(run("delray verify h.off --points p.xyz", folder.path()).exit_code, 4);
}

// By threads and by processes, of good folders and of bad ones.
TEST(VerifyCommand, RanksSayTheSameOfFolders) {
  const Folder folder;
  ASSERT_EQ(run("delray generate points uniform -n 3000 --dim 3 -o p.ply && "
                "delray generate points uniform -n 3000 --dim 3 --seed 2 -o other.ply && "
                "delray generate points uniform -n 2990 --dim 3 -o fewer.ply && "
                "delray triangulate p.ply -o m/ --tiles 9 && "
                "delray triangulate p.ply -o s/ --dim 3 --tiles 5 && "
                "delray triangulate p.ply -o m.ply",
                folder.path())
                .exit_code,
            0);
  const struct {
    std::string what;
    int exit_code;
  } cases[] = {{"m --points p.ply --canonical", 0}, {"s --points p.ply --dim 3", 0},
               {"m --points other.ply", 3},         {"m --points fewer.ply", 3},
               {"s --points other.ply --dim 3", 3}, {"m --points p.ply fewer.ply", 4}};
  for (const auto& each : cases) {
    const std::string command = "delray verify " + each.what;
    const Ran one = run(command, folder.path());
    EXPECT_EQ(one.exit_code, each.exit_code) << each.what << ": " << one.err;
    const std::string numbers = run(command + " --stats -", folder.path()).out;
    for (const std::string& how :
         {command + " --ranks 3 --threads 1", mpirun(2) + command + " --threads 1 --scratch ."}) {
      const Ran ran = run(how, folder.path());
      EXPECT_EQ(ran.exit_code, each.exit_code) << how << ": " << ran.err;
      EXPECT_EQ(ran.out, one.out) << how;
      if (!how.starts_with("delray")) continue;
      EXPECT_EQ(ran.err, one.err) << how;
      EXPECT_EQ(run(how + " --stats -", folder.path()).out, numbers) << how;
    }
  }
  // A vertex that is no point is bad input of a file, too.
  EXPECT_EQ(run("delray verify m.ply --points other.ply", folder.path()).exit_code, 3);
  EXPECT_EQ(run("delray verify m.ply --points p.ply --ranks 2", folder.path()).exit_code, 2);
  EXPECT_EQ(run("delray verify m.ply --points p.ply --threads 2", folder.path()).exit_code, 0);
}

}  // namespace
}  // namespace delray::tests
