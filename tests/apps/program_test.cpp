// What holds for every subcommand: help, versions, exit codes, lists.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/run_program.h"

namespace delray::tests {
namespace {

std::ptrdiff_t count_of(const std::string& text, const std::string& part) {
  std::ptrdiff_t count = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(Program, TellsItsVersion) {
  const Folder folder;
  const Ran ran = run("delray --version", folder.path());
  EXPECT_EQ(ran.exit_code, 0);
  EXPECT_EQ(ran.out.rfind("delray 0.", 0), 0U) << ran.out;
}

// Most of the time of a start would go into OpenImageIO's 250 libraries.
TEST(Program, StartsWithoutWhatOnlyPictureFilesNeed) {
  const Folder folder;
  const Ran ran = run("LD_TRACE_LOADED_OBJECTS=1 " DELRAY_PROGRAM, folder.path());
  EXPECT_EQ(ran.exit_code, 0);
  EXPECT_NE(ran.out.find("libtbb"), std::string::npos) << ran.out;
  EXPECT_EQ(ran.out.find("libOpenImageIO"), std::string::npos) << ran.out;
}

TEST(Program, EverySubcommandHasHelpWithTwoExamples) {
  const Folder folder;
  for (const std::string name :
       {"info", "generate points", "generate scene", "triangulate", "verify", "render", "pack",
        "compose", "compare compose", "compare triangulate", "compare partition",
        "compare schedule", "replay", "generate outline", "similar"}) {
    const Ran ran = run("delray " + name + " --help", folder.path());
    EXPECT_EQ(ran.exit_code, 0) << name;
    const auto examples = ran.out.find("Examples:");
    ASSERT_NE(examples, std::string::npos) << name;
    EXPECT_GE(count_of(ran.out.substr(examples), "  delray "), 2) << name;
  }
}

TEST(Program, WrongUsageIsTwo) {
  const Folder folder;
  folder.write("p.xyz", "0 0\n1 0\n0 1\n");
  for (const std::string arguments : {"",
                                      "nonsense",
                                      "render",
                                      "render gen:spheres",
                                      "render gen:spheres -o a.bmpx",
                                      "render gen:nothing -o a.png",
                                      "render gen:spheres:x -o a.png",
                                      "render gen:spheres -o a.png --size 10",
                                      "render gen:spheres -o a.png --size 0x10",
                                      "render gen:spheres -o a.png --camera 1,2,3",
                                      "render gen:spheres -o a.png --view nowhere",
                                      "render gen:spheres -o a.png --strategy sort-never",
                                      "render gen:spheres -o a.png --compose nothing",
                                      "render gen:spheres -o a.png --color-by x",
                                      "render gen:spheres -o a.png --background '#12345'",
                                      "render gen:spheres -o a.png --ranks 0",
                                      "render gen:spheres -o a.png --turntable 0",
                                      "render gen:spheres -o a.png --turntable 3 --frames 2",
                                      "render gen:spheres -o a.png --camera-path p.xyz --view top",
                                      "render gen:spheres -o a.png --engine raytrace --block -1",
                                      "render gen:spheres -o a.png --engine raytrace --schedule x",
                                      "triangulate",
                                      "triangulate p.xyz",
                                      "triangulate p.xyz -o m.xyz3",
                                      "triangulate p.xyz -o m.ply --method never",
                                      "triangulate p.xyz -o m.ply --dim 4",
                                      "triangulate p.xyz -o m.ply --duplicates all",
                                      "triangulate p.xyz -o m.ply --order never",
                                      "verify p.xyz",
                                      "generate points",
                                      "generate points nothing -o a.ply",
                                      "generate points uniform -o a.unknown",
                                      "generate points uniform -n 0 -o a.ply",
                                      "generate scene terrain -o a.png"}) {
    const Ran ran = run("delray " + arguments, folder.path());
    EXPECT_EQ(ran.exit_code, 2) << arguments << "\n" << ran.err;
    EXPECT_TRUE(ran.err.starts_with("error: ")) << arguments << "\n" << ran.err;
    ASSERT_EQ(folder.files(), std::vector<std::string>{"p.xyz"}) << arguments;
  }
}

TEST(Program, RefusesOptionsWithoutEffect) {
  const Folder folder;
  folder.write("p.xyz", "0 0 0\n1 0 0\n0 1 2\n");
  for (const std::string arguments :
       {"gen:cornell --engine raster --spp 4", "gen:cornell --engine raster --depth 3",
        "gen:cornell --engine raytrace --strategy sort-last",
        "gen:cornell --engine raytrace --compose binary-swap",
        "gen:cornell --engine raytrace --keep 2", "gen:cornell --engine raytrace --deal random",
        "gen:cornell --engine raytrace --data ray --cache 3",
        "gen:cornell --engine raytrace --schedule demand --partition mahd",
        "gen:cornell --strategy sort-last --partition mahd",
        "gen:cornell --strategy sort-first --compose binary-swap", "gen:cornell --terrain-rgb",
        "gen:cornell --duplicates min", "gen:cornell --exaggeration 2", "p.xyz --cell-size 3",
        "gen:cornell --frames-at-once 2", "gen:cornell --color-by rgb",
        "p.xyz --color-by intensity", "gen:cornell --view top --camera 0,0,5,0,0,0,0,1,0,40"}) {
    const Ran ran = run("delray render " + arguments + " -o a.png --size 32x32", folder.path());
    EXPECT_EQ(ran.exit_code, 2) << arguments << "\n" << ran.err;
    EXPECT_TRUE(ran.err.starts_with("error: ")) << arguments << "\n" << ran.err;
    EXPECT_EQ(folder.files().size(), 1U) << arguments;
  }
}

TEST(Program, RefusesWhatIsNoNumber) {
  const Folder folder;
  for (const std::string option :
       {"--time", "--noise", "--preview-every", "--exposure", "--aperture", "--aperture 1 --focus",
        "--integrator ao --reach", "--data object --cache",
        "--schedule static --partition mahd --keep", "--checkpoint a --checkpoint-every"}) {
    for (const std::string value : {"nan", "inf", "-31"}) {
      const Ran ran = run("delray render gen:cornell -o a.png --size 32x32 --engine raytrace " +
                              option + " " + value,
                          folder.path());
      EXPECT_EQ(ran.exit_code, 2) << option << " " << value << "\n" << ran.err;
      EXPECT_TRUE(folder.files().empty()) << option << " " << value;
    }
  }
}

TEST(Program, EndsWhenToldToUnlessThereIsSomethingToKeep) {
  const Folder folder;
  const Ran ran =
      run("delray generate scene terrain -n 20000000 -o t.glb & p=$!; sleep 0.1; "
          "kill -TERM $p; wait $p",
          folder.path());
  EXPECT_EQ(ran.exit_code, 128 + 15) << ran.err;
}

TEST(Program, ListsAreNameTabDescription) {
  const Folder folder;
  for (const std::string command : {"render --list", "compose --list", "triangulate --list",
                                    "generate points --list", "generate scene --list"}) {
    const Ran ran = run("delray " + command, folder.path());
    EXPECT_EQ(ran.exit_code, 0) << command;
    EXPECT_GE(count_of(ran.out, "\n"), 2) << command;
    EXPECT_EQ(count_of(ran.out, "\n"), count_of(ran.out, "\t")) << command << "\n" << ran.out;
  }
}

TEST(Program, SaysNothingInColourToAFileAndNothingAtAllWhenQuiet) {
  const Folder folder;
  const Ran loud = run("NO_COLOR=1 delray render gen:cornell -o a.png --size 16x16", folder.path());
  EXPECT_EQ(loud.exit_code, 0);
  EXPECT_EQ(loud.err.find('\x1b'), std::string::npos);
  EXPECT_NE(loud.err.find("a.png"), std::string::npos);
  EXPECT_TRUE(loud.out.empty()) << loud.out;
  const Ran quiet = run("delray render gen:cornell -o a.png --size 16x16 -q", folder.path());
  EXPECT_EQ(quiet.exit_code, 0);
  EXPECT_EQ(quiet.err + quiet.out, "");
}

TEST(Program, FullDiskIsOneAndLeavesNothing) {
  const Folder folder;
  EXPECT_EQ(run("delray generate points uniform -n 10000 -o - >/dev/full", folder.path()).exit_code,
            1);
  const Ran ran = run("delray render gen:cornell -o missing/a.png --size 16x16", folder.path());
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_NE(ran.err.find("missing/a.png"), std::string::npos) << ran.err;
  EXPECT_TRUE(folder.files().empty());
}

TEST(Program, InterruptEndsWith130AndLeavesNothing) {
  const Folder folder;
  // Minutes of work, interrupted once the program catches SIGINT: until then it ignores it, as what
  // a shell runs in the background does.
  const Ran ran =
      run("delray render gen:terrain:100000 -o a.png --engine raytrace --spp 4096 & "
          "pid=$!; until grep -q '^SigCgt:.*[2367abef]$' /proc/$pid/status; do sleep 0.2; done; "
          "sleep 0.5; kill -INT $pid; wait $pid",
          folder.path());
  EXPECT_EQ(ran.exit_code, 130) << ran.err;
  EXPECT_TRUE(folder.files().empty());
}

}  // namespace
}  // namespace delray::tests
