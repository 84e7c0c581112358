// delray triangulate and verify in four to six dimensions.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>

#include "tests/support/run_program.h"

namespace delray::tests {
namespace {

using nlohmann::json;

std::string node_file(int dim, int n) {
  std::mt19937_64 random(static_cast<std::uint64_t>(dim));
  std::string text = std::to_string(n) + " " + std::to_string(dim) + " 0 0\n";
  for (int i = 0; i < n; ++i) {
    text += std::to_string(i);
    for (int k = 0; k < dim; ++k) text += " " + std::to_string(random() % 5);
    text += "\n";
  }
  return text;
}

TEST(TriangulateCommand, GoesToSixDimensions) {
  const Folder folder;
  for (int dim = 4; dim <= 6; ++dim) {
    const std::string d = " --dim " + std::to_string(dim);
    folder.write("p.node", node_file(dim, 24));
    const Ran ran =
        run("delray triangulate p.node -o m.node --seed 7 --stats -" + d, folder.path());
    ASSERT_EQ(ran.exit_code, 0) << ran.err;
    const json stats = json::parse(ran.out);
    EXPECT_EQ(stats["schema"], "delray.triangulate/1");
    EXPECT_EQ(stats["input"]["dim"], dim);
    EXPECT_EQ(stats["input"]["points"], 24);
    EXPECT_GT(stats["result"]["simplices"], 0);
    EXPECT_GT(stats["result"]["hull_facets"], dim);
    EXPECT_TRUE(stats["sync"].contains("lock_calls"));
    const Ran verified =
        run("delray verify m.ele --points p.node --canonical --stats -" + d, folder.path());
    ASSERT_EQ(verified.exit_code, 0) << verified.err;
    const json verdict = json::parse(verified.out);
    EXPECT_EQ(verdict["result"]["hash"], stats["result"]["hash"]);
    EXPECT_EQ(verdict["result"]["simplices"], stats["result"]["simplices"]);
    EXPECT_EQ(verdict["result"]["distinct"], stats["input"]["distinct"]);
  }
}

TEST(VerifyCommand, SeesWhatIsWrongInFourDimensions) {
  const Folder folder;
  folder.write("p.node",
               "6 4 0 0\n0 0 0 0 0\n1 1 0 0 0\n2 0 1 0 0\n3 0 0 1 0\n4 0 0 0 1\n5 1 1 1 1\n");
  folder.write("m.node", folder.read("p.node"));
  folder.write("m.ele", "1 5 0\n0 0 1 2 3 4\n");
  const std::string verify = "delray verify m.node --dim 4 --points p.node";
  Ran ran = run(verify, folder.path());
  EXPECT_EQ(ran.exit_code, 4) << ran.err;
  EXPECT_NE(ran.out.find("valid: no"), std::string::npos) << ran.out;
  folder.write("p.node",
               "6 4 0 0\n0 0 0 0 0\n1 1 0 0 0\n2 0 1 0 0\n3 0 0 1 0\n4 0 0 0 1\n5 1 1 1 2\n");
  ran = run(verify, folder.path());
  EXPECT_EQ(ran.exit_code, 3);
  EXPECT_NE(ran.err.find("vertex 5"), std::string::npos) << ran.err;
}

TEST(TriangulateCommand, RefusesWhatFourDimensionsDoNotHave) {
  const Folder folder;
  folder.write("p.node", node_file(4, 10));
  folder.write("p.xyz", "0 0 0\n1 0 0\n0 1 0\n");
  for (const std::string arguments :
       {"p.xyz -o m.node --dim 4", "p.node -o m.ply --dim 4", "p.node -o m.node --dim 5",
        "p.node -o m.node --dim 4 --threads 2", "p.node -o m.node --dim 4 --method cavity",
        "p.node -o m.node --dim 4 --tiles 2", "p.node -o p.node --dim 4", "p.node --dim 4",
        "p.node -o m.node --dim 7", "p.node -o m/ --dim 4"}) {
    const Ran ran = run("delray triangulate " + arguments, folder.path());
    EXPECT_EQ(ran.exit_code, 2) << arguments << ran.err;
  }
  const Ran ran = run("delray triangulate p.node -o m.node", folder.path());
  EXPECT_EQ(ran.exit_code, 3);
  EXPECT_NE(ran.err.find("--dim 4"), std::string::npos) << ran.err;
  folder.write("p.node", "2 4 0 0\n0 1 2 3 4\n1 1 2 3\n");
  const Ran broken = run("delray triangulate p.node -o m.node --dim 4", folder.path());
  EXPECT_EQ(broken.exit_code, 3);
  EXPECT_NE(broken.err.find("line 3"), std::string::npos) << broken.err;
  EXPECT_EQ(folder.read("m.node"), "");
}

TEST(TriangulateCommand, SaysThatPointsAreInOneHyperplane) {
  const Folder folder;
  folder.write("p.node",
               "6 4 0 0\n0 0 0 0 0\n1 1 0 0 0\n2 0 1 0 0\n3 0 0 1 0\n4 1 1 0 0\n5 1 1 1 0\n");
  const Ran ran = run("delray triangulate p.node -o m.node --dim 4", folder.path());
  EXPECT_EQ(ran.exit_code, 0);
  EXPECT_NE(ran.err.find("hyperplane"), std::string::npos) << ran.err;
  EXPECT_EQ(run("delray verify m.node --points p.node --dim 4", folder.path()).exit_code, 0);
}

}  // namespace
}  // namespace delray::tests
