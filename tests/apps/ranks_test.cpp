// Processes of mpirun that are not at the same work, ranks that wait in vain, and memory that is
// not there: all end, with the exit code that says why.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/support/run_program.h"

namespace delray::tests {
namespace {

const std::string kCornell = "delray render gen:cornell -o a.png --size 32x24 ";
const std::string kAnother = ": -n 2 ";  // two further processes

void expect_refused(const std::string& command, const Folder& folder, const std::string& why) {
  const Ran ran = run(std::string(DELRAY_LIMIT " 60 ") + command, folder.path());
  EXPECT_EQ(ran.exit_code, 2) << command << ran.err;
  EXPECT_NE(ran.err.find(why), std::string::npos) << command << ran.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "a.png")) << command;
}

std::string processes(int count) { return "env " + mpirun(count); }

TEST(Ranks, WithOtherOptionsAreToldFromEachOther) {
  const Folder folder;
  expect_refused(processes(1) + kCornell + kAnother + kCornell + "--engine raytrace", folder,
                 "error: ranks differ in --engine: rank 0 (");
  expect_refused(processes(1) + kCornell + "--seed 3 --engine raytrace --integrator path " +
                     kAnother + kCornell + "--engine raytrace --integrator path",
                 folder, "ranks differ in --seed: rank 0 (");
  expect_refused(processes(1) + kCornell + kAnother + "delray render gen:city -o a.png", folder,
                 "ranks differ in SCENE: rank 0 (");
  expect_refused(processes(1) + kCornell + kAnother + "delray compose a.exr -o a.png", folder,
                 "ranks differ in ");
}

TEST(Ranks, ThatCannotBeginTellTheOthers) {
  const Folder folder;
  expect_refused(processes(1) + kCornell + kAnother + kCornell + "--bogus", folder,
                 "ranks differ in errors: rank 0 (");
  expect_refused(processes(1) + kCornell + kAnother + kCornell + "--strategy nonsense", folder,
                 "nonsense");
}

TEST(Ranks, MayDifferInWhatIsTheirOwnAffair) {
  const Folder folder;
  const Ran ran =
      run(processes(1) + kCornell + kAnother + kCornell + "-q --threads 3", folder.path());
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
}

TEST(Ranks, OfAnotherBuildAreToldFromEachOther) {
  const Folder folder;
  std::ifstream in(DELRAY_PROGRAM, std::ios::binary);
  std::string program((std::istreambuf_iterator<char>(in)), {});
  using namespace std::string_literals;
  const std::size_t note = program.find("\x03\0\0\0GNU\0"s);  // NT_GNU_BUILD_ID
  if (note == std::string::npos) GTEST_SKIP() << "the linker has put no build id there";
  program[note + 10] = static_cast<char>(program[note + 10] ^ 1);
  folder.write("another", program);
  std::filesystem::permissions(folder / "another", std::filesystem::perms::owner_all);
  expect_refused(processes(1) + kCornell + kAnother + "./another" + kCornell.substr(6), folder,
                 "ranks differ in build: rank 0 (");
}

// The scene's own file, and a file that it names.
TEST(Ranks, WithOtherFilesAreToldFromEachOther) {
  const Folder folder;
  const std::string scene = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n";
  const std::string colour = "newmtl a\nKd 0.2 0.4 0.6\n";
  for (const char* name : {"here", "there", "elsewhere"}) {
    std::filesystem::create_directory(folder / name);
    const std::string place(name);
    folder.write(place + "/m.obj", place == "there" ? scene + "# more\n" : scene);
    folder.write(place + "/m.mtl", place == "elsewhere" ? "newmtl a\nKd 0.9 0.4 0.6\n" : colour);
  }
  const std::string base = "delray render m.obj -o ../a.png --size 32x24 ";
  const auto both = [&](const std::string& other) {
    return processes(1) + "--wdir here " + base + kAnother + "--wdir " + other + " " + base;
  };
  expect_refused(both("there"), folder, "ranks differ in m.obj: rank 0 (");
  expect_refused(both("elsewhere"), folder, "ranks differ in the scene's materials: rank 0 (");
  std::filesystem::remove(folder / "there/m.obj");
  expect_refused(both("there"), folder, "has nothing");
  EXPECT_EQ(run(both("here"), folder.path()).exit_code, 0);
}

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t found = 0;
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; ++at) ++found;
  return found;
}

TEST(Ranks, WarnOnce) {
  const Folder folder;
  folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2\n");
  const Ran ran = run(mpirun(3) + "delray render a.obj -o a.png --size 32x24", folder.path());
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_EQ(count(ran.err, "1 faces of fewer than 3 corners"), 1U) << ran.err;
}

TEST(Ranks, CommandsWithoutThemSaySo) {
  const Folder folder;
  folder.write("p.xyz", "0 0\n1 0\n0 1\n");
  const std::string note = "each of the 2 processes has done all of this";
  const Ran ran = run(mpirun(2) + "delray info p.xyz", folder.path());
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_EQ(count(ran.err, note), 1U) << ran.err;
  for (const std::string& alone : {std::string(), mpirun(1)}) {
    const Ran one = run(alone + "delray info p.xyz", folder.path());
    EXPECT_EQ(count(one.err, "processes"), 0U) << one.err;
  }
  // Each may have a file of its own: none fails in silence.
  const Ran lost =
      run(mpirun(2) + "sh -c '[ $OMPI_COMM_WORLD_RANK = 0 ] || exec \"$0\" info none' " +
              DELRAY_PROGRAM,
          folder.path());
  EXPECT_EQ(lost.exit_code, 3) << lost.err;
  EXPECT_NE(lost.err.find("none"), std::string::npos) << lost.err;
}

TEST(Ranks, TimeoutIsForRanksThatWaitForOthers) {
  const Folder folder;
  EXPECT_EQ(run(kCornell + "--timeout 5", folder.path()).exit_code, 2);
  EXPECT_EQ(run(kCornell + "--ranks 2 --timeout nan", folder.path()).exit_code, 2);
  EXPECT_EQ(run(kCornell + "--ranks 2 --timeout 100", folder.path()).exit_code, 0);
  EXPECT_EQ(run(mpirun(2) + kCornell + "--timeout 100", folder.path()).exit_code, 0);
}

TEST(Ranks, OutOfMemoryWhileRenderingIsNoLostRank) {
#if defined(DELRAY_ASAN) || defined(DELRAY_TSAN)
  GTEST_SKIP() << "the sanitizer takes address space without end";
#endif
  const Folder folder;
  for (const std::string options : {"--ranks 2 --threads 1", "--threads 2"}) {
    const Ran ran = run("ulimit -v 500000; " + std::string(DELRAY_PROGRAM) +
                            " render gen:spheres -o a.png --size 8000x8000 " + options,
                        folder.path());
    EXPECT_EQ(ran.exit_code, 1) << options << ran.err;
    EXPECT_NE(ran.err.find("out of memory"), std::string::npos) << options << ran.err;
  }
}

}  // namespace
}  // namespace delray::tests
