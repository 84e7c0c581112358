// delray triangulate for inputs that memory does not hold, by the built program.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/run_program.h"

namespace delray::tests {
namespace {

using nlohmann::json;

json statistics(const std::string& command, const Folder& folder) {
  const Ran ran = run(command + " --stats -", folder.path());
  EXPECT_EQ(ran.exit_code, 0) << command << ": " << ran.err;
  return ran.exit_code == 0 ? json::parse(ran.out) : json();
}

void generate(const Folder& folder, const std::string& what) {
  ASSERT_EQ(run("delray generate points " + what + " -o p.ply", folder.path()).exit_code, 0);
  std::filesystem::create_directory(folder / "scratch");
}

// Starts a run and sends it a signal once it has finished some tiles; its exit code goes to a file.
Ran interrupt(const Folder& folder, const std::string& command, const std::string& signal) {
  return run(
      "true | delray " + command +
          " --stats run.json 2> run.err & pid=$!; "
          "for i in $(seq 2000); do [ -n \"$(find scratch -name journal -size +1 2> /dev/null)\" ] "
          "&& break; sleep 0.005; done; kill -" +
          signal + " $pid; wait $pid",
      folder.path());
}

TEST(TriangulateInParts, KeepsWithinMemory) {
  const Folder folder;
  generate(folder, "uniform -n 1200000 --dim 2");
  const json alone = statistics("delray triangulate p.ply", folder);
  const Ran ran = run("delray triangulate p.ply --memory 110MiB --scratch scratch --stats s.json",
                      folder.path());
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const json parts = json::parse(folder.read("s.json"));
  EXPECT_EQ(parts["result"], alone["result"]);
  EXPECT_EQ(parts["input"], alone["input"]);
  EXPECT_GT(parts["tiles"].size(), 1U);
  EXPECT_GE(parts["scratch"].get<std::uint64_t>(), 1200000U * 24U);
  EXPECT_LE(parts["memory"]["peak_rss"].get<std::uint64_t>(), std::uint64_t{110} << 20);
  EXPECT_NE(ran.err.find("1200000 points, "), std::string::npos) << ran.err;
  EXPECT_TRUE(std::filesystem::is_empty(folder / "scratch"));

  // By itself where memory would not do, which it says.
  const Ran chosen = run("delray triangulate p.ply --memory 110MiB --stats s.json", folder.path());
  ASSERT_EQ(chosen.exit_code, 0) << chosen.err;
  EXPECT_NE(chosen.err.find("triangulating in tiles"), std::string::npos) << chosen.err;
  EXPECT_EQ(json::parse(folder.read("s.json"))["result"], alone["result"]);
}

// What does with less memory does with more, whether in tiles or not.
TEST(TriangulateInParts, MoreMemoryRefusesNothing) {
  const Folder folder;
  for (const char* file : {"p.xyz", "p.ply"}) {
    ASSERT_EQ(run(std::string("delray generate points uniform -n 600000 --dim 2 -o ") + file,
                  folder.path())
                  .exit_code,
              0);
    json first;
    for (const int limit : {76, 88, 110}) {
      const json made =
          statistics(fmt::format("delray triangulate {} --memory {}MiB", file, limit), folder);
      if (made.is_null()) continue;
      EXPECT_LE(made["memory"]["peak_rss"].get<std::uint64_t>(), std::uint64_t(limit) << 20)
          << file << " " << limit;
      if (first.is_null()) first = made["result"];
      EXPECT_EQ(made["result"], first) << file << " " << limit;
    }
  }
}

TEST(TriangulateInParts, NamesAFileWithoutHeights) {
  const Folder folder;
  folder.write("flat.xyz", "0 0\n1 0\n0 1\n");
  for (const char* how : {"", " --tiles 2", " --ranks 2"}) {
    const Ran ran =
        run(std::string("delray triangulate flat.xyz --dim 3 --stats -") + how, folder.path());
    EXPECT_EQ(ran.exit_code, 2) << how << ran.err;
    EXPECT_NE(ran.err.find("--dim 3: flat.xyz has no z"), std::string::npos) << how << ran.err;
  }
}

TEST(TriangulateInParts, GoesOnAfterItWasKilled) {
  for (const std::string& signal : {std::string("KILL"), std::string("INT")}) {
    const Folder folder;
    generate(folder, "uniform -n 60000 --dim 3");
    const std::string command =
        "triangulate p.ply --dim 3 --tiles 40 --threads 1 --scratch scratch";
    const json alone = statistics("delray triangulate p.ply --dim 3", folder);
    const Ran stopped = interrupt(folder, command, signal);
    ASSERT_EQ(stopped.exit_code, signal == "KILL" ? 137 : 130) << folder.read("run.err");
    EXPECT_FALSE(std::filesystem::exists(folder / "run.json"));
    const json resumed = statistics("delray " + command + " --resume", folder);
    EXPECT_EQ(resumed["result"], alone["result"]);
    EXPECT_GE(resumed["resumed"].get<int>(), 1);
    EXPECT_LT(resumed["resumed"].get<int>(), 40);
    EXPECT_TRUE(std::filesystem::is_empty(folder / "scratch"));
    // Nothing is left to go on from.
    const Ran again = run("delray " + command + " --resume --stats -", folder.path());
    EXPECT_NE(again.err.find("nothing to resume"), std::string::npos) << again.err;
    EXPECT_EQ(json::parse(again.out)["result"], alone["result"]);
  }
}

TEST(TriangulateInParts, NamesWhatIsBroken) {
  const Folder folder;
  generate(folder, "uniform -n 60000 --dim 3");
  const std::string command = "triangulate p.ply --dim 3 --tiles 40 --threads 1 --scratch scratch";
  ASSERT_EQ(interrupt(folder, command, "KILL").exit_code, 137);
  const Ran damaged =
      run("for file in $(find scratch -name 'tile-*'); do printf x | dd of=$file bs=1 seek=3000 "
          "conv=notrunc 2> /dev/null; done; true | delray " +
              command + " --resume --stats -",
          folder.path());
  EXPECT_EQ(damaged.exit_code, 1);
  EXPECT_NE(damaged.err.find("/tile-"), std::string::npos) << damaged.err;
  EXPECT_EQ(damaged.out, "");

  // A disk that takes no more.
  const Ran full =
      run("trap '' XFSZ; ulimit -f 20; true | delray " + command + " --stats -", folder.path());
  EXPECT_EQ(full.exit_code, 1);
  EXPECT_NE(full.err.find("/tile-"), std::string::npos) << full.err;
  EXPECT_TRUE(std::filesystem::is_empty(folder / "scratch"));

  std::filesystem::resize_file(folder / "p.ply", 700000);
  const Ran cut = run("delray " + command + " --stats -", folder.path());
  EXPECT_EQ(cut.exit_code, 3);
  EXPECT_NE(cut.err.find("p.ply"), std::string::npos) << cut.err;
}

TEST(TriangulateInParts, RanksShareThePartsOfTheInput) {
  const Folder folder;
  generate(folder, "cluster -n 20000 --dim 3 --seed 2");
  for (const std::string& dim : {std::string(" --dim 2"), std::string(" --dim 3")}) {
    const json alone = statistics("delray triangulate p.ply" + dim, folder);
    for (const std::string& how :
         {std::string("delray triangulate p.ply --ranks 3 --tiles 10 --threads 1"),
          mpirun(2) + "delray triangulate p.ply --threads 1",
          mpirun(3) + "delray triangulate p.ply --tiles 20 --threads 2 --scratch scratch"}) {
      EXPECT_EQ(statistics(how + dim, folder)["result"], alone["result"]) << how << dim;
    }
  }
}

}  // namespace
}  // namespace delray::tests
