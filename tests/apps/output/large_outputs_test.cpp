// Outputs for triangulations of any size: folders of pieces, and rasters of heights.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/run_program.h"

namespace delray::tests {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

void make_points(const Folder& folder) {
  const Ran made = run("delray generate points cluster -n 3000 --dim 3 -o p.ply", folder.path());
  ASSERT_EQ(made.exit_code, 0) << made.err;
}

std::string result_hash(const Ran& ran) { return json::parse(ran.out)["result"]["hash"]; }

TEST(MeshFolders, AreWrittenReadAndVerified) {
  const Folder folder;
  make_points(folder);
  const std::string mesh = "delray triangulate p.ply -o m.vtu --stats - --dim ";
  for (const std::string how : {"2", "3", "2 --pieces ply"}) {
    const Ran made = run("delray triangulate p.ply -o m/ --stats - --dim " + how, folder.path());
    ASSERT_EQ(made.exit_code, 0) << made.err;
    EXPECT_EQ(result_hash(made), result_hash(run(mesh + how.substr(0, 1), folder.path())));
    const Ran info = run("delray info m --stats -", folder.path());
    EXPECT_EQ(json::parse(info.out)["hash"], result_hash(made)) << info.err;
    const Ran verified =
        run("delray verify m/ --points p.ply --canonical --stats - --dim " + how.substr(0, 1),
            folder.path());
    EXPECT_EQ(verified.exit_code, 0) << verified.err;
    EXPECT_EQ(result_hash(verified), result_hash(made));
    const Ran shown = run("delray render m/ -o a.png --size 64x48", folder.path());
    EXPECT_EQ(shown.exit_code, 0) << shown.err;
    EXPECT_EQ(fs::exists(folder / "m/mesh.pvtu"), how.size() == 1);
  }
}

// Tiles, ranks and processes write one folder; so does what memory does not hold.
TEST(MeshFolders, AreWrittenTileByTile) {
  const Folder folder;
  ASSERT_EQ(
      run("delray generate points cluster -n 60000 --dim 3 -o p.ply", folder.path()).exit_code, 0);
  const Ran whole = run("delray triangulate p.ply --stats -", folder.path());
  const std::string triangulate = "delray triangulate p.ply -o m/ --stats s.json ";
  for (const std::string& command : {triangulate + "--tiles 7", triangulate + "--ranks 3 --tiles 8",
                                     mpirun(3) + triangulate + "--tiles 8",
                                     triangulate + "--scratch . --tiles 12 --pieces ply"}) {
    SCOPED_TRACE(command);
    const Ran made = run(command, folder.path());
    ASSERT_EQ(made.exit_code, 0) << made.err;
    EXPECT_EQ(json::parse(folder.read("s.json"))["result"]["hash"], result_hash(whole));
    const Ran verified = run("delray verify m --points p.ply --canonical", folder.path());
    EXPECT_EQ(verified.exit_code, 0) << verified.err;
    EXPECT_GT(json::parse(folder.read("m/mesh.json"))["pieces"].size(), 1U);
    EXPECT_EQ(folder.files(), (std::vector<std::string>{"m", "p.ply", "s.json"}));
  }
}

// One file by tiles, ranks and processes: the same bytes each time, streamed, too.
TEST(MeshFiles, AreWrittenByAllRanksAtATime) {
  const Folder folder;
  ASSERT_EQ(
      run("delray generate points cluster -n 60000 --dim 2 -o p.ply", folder.path()).exit_code, 0);
  const Ran whole = run("delray triangulate p.ply --stats -", folder.path());
  for (const std::string name : {"m.ply", "m.vtu"}) {
    std::string expected;
    for (const std::string& command :
         {std::string("delray triangulate p.ply --ranks 3 --tiles 8"),
          mpirun(2) + "delray triangulate p.ply --tiles 6 --scratch ."}) {
      SCOPED_TRACE(command);
      const Ran made = run(command + " --stats s.json -o " + name, folder.path());
      ASSERT_EQ(made.exit_code, 0) << made.err;
      EXPECT_EQ(json::parse(folder.read("s.json"))["result"]["hash"], result_hash(whole));
      const std::string written = folder.read(name);
      if (expected.empty()) expected = written;
      EXPECT_TRUE(written == expected);
      EXPECT_EQ(folder.files(), (std::vector<std::string>{name, "p.ply", "s.json"}));
    }
    const Ran verified =
        run("delray verify " + name + " --points p.ply --canonical --stats -", folder.path());
    EXPECT_EQ(verified.exit_code, 0) << verified.err;
    EXPECT_EQ(result_hash(verified), result_hash(whole));
    if (name == "m.ply") {
      const Ran streamed =
          run(mpirun(2) + "delray triangulate p.ply -o - | cmp - m.ply", folder.path());
      EXPECT_EQ(streamed.exit_code, 0) << streamed.err << streamed.out;
    }
    fs::remove(folder / name);
  }
  // A disk that takes no more.
  const Ran full =
      run("trap '' XFSZ; ulimit -f 4000; true | delray triangulate p.ply --tiles 9 -o m.ply",
          folder.path());
  EXPECT_EQ(full.exit_code, 1) << full.err;
  EXPECT_NE(full.err.find("m.ply"), std::string::npos) << full.err;
  EXPECT_EQ(folder.files(), (std::vector<std::string>{"p.ply", "s.json"}));
}

TEST(MeshFiles, AreWrittenWithinMemory) {
  const Folder folder;
  ASSERT_EQ(
      run("delray generate points uniform -n 1000000 --dim 2 -o p.ply", folder.path()).exit_code,
      0);
  const std::string command = "delray triangulate p.ply --memory 95MiB";
  const Ran made = run(command + " -o m.ply --stats -", folder.path());
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const json statistics = json::parse(made.out);
  EXPECT_LE(statistics["memory"]["peak_rss"].get<std::uint64_t>(), std::uint64_t{95} << 20);
  EXPECT_GT(statistics["tiles"].size(), 1U);
  const Ran verified =
      run("delray verify m.ply --points p.ply --canonical --stats -", folder.path());
  EXPECT_EQ(verified.exit_code, 0) << verified.err;
  EXPECT_EQ(result_hash(verified), result_hash(made));
  const Ran streamed = run(command + " -o - | cmp - m.ply", folder.path());
  EXPECT_EQ(streamed.exit_code, 0) << streamed.err << streamed.out;
  // A hull and formats of text are made in memory, which does not do here.
  const Ran hull = run(command + " --dim 3 -o -", folder.path());
  EXPECT_EQ(hull.exit_code, 2);
  EXPECT_NE(hull.err.find("-o FOLDER/"), std::string::npos) << hull.err;
  EXPECT_EQ(hull.out, "");
  const Ran text = run(command + " -o m.obj", folder.path());
  EXPECT_EQ(text.exit_code, 1);
  EXPECT_NE(text.err.find("m.obj is made in memory: -o FOLDER/, .vtu and .ply are not"),
            std::string::npos)
      << text.err;
  EXPECT_EQ(folder.files(), (std::vector<std::string>{"m.ply", "p.ply"}));
}

TEST(MeshFolders, AreResumedAfterAKill) {
  const Folder folder;
  ASSERT_EQ(run("delray generate points uniform -n 400000 -o p.ply", folder.path()).exit_code, 0);
  const std::string command =
      "delray triangulate p.ply -o m/ --scratch . --tiles 40 --threads 1 --stats s.json ";
  // Killed when some tiles are there, if it is not faster than that.
  const Ran killed = run(std::string(DELRAY_PROGRAM) + command.substr(6) +
                             "& while kill -0 $! 2>&- && [ $(ls .m.delray-part 2>&- | grep -c "
                             "^tile) -lt 8 ]; do :; done; kill -9 $!; wait",
                         folder.path());
  const bool finished = fs::exists(folder / "m");
  const Ran resumed = run(command + "--resume", folder.path());
  ASSERT_EQ(resumed.exit_code, 0) << resumed.err << killed.err;
  const json statistics = json::parse(folder.read("s.json"));
  EXPECT_GE(statistics["resumed"], finished ? 0 : 6);
  const Ran whole = run("delray triangulate p.ply --stats -", folder.path());
  EXPECT_EQ(statistics["result"]["hash"], result_hash(whole));
  const Ran verified = run("delray verify m --points p.ply --canonical", folder.path());
  EXPECT_EQ(verified.exit_code, 0) << verified.err;
  EXPECT_EQ(folder.files(), (std::vector<std::string>{"m", "p.ply", "s.json"}));
}

TEST(MeshFolders, ThatAreWrongAreFound) {
  const Folder folder;
  make_points(folder);
  ASSERT_EQ(run("delray triangulate p.ply -o m/ --pieces ply", folder.path()).exit_code, 0);
  const std::string verify = "delray verify m --points p.ply";
  const std::string good = folder.read("m/mesh.json"), piece = folder.read("m/tile-000000.ply");
  // The last triangle has its last two corners exchanged.
  std::string bad = piece;
  std::rotate(bad.end() - 8, bad.end() - 4, bad.end());
  folder.write("m/tile-000000.ply", bad);
  const Ran turned = run(verify, folder.path());
  EXPECT_EQ(turned.exit_code, 4);
  EXPECT_NE(turned.err.find("tile-000000.ply: simplex "), std::string::npos) << turned.err;
  folder.write("m/tile-000000.ply", piece.substr(0, piece.size() - 1));
  EXPECT_EQ(run(verify, folder.path()).exit_code, 3);
  EXPECT_EQ(run("delray render m -o a.png", folder.path()).exit_code, 3);
  folder.write("m/tile-000000.ply", piece);
  const std::size_t at = good.find("\"hull_facets\": ") + 15;
  folder.write("m/mesh.json", std::string(good).replace(at, 1, "9"));
  const Ran lying = run(verify, folder.path());
  EXPECT_EQ(lying.exit_code, 4);
  EXPECT_NE(lying.err.find("as its index says"), std::string::npos) << lying.err;
  folder.write("m/mesh.json", std::string(good).replace(good.find("tile-"), 5, "../p-"));
  EXPECT_EQ(run("delray info m", folder.path()).exit_code, 3);
  folder.write("m/mesh.json", good);
  EXPECT_EQ(run(verify, folder.path()).exit_code, 0);
  EXPECT_EQ(run(verify + " --complete", folder.path()).exit_code, 2);
  EXPECT_EQ(run(verify + " --dim 3", folder.path()).exit_code, 2);
}

TEST(MeshFolders, ReplaceNothingElse) {
  const Folder folder;
  make_points(folder);
  fs::create_directory(folder / "full");
  folder.write("full/thesis.tex", "years of work");
  const Ran ran = run("delray triangulate p.ply -o full", folder.path());
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_NE(ran.err.find("thesis.tex"), std::string::npos) << ran.err;
  EXPECT_EQ(folder.read("full/thesis.tex"), "years of work");
  EXPECT_EQ(run("delray triangulate p.ply -o none/m/", folder.path()).exit_code, 1);
  EXPECT_EQ(folder.files(), (std::vector<std::string>{"full", "p.ply"}));
}

TEST(Rasters, AreTheSameForEveryWayToTriangulate) {
  const Folder folder;
  make_points(folder);
  const std::string command = "delray triangulate p.ply --cell-size 0.004 --stats - -o ";
  const Ran made = run(command + "a.tif", folder.path());
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const json raster = json::parse(made.out)["raster"];
  EXPECT_GT(raster["cells"], 10000);
  EXPECT_EQ(raster["interpolate"], "linear");
  const std::string expected = folder.read("a.tif");
  for (const std::string how :
       {"--threads 1", "--threads 3", "--method insertion", "--tiles 7", "--ranks 3 --tiles 5"}) {
    const Ran ran = run(command + "b.tif " + how, folder.path());
    ASSERT_EQ(ran.exit_code, 0) << ran.err;
    EXPECT_TRUE(folder.read("b.tif") == expected) << how;
  }
  const std::string smooth = command + "c.tif --interpolate natural-neighbour --threads ";
  ASSERT_EQ(run(smooth + "1", folder.path()).exit_code, 0);
  const std::string one = folder.read("c.tif");
  ASSERT_EQ(run(smooth + "2", folder.path()).exit_code, 0);
  EXPECT_TRUE(folder.read("c.tif") == one);
  EXPECT_FALSE(one == expected);
  for (const std::string how : {"--tiles 1", "--tiles 7", "--ranks 3 --tiles 5", "--ranks 3",
                                "--tiles 7 --memory 100MiB"}) {
    ASSERT_EQ(run(smooth + "1 " + how, folder.path()).exit_code, 0) << how;
    EXPECT_TRUE(folder.read("c.tif") == one) << how;
  }
  for (const std::string how : {"", " --tiles 7"}) {
    const Ran ran = run(mpirun(3) + smooth + "1" + how, folder.path());
    ASSERT_EQ(ran.exit_code, 0) << how << ran.err;
    EXPECT_TRUE(folder.read("c.tif") == one) << how;
  }
  // It is an elevation picture, and so points again.
  const Ran info = run("delray info a.tif --stats -", folder.path());
  EXPECT_EQ(json::parse(info.out)["no_data"], -9999);
  EXPECT_EQ(run("delray triangulate a.tif -o d.tif --cell-size 0.01", folder.path()).exit_code, 0);
}

TEST(Rasters, HaveHeightsInsideOfTheDataOnly) {
  const Folder folder;
  folder.write("p.xyz", "0 0 1\n4 0 1\n0 4 1\n");
  const Ran ran = run("delray triangulate p.xyz -o a.tif --cell-size 1 --stats -", folder.path());
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_EQ(json::parse(ran.out)["raster"]["cells"], 10);
  EXPECT_EQ(json::parse(ran.out)["raster"]["columns"], 4);
  folder.write("line.xyz", "0 0 1\n1 1 1\n2 2 1\n");
  const Ran line = run("delray triangulate line.xyz -o b.tif --cell-size 1", folder.path());
  EXPECT_EQ(line.exit_code, 0) << line.err;
  EXPECT_NE(line.err.find("without data"), std::string::npos) << line.err;
}

TEST(LargeOutputs, RefuseWhatDoesNotGoTogether) {
  const Folder folder;
  make_points(folder);
  folder.write("flat.xyz", "0 0\n1 0\n0 1\n");
  for (const std::string options :
       {"p.ply -o a.tif", "p.ply -o a.tif --cell-size 1 --dim 3", "p.ply -o a.ply --cell-size 1",
        "p.ply -o a.ply --interpolate linear", "p.ply -o a.tif --cell-size 1 --pieces vtu",
        "p.ply -o a.ply --pieces ply", "p.ply -o m/ --pieces obj",
        "p.ply -o m/ --pieces ply --dim 3", "p.ply -o m/ --max-error 1", "p.ply -o m/ --makers",
        "p.ply -o a.tif --cell-size 1e-30", "p.ply -o a.obj --scratch .",
        "p.ply -o a.ply --dim 3 --scratch .", "p.ply -o a.ply --resume",
        "p.ply -o - --dim 3 --scratch .", "p.ply -o a.tif --cell-size 1 --resume",
        "flat.xyz -o a.tif --cell-size 1"}) {
    const Ran ran = run("delray triangulate " + options, folder.path());
    EXPECT_EQ(ran.exit_code, 2) << options << ": " << ran.err;
  }
  EXPECT_EQ(folder.files(), (std::vector<std::string>{"flat.xyz", "p.ply"}));
}

// Where VTK's Python is installed, the .pvtu opens in it: python3-vtk9.
TEST(MeshFolders, OpenInVtk) {
  const Folder folder;
  if (run("/usr/bin/python3 -c 'import vtk'", folder.path()).exit_code != 0) {
    GTEST_SKIP() << "no VTK for Python";
  }
  make_points(folder);
  const Ran made = run("delray triangulate p.ply -o m/ --dim 3 --stats -", folder.path());
  ASSERT_EQ(made.exit_code, 0) << made.err;
  folder.write("open.py",
               "import vtk\n"
               "reader = vtk.vtkXMLPUnstructuredGridReader()\n"
               "reader.SetFileName('m/mesh.pvtu')\n"
               "reader.Update()\n"
               "grid = reader.GetOutput()\n"
               "rows = grid.GetPointData().GetGlobalIds()\n"
               "print(grid.GetNumberOfCells(), rows.GetName(), rows.GetRange()[1])\n");
  const Ran opened = run("/usr/bin/python3 open.py", folder.path());
  EXPECT_EQ(opened.out, std::to_string(json::parse(made.out)["result"]["simplices"].get<int>()) +
                            " row 2999.0\n")
      << opened.err;
}

}  // namespace
}  // namespace delray::tests
