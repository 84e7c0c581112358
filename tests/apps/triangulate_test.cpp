// delray generate, triangulate, verify and info on points.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "delaunay/distributed.h"
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
                          "repaired", "fragments", "dag_nodes", "dag_node_bytes", "unlocked_early",
                          "mutex_locks", "mutex_waits", "mutex_bytes"}) {
    EXPECT_EQ(stats["sync"][key], 0) << key;
  }
  EXPECT_EQ(stats["sync"]["searching"], json::array());
  EXPECT_GT(stats["memory"]["peak_rss"], 0);
  EXPECT_EQ(stats["input"]["points"], 1000);
  // Euler: every distinct point is a vertex, so simplices = 2 n - 2 - hull.
  const int distinct = stats["input"]["distinct"], hull = stats["result"]["hull_facets"];
  EXPECT_EQ(stats["result"]["simplices"], 2 * distinct - 2 - hull);
  EXPECT_EQ(stats["result"]["hash"].get<std::string>().size(), 32U);
}

TEST(TriangulateCommand, WritesStatisticsInSpace) {
  const Folder folder;
  // A lattice with its first point twice.
  std::string text;
  for (int i = 0; i < 27; ++i) {
    text += std::to_string(i % 3) + " " + std::to_string(i / 3 % 3) + " " + std::to_string(i / 9) +
            "\n";
  }
  folder.write("p.xyz", text + "0 0 0\n");
  const Ran ran =
      run("delray triangulate p.xyz --dim 3 -o m.vtu --threads 2 --stats -", folder.path());
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const json stats = json::parse(ran.out);
  EXPECT_EQ(stats["schema"], "delray.triangulate/1");
  EXPECT_EQ(stats["input"]["dim"], 3);
  EXPECT_EQ(stats["input"]["points"], 28);
  EXPECT_EQ(stats["input"]["distinct"], 27);
  EXPECT_EQ(stats["options"]["threads"], 2);
  // Two triangles for each of the 4 squares of each of the 6 sides.
  EXPECT_EQ(stats["result"]["hull_facets"], 48);
  EXPECT_GE(stats["result"]["simplices"], 5 * 8);
  EXPECT_LE(stats["result"]["simplices"], 6 * 8);
  for (const char* key :
       {"read", "triangulate", "write", "order", "locate", "subdivide", "legalize", "extract"}) {
    EXPECT_TRUE(stats["seconds"][key].is_number()) << key;
  }
  EXPECT_GT(stats["memory"]["peak_rss"], 0);
  const Ran verified =
      run("delray verify m.vtu --dim 3 --points p.xyz --canonical --stats -", folder.path());
  ASSERT_EQ(verified.exit_code, 0) << verified.err;
  const json verdict = json::parse(verified.out);
  EXPECT_EQ(verdict["dim"], 3);
  EXPECT_EQ(verdict["result"]["hash"], stats["result"]["hash"]);
  EXPECT_EQ(verdict["result"]["distinct"], 27);
  EXPECT_EQ(verdict["result"]["simplices"], stats["result"]["simplices"]);
}

TEST(TriangulateCommand, EveryMeshFormatVerifies) {
  const Folder folder;
  for (const std::string dim : {"2", "3"}) {
    ASSERT_EQ(run("delray generate points cluster -n 500 --dim " + dim + " -o p.ply", folder.path())
                  .exit_code,
              0);
    std::string hash;
    for (const std::string& suffix :
         dim == "2" ? std::vector<std::string>{"ply", "obj", "off", "vtu", "node"}
                    : std::vector<std::string>{"vtu", "node"}) {
      const std::string mesh = "m." + suffix, options = " --dim " + dim;
      ASSERT_EQ(run("delray triangulate p.ply -o " + mesh + options, folder.path()).exit_code, 0)
          << mesh;
      const Ran ran =
          run("delray verify " + mesh + " --points p.ply --canonical --stats -" + options,
              folder.path());
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

TEST(TriangulateCommand, MaxErrorKeepsWhatTheBoundNeeds) {
  const Folder folder;
  // A plane with one peak and one bump below the bound.
  std::string text;
  for (int i = 0; i < 100; ++i) {
    const int x = i % 10, y = i / 10;
    const double height = 2 * x - y + (i == 55 ? 7 : i == 22 ? 0.25 : 0);
    text += std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(height) + "\n";
  }
  folder.write("p.xyz", text);
  const Ran ran = run("delray triangulate p.xyz -o m.ply --max-error 0.5 --stats -", folder.path());
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const json stats = json::parse(ran.out);
  EXPECT_EQ(stats["options"]["max_error"], 0.5);
  EXPECT_EQ(stats["input"]["points"], 100);
  EXPECT_LE(stats["result"]["largest_error"], 0.5);
  const int kept = stats["result"]["kept"];
  EXPECT_GE(kept, 5);
  EXPECT_LT(kept, 40);
  const json mesh = json::parse(run("delray info m.ply --stats -", folder.path()).out);
  EXPECT_EQ(mesh["points"], kept);
  EXPECT_EQ(mesh["simplices"], stats["result"]["simplices"]);
  EXPECT_EQ(run("delray verify m.ply --points m.ply --canonical", folder.path()).exit_code, 0);
  folder.write("flat.xyz", "0 0\n1 0\n0 1\n");
  for (const std::string arguments :
       {"p.xyz --max-error 1 --dim 3", "p.xyz --max-error 1 --seed 2", "flat.xyz --max-error 1"}) {
    const Ran refused = run("delray triangulate " + arguments + " -o n.ply", folder.path());
    EXPECT_EQ(refused.exit_code, 2) << arguments << refused.err;
  }
  EXPECT_EQ(folder.files().size(), 3U);
  const Ran rounds =
      run("delray triangulate p.xyz -o m.ply --max-error 0.5 --threads 2 --stats -", folder.path());
  ASSERT_EQ(rounds.exit_code, 0) << rounds.err;
  const json by_rounds = json::parse(rounds.out);
  EXPECT_LE(by_rounds["result"]["largest_error"], 0.5);
  EXPECT_EQ(by_rounds["options"]["threads"], 2);
  EXPECT_EQ(run("delray verify m.ply --points p.xyz --canonical", folder.path()).exit_code, 0);
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

TEST(VerifyCommand, FindsAWrongMeshInSpace) {
  const Folder folder;
  // Two tetrahedra on one face, or three around the edge between their tips.
  const std::string points = "0 0 0\n3 0 0\n0 3 0\n1 1 9\n1 1 -9\n";
  folder.write("p.xyz", points);
  const auto write = [&](const std::string& name, const std::string& nodes,
                         const std::string& elements) {
    std::string rows;
    int row = 0;
    for (std::size_t at = 0; at < nodes.size(); at = nodes.find('\n', at) + 1) {
      rows += std::to_string(row++) + " " + nodes.substr(at, nodes.find('\n', at) - at) + "\n";
    }
    folder.write(name + ".node", "5 3 0 0\n" + rows);
    folder.write(name + ".ele", elements);
  };
  write("good", points, "2 4 0\n0 0 1 2 3\n1 0 2 1 4\n");
  write("flipped", points, "3 4 0\n0 0 1 4 3\n1 1 2 4 3\n2 2 0 4 3\n");
  write("mirrored", points, "2 4 0\n0 0 1 2 3\n1 0 1 2 4\n");
  write("unused", points, "1 4 0\n0 0 1 2 3\n");
  write("beyond", points, "2 4 0\n0 0 1 2 3\n1 0 2 1 5\n");
  write("moved", "0 0 0\n3 0 0\n0 3 0\n1 1 9\n1 1 -8\n", "2 4 0\n0 0 1 2 3\n1 0 2 1 4\n");
  const auto verify = [&](const std::string& name) {
    return run("delray verify " + name + ".node --dim 3 --points p.xyz", folder.path());
  };
  const Ran good = verify("good");
  EXPECT_EQ(good.exit_code, 0) << good.err;
  EXPECT_NE(good.out.find("valid: yes\ndelaunay: yes\n"), std::string::npos) << good.out;
  const Ran flipped = verify("flipped");
  EXPECT_EQ(flipped.exit_code, 4);
  EXPECT_NE(flipped.err.find("circumsphere"), std::string::npos) << flipped.err;
  EXPECT_NE(flipped.out.find("valid: yes\ndelaunay: no\n"), std::string::npos) << flipped.out;
  for (const std::string name : {"mirrored", "unused"}) {
    const Ran ran = verify(name);
    EXPECT_EQ(ran.exit_code, 4) << name << ran.err;
    EXPECT_NE(ran.out.find("valid: no\n"), std::string::npos) << name << ran.out;
  }
  EXPECT_NE(verify("mirrored").err.find("simplex 1"), std::string::npos);
  EXPECT_EQ(verify("beyond").exit_code, 3);
  EXPECT_EQ(verify("moved").exit_code, 3);
  EXPECT_EQ(run("delray verify good.node --points p.xyz", folder.path()).exit_code, 2);
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

json result_of(const std::string& command, const Folder& folder) {
  const Ran ran = run(command, folder.path());
  EXPECT_EQ(ran.exit_code, 0) << command << ": " << ran.err;
  return ran.exit_code == 0 ? json::parse(ran.out) : json();
}

TEST(TriangulateCommand, RanksAndTilesGiveTheMeshOfOne) {
  const Folder folder;
  ASSERT_EQ(run("delray generate points cluster -n 3000 --dim 3 --seed 4 -o p.ply", folder.path())
                .exit_code,
            0);
  const std::string triangulate = "delray triangulate p.ply -o m.vtu --stats - ";
  for (const std::string& dim : {std::string("--dim 2 "), std::string("--dim 3 ")}) {
    const json alone = result_of(triangulate + dim, folder);
    for (const std::string& how : {std::string("--tiles 7"), std::string("--ranks 3 --threads 1"),
                                   std::string("--ranks 2 --tiles 5 --threads 2")}) {
      const json shared = result_of(triangulate + dim + how, folder);
      EXPECT_EQ(shared["result"], alone["result"]) << dim << how;
      EXPECT_EQ(shared["input"], alone["input"]) << dim << how;
      std::uint64_t points = 0;
      for (const json& tile : shared["tiles"]) points += tile["points"].get<std::uint64_t>();
      EXPECT_EQ(points, 3000U) << dim << how;
      EXPECT_EQ(
          run("delray verify m.vtu --points p.ply --canonical " + dim, folder.path()).exit_code, 0)
          << dim << how;
    }
    const json processes = result_of(mpirun(2) + triangulate + dim, folder);
    EXPECT_EQ(processes["result"], alone["result"]) << dim;
    EXPECT_EQ(processes["options"]["ranks"], 2);
    EXPECT_EQ(processes["tiles"].size(), 2U);
  }
}

TEST(TriangulateCommand, DistributedMethodsGiveTheMeshOfOne) {
  const Folder folder;
  ASSERT_EQ(run("delray generate points cluster -n 400 --dim 3 --seed 4 -o p.ply", folder.path())
                .exit_code,
            0);
  const std::string triangulate = "delray triangulate p.ply -o m.vtu --stats - ";
  for (const int dim : {2, 3}) {
    const std::string of_dim = "--dim " + std::to_string(dim) + " ";
    const json alone = result_of(triangulate + of_dim, folder);
    for (const std::string_view name : delaunay::distributed_methods_for(dim)) {
      const json shared = result_of(
          triangulate + of_dim + "--ranks 3 --threads 1 --distributed " + std::string(name),
          folder);
      EXPECT_EQ(shared["result"], alone["result"]) << name << ", " << dim << "D";
      EXPECT_EQ(shared["input"], alone["input"]) << name << ", " << dim << "D";
      EXPECT_EQ(shared["distributed"]["method"], name);
      EXPECT_EQ(shared["distributed"]["ranks"].size(), 3U);
      EXPECT_GT(shared["distributed"]["messages"], 0);
      EXPECT_GT(shared["distributed"]["shared_simplices"], 0) << name << ", " << dim << "D";
    }
  }
  // Few points: processes that share a core take turns with every message.
  ASSERT_EQ(run("delray generate points cluster -n 40 -o few.ply", folder.path()).exit_code, 0);
  const json processes = result_of(
      mpirun(2) + "delray triangulate few.ply --stats - --distributed administrators", folder);
  EXPECT_EQ(processes["distributed"]["ranks"].size(), 2U);
  for (const char* more :
       {"--distributed tile", "--dim 3 --distributed chen", "--distributed tiles --tiles 3",
        "--distributed administrators --method insertion"}) {
    EXPECT_EQ(
        run(std::string("delray triangulate p.ply -o m.ply ") + more, folder.path()).exit_code, 2)
        << more;
  }
}

TEST(TriangulateCommand, RefusesWhatTilesCannotDo) {
  const Folder folder;
  folder.write("p.xyz", "0 0 1\n1 0 2\n0 1 3\n");
  for (const char* more : {"--tiles 2 --makers -o m.vtu", "--ranks 2 --max-error 1 -o m.ply",
                           "--tiles 0 -o m.ply", "--timeout 5 -o m.ply"}) {
    EXPECT_EQ(run(std::string("delray triangulate p.xyz ") + more, folder.path()).exit_code, 2)
        << more;
  }
  // A line has no simplices, however many tiles it is cut into.
  folder.write("line.xyz", "0 0\n1 1\n2 2\n3 3\n4 4\n");
  const Ran line =
      run("delray triangulate line.xyz -o m.ply --ranks 3 --tiles 4 --stats -", folder.path());
  ASSERT_EQ(line.exit_code, 0) << line.err;
  EXPECT_EQ(json::parse(line.out)["result"]["simplices"], 0);
  EXPECT_NE(line.err.find("no simplices"), std::string::npos) << line.err;
  // What one rank finds wrong ends all.
  EXPECT_EQ(run(mpirun(2) + "delray triangulate none.xyz -o m.ply", folder.path()).exit_code, 3);
}

}  // namespace
}  // namespace delray::tests
