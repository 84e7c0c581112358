// delray triangulate --improve: meshes of other programs.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/run_program.h"

namespace delray::tests {
namespace {

using nlohmann::json;

// A long quadrilateral cut along its long diagonal, one triangle clockwise.
constexpr const char* kLong = "OFF\n4 2 0\n-4 0 5\n0 -1 6\n4 0 7\n0 1 8\n3 0 1 2\n3 0 3 2\n";

TEST(ImproveCommand, MakesAMeshDelaunay) {
  const Folder folder;
  folder.write("long.off", kLong);
  for (const std::string criterion : {"circle", "angle"}) {
    const Ran ran =
        run("delray triangulate --improve long.off -o short.off --stats - --criterion " + criterion,
            folder.path());
    ASSERT_EQ(ran.exit_code, 0) << ran.err;
    const json stats = json::parse(ran.out);
    EXPECT_EQ(stats["schema"], "delray.triangulate/1");
    EXPECT_EQ(stats["options"]["method"], "improve");
    EXPECT_EQ(stats["options"]["criterion"], criterion);
    EXPECT_EQ(stats["result"]["flips"]["2-2"], 1);
    EXPECT_EQ(stats["result"]["turned"], 1);
    EXPECT_EQ(stats["result"]["blocked"], 0);
    const Ran verified =
        run("delray verify short.off --points long.off --canonical --stats -", folder.path());
    EXPECT_EQ(verified.exit_code, 0) << verified.err;
    EXPECT_EQ(json::parse(verified.out)["result"]["hash"], stats["result"]["hash"]);
    EXPECT_NE(folder.read("short.off").find("-4 0 5"), std::string::npos);
  }
}

TEST(ImproveCommand, FlipsInSpaceByKind) {
  const Folder folder;
  // Two tetrahedra on a triangle that the edge between their tips should cross.
  folder.write("m.node", "5 3 0 0\n0 0 0 0.2\n1 9 0 0\n2 0 9 0\n3 3 3 0.3\n4 3 3 -0.3\n");
  folder.write("m.ele", "2 4 0\n0 0 1 2 3\n1 0 1 2 4\n");
  const Ran ran = run("delray triangulate --improve m.node -o n.vtu --stats -", folder.path());
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const json stats = json::parse(ran.out);
  EXPECT_EQ(stats["result"]["flips"]["2-3"], 1) << stats;
  EXPECT_EQ(stats["result"]["simplices"], 3);
  EXPECT_EQ(stats["input"]["dim"], 3);
  EXPECT_EQ(run("delray verify n.vtu --dim 3 --points m.node --canonical", folder.path()).exit_code,
            0);
}

TEST(ImproveCommand, BrokenMeshesAreBadInputWithTheirPlace) {
  const Folder folder;
  const struct {
    const char *name, *content, *message;
  } meshes[] = {
      {"missing.off", "OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n",
       "row 3 is in no triangle"},
      {"dent.off", "OFF\n4 2 0\n0 0 0\n4 0 0\n1 1 0\n0 4 0\n3 0 1 2\n3 0 2 3\n",
       "the boundary is not convex at row 2"},
      {"double.off", "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 1 2\n", "simplex 0: "},
      {"folded.off", "OFF\n4 2 0\n0 0 0\n4 0 0\n0 4 0\n1 1 0\n3 0 1 2\n3 0 1 3\n",
       "lies on the same side of"},
      {"flat.off", "OFF\n4 2 0\n0 0 0\n1 0 0\n2 0 0\n0 1 0\n3 0 1 2\n3 0 2 3\n",
       "simplex 0: its vertices are collinear"},
      {"none.off", "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n", "there are no triangles"},
      {"number.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n", "line 6"},
  };
  for (const auto& mesh : meshes) {
    folder.write(mesh.name, mesh.content);
    const Ran ran =
        run("delray triangulate -o out.ply --improve " + std::string(mesh.name), folder.path());
    EXPECT_EQ(ran.exit_code, 3) << mesh.name << ran.err;
    EXPECT_NE(ran.err.find(mesh.name), std::string::npos) << ran.err;
    EXPECT_NE(ran.err.find(mesh.message), std::string::npos) << mesh.name << ran.err;
    EXPECT_EQ(folder.read("out.ply"), "") << mesh.name;
  }
}

TEST(ImproveCommand, RefusesWhatHasNoEffect) {
  const Folder folder;
  folder.write("long.off", kLong);
  folder.write("p.xyz", "0 0\n1 0\n0 1\n");
  for (const std::string options :
       {"p.xyz", "--method insertion", "--seed 3", "--tiles 4", "--dim 3", "--max-error 1",
        "--distributed chen", "--duplicates min", "--ranks 2", "--makers", "--criterion square"}) {
    const Ran ran =
        run("delray triangulate " + options + " --improve long.off -o m.vtu", folder.path());
    EXPECT_EQ(ran.exit_code, 2) << options << ran.err;
  }
  EXPECT_EQ(run("delray triangulate p.xyz --criterion angle -o m.ply", folder.path()).exit_code, 2);
  EXPECT_EQ(run("delray triangulate --improve long.off -o long.off", folder.path()).exit_code, 2);
}

}  // namespace
}  // namespace delray::tests
