// What cannot end well is refused before the work, and says what would do: by the built program.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/run_program.h"

namespace delray::tests {
namespace {

struct Refusal {
  std::string command;
  int exit_code;
  std::vector<std::string> told;  // in the message
};

void expect_refusals(const Folder& folder, const std::vector<Refusal>& refusals) {
  const std::vector<std::string> before = folder.files();
  for (const Refusal& refusal : refusals) {
    const Ran ran = run("delray " + refusal.command, folder.path());
    EXPECT_EQ(ran.exit_code, refusal.exit_code) << refusal.command << ": " << ran.err;
    for (const std::string& told : refusal.told) {
      EXPECT_NE(ran.err.find(told), std::string::npos) << refusal.command << ": " << ran.err;
    }
    EXPECT_EQ(folder.files(), before) << refusal.command;
  }
}

void generate_few_points(const Folder& folder) {
  ASSERT_EQ(run("delray generate points uniform -n 2000 --dim 3 -o p.ply", folder.path()).exit_code,
            0);
}

TEST(EarlyRefusals, OfOptionsThatMethodsMakeNoUseOf) {
  const Folder folder;
  generate_few_points(folder);
  std::vector<Refusal> refusals;
  for (const std::string how : {"-o m.ply", "--stats - --tiles 3", "--stats - --ranks 2",
                                "--stats - --distributed chen --ranks 2"}) {
    refusals.push_back({"triangulate p.ply --queue 9 " + how, 2, {"--queue"}});
    refusals.push_back({"triangulate p.ply --searching 1 " + how, 2, {"--searching"}});
    refusals.push_back({"triangulate p.ply --locks mutex " + how, 2, {"locks"}});
    refusals.push_back({"triangulate p.ply --unlock early " + how, 2, {"unlock"}});
    refusals.push_back({"triangulate p.ply --seed 9 " + how, 2, {"--seed"}});
  }
  const std::string batch = "triangulate p.ply --stats - --method batch ";
  refusals.push_back({batch + "--threads 3 --searching 3", 2, {"3 threads locate points"}});
  refusals.push_back({batch + "--threads 3 --searching 0", 2, {"--searching"}});
  refusals.push_back({batch + "--locks mutex", 2, {"no choice of locks"}});
  refusals.push_back({"triangulate p.ply --stats - --method pessimistic --locks striped",
                      2,
                      {"it has: mutex, atomic"}});
  expect_refusals(folder, refusals);
  for (const std::string options :
       {"--dim 3 --seed 9 --tiles 3", "--method batch --queue 9 --seed 9 --tiles 3",
        "--method batch --threads 3 --searching 2", "--method optimistic --locks striped",
        "--method burglary --unlock early --dim 3", "--method insertion --seed 9",
        "--distributed interface-workers --ranks 2 --seed 9"}) {
    const Ran ran = run("delray triangulate p.ply --stats - " + options, folder.path());
    EXPECT_EQ(ran.exit_code, 0) << options << ": " << ran.err;
  }
}

TEST(EarlyRefusals, OfNamesThatSayNothing) {
  const Folder folder;
  generate_few_points(folder);
  std::filesystem::create_directory(folder / "dtm.tif");
  ASSERT_EQ(run("delray triangulate p.ply -o m/", folder.path()).exit_code, 0);
  std::filesystem::create_directory(folder / "empty");
  expect_refusals(
      folder, {{"triangulate p.ply -o x", 2, {"-o x/", ".tif", ".ply"}},
               {"triangulate p.ply -o dtm.tif --cell-size 1", 1, {"dtm.tif", "directory"}},
               {"triangulate p.ply --stats - --tiles 2 --scratch none", 1, {"none", "--scratch"}},
               {"verify empty/ --points p.ply", 3, {"empty", "mesh.json", "-o FOLDER/"}},
               {"verify m/mesh.json --points p.ply", 3, {"name its folder, m"}},
               {"verify m/mesh.pvtu --points p.ply", 3, {"name its folder, m"}}});
  const Ran one = run("delray verify m --points p.ply", folder.path());
  EXPECT_NE(one.out.find(" in 1 piece,"), std::string::npos) << one.out;
}

TEST(EarlyRefusals, OfRastersThatNobodyHasRoomFor) {
  const Folder folder;
  generate_few_points(folder);
  folder.write("flat.xyz", "0 0\n1 0\n0 1\n");
  std::vector<Refusal> refusals;
  for (const std::string how : {"", " --tiles 3", " --ranks 2"}) {
    refusals.push_back(
        {"triangulate p.ply -o a.tif --cell-size 1e-8" + how, 2, {"cells", "1e+12"}});
    refusals.push_back({"triangulate p.ply -o a.tif --cell-size 1.1e-6" + how, 1, {"TiB", "free"}});
    refusals.push_back({"triangulate flat.xyz -o a.tif --cell-size 1" + how, 2, {"no z"}});
  }
  expect_refusals(folder, refusals);
}

TEST(EarlyRefusals, OfMeshFoldersThatMemoryDoesNotHold) {
  const Folder folder;
  ASSERT_EQ(run("delray generate points uniform -n 400000 --dim 2 -o p.ply && "
                "delray triangulate p.ply -o m/ --tiles 4",
                folder.path())
                .exit_code,
            0);
  const Ran ran = run("delray render m -o a.png --memory 100MiB", folder.path());
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_NE(ran.err.find("m: a picture of 799"), std::string::npos) << ran.err;
  EXPECT_NE(ran.err.find("may have 100 MiB"), std::string::npos) << ran.err;
  // Before anything was read: the program has some megabytes.
  EXPECT_NE(ran.err.find("takes 1"), std::string::npos) << ran.err;
}

TEST(EarlyRefusals, OfRanksWhoseSharesOfMemoryAreNothing) {
  const Folder folder;
  generate_few_points(folder);
  expect_refusals(folder, {{"triangulate p.ply --stats - --ranks 64 --memory 500MiB",
                            1,
                            {"--ranks", "64 ranks share the 500 MiB", "would do"}}});
}

TEST(EarlyRefusals, ManyThreadsAreNone) {
  const Folder folder;
  generate_few_points(folder);
  const Ran ran = run("delray triangulate p.ply -o m.ply --threads 4096", folder.path());
  EXPECT_EQ(ran.exit_code, 0);
  EXPECT_EQ(ran.err.find("TBB"), std::string::npos) << ran.err;
}

// Notes beside the points of a folder are told of, and no points.
TEST(FoldersOfPoints, LeaveOutNotes) {
  const Folder folder;
  std::filesystem::create_directory(folder / "survey");
  folder.write("survey/a.xyz", "0 0 1\n5 0 2\n0 5 3\n");
  folder.write("survey/b.txt", "# x y z\n9 9 4\n");
  folder.write("survey/c.json", "[[7, 1, 2]]");
  folder.write("survey/readme.txt", "Survey of May 2019\n12 strips, flown by night\n");
  folder.write("survey/years.txt", "2019 was wet\n");
  folder.write("survey/about.json", "{\"sensor\": \"none\"}");
  const std::string command = "delray triangulate survey --stats - ";
  const Ran ran = run(command, folder.path());
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_NE(ran.out.find("\"points\": 5"), std::string::npos) << ran.out;
  for (const std::string note : {"readme.txt", "years.txt", "about.json"}) {
    EXPECT_NE(ran.err.find(note + ": left out"), std::string::npos) << ran.err;
  }
  EXPECT_EQ(ran.err.find("b.txt"), std::string::npos) << ran.err;
  EXPECT_EQ(run("delray info survey survey/a.xyz", folder.path()).exit_code, 0);
  // Who names it means it.
  EXPECT_EQ(run("delray triangulate survey/readme.txt --stats -", folder.path()).exit_code, 3);
}

TEST(FoldersOfPoints, MayHaveMeshesWhereOnlyPointsCount) {
  const Folder folder;
  folder.write("a.xyz", "0 0 1\n5 0 2\n0 5 3\n");
  folder.write("b.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const Ran info = run("delray info a.xyz b.obj --stats -", folder.path());
  EXPECT_EQ(info.exit_code, 0) << info.err;
  EXPECT_NE(info.out.find("\"points\": 6"), std::string::npos) << info.out;
  EXPECT_EQ(run("delray triangulate a.xyz b.obj --stats -", folder.path()).exit_code, 0);
}

}  // namespace
}  // namespace delray::tests
