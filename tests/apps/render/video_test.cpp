// Animations as videos: with a script in place of ffmpeg, so that what it is told can be seen.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/support/run_program.h"

namespace delray::tests {
namespace {

namespace fs = std::filesystem;

const std::string kTurntable = "delray render gen:spheres:300 --size 33x21 --turntable 3 ";
const std::string kWithFake = "PATH=\"$PWD/bin:$PATH\" ";
const std::string kWithout = "PATH=/nonexistent ";

// Writes down its arguments and folder, and "video" into the file that its last argument names.
constexpr const char* kEncoder =
    "#!/bin/sh\n"
    "printf '%s\\n' \"$@\" > \"$LOG/arguments\"; ls > \"$LOG/frames\"\n"
    "for last; do :; done; printf video > \"$last\"\n";

void install(const Folder& folder, const std::string& script) {
  fs::create_directories(folder / "bin");
  fs::create_directories(folder / "log");
  folder.write("bin/ffmpeg", script);
  fs::permissions(folder / "bin/ffmpeg", fs::perms(0755));
}

Ran run_with_log(const std::string& command, const Folder& folder) {
  return run("export LOG=\"$PWD/log\"; " + command, folder.path());
}

TEST(Video, IsMadeOfAllFramesAndLeavesNothingElse) {
  const Folder folder;
  install(folder, kEncoder);
  for (const std::string name : {"a.mp4", "with spaces; 50%d 'quoted'.MP4"}) {
    folder.write("name", name);
    const Ran ran = run_with_log(kWithFake + kTurntable + "-o \"$(cat name)\" -q", folder);
    EXPECT_EQ(ran.exit_code, 0) << ran.err;
    EXPECT_EQ(folder.read(name), "video");
    EXPECT_EQ(folder.read("log/frames"), "frame-0000.png\nframe-0001.png\nframe-0002.png\n");
    EXPECT_EQ(folder.files().size(), 4U) << name;  // bin, log, name
    fs::remove(folder / name);
  }
  const std::string arguments = folder.read("log/arguments");
  // H.264 has no odd sides, and no name of the user's is taken for a pattern.
  EXPECT_NE(arguments.find("pad=ceil(iw/2)*2:ceil(ih/2)*2"), std::string::npos) << arguments;
  EXPECT_NE(arguments.find("-i\nframe-%04d.png\n"), std::string::npos) << arguments;
  EXPECT_EQ(arguments.find("gen:spheres"), std::string::npos) << arguments;
}

TEST(Video, IsMadeByTheFirstProcess) {
  const Folder folder;
  install(folder, kEncoder);
  const Ran ran = run_with_log(kWithFake + mpirun(2) + kTurntable + "-o a.mp4 --metadata", folder);
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_EQ(folder.files(), (std::vector<std::string>{"a.mp4", "bin", "log"}));
  EXPECT_NE(folder.read("log/arguments").find("gen:spheres"), std::string::npos);
}

TEST(Video, WithoutFfmpegTheFramesAreKeptAndTheCommandIsTold) {
  const Folder folder;
  install(folder, kEncoder);
  for (const std::string kept : {"a 1-frames", "a 1-frames-2"}) {
    const Ran ran = run_with_log(kWithout + kTurntable + "-o 'a 1.mp4'", folder);
    EXPECT_EQ(ran.exit_code, 1);
    EXPECT_FALSE(fs::exists(folder / "a 1.mp4"));
    EXPECT_TRUE(fs::exists(folder / kept / "frame-0002.png")) << kept;
    const auto command = ran.err.find("(cd ");
    ASSERT_NE(command, std::string::npos) << ran.err;
    const Ran made = run_with_log("export " + kWithFake + "; " + ran.err.substr(command), folder);
    EXPECT_EQ(made.exit_code, 0) << made.err;
    EXPECT_EQ(folder.read("a 1.mp4"), "video");
    fs::remove(folder / "a 1.mp4");
  }
}

TEST(Video, ThatCannotBeMadeLeavesTheFramesAndTheOldOne) {
  const Folder folder;
  install(folder, "#!/bin/sh\necho first >&2; echo 'no such codec' >&2; exit 3\n");
  folder.write("a.mp4", "old");
  const Ran ran = run_with_log(kWithFake + kTurntable + "-o a.mp4", folder);
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_NE(ran.err.find("no such codec"), std::string::npos) << ran.err;
  EXPECT_EQ(folder.read("a.mp4"), "old");
  EXPECT_TRUE(fs::exists(folder / "a-frames/frame-0000.png"));
  EXPECT_EQ(folder.files(), (std::vector<std::string>{"a-frames", "a.mp4", "bin", "log"}));
}

TEST(Video, InterruptedLeavesNothing) {
  const Folder folder;
  install(folder, "#!/bin/sh\n: > \"$LOG/begun\"; exec sleep 60\n");
  const Ran ran = run_with_log(kWithFake + kTurntable +
                                   "-o a.mp4 & pid=$!; until test -e log/begun; do sleep 0.1; "
                                   "done; kill -INT $pid; wait $pid",
                               folder);
  EXPECT_EQ(ran.exit_code, 130) << ran.err;
  EXPECT_EQ(folder.files(), (std::vector<std::string>{"bin", "log"}));
}

TEST(Video, IsRefusedWhereItMakesNoSense) {
  const Folder folder;
  folder.write("a.mp4", "old");
  for (const std::string& command :
       {std::string("delray render gen:spheres:300 -o a.mp4"),
        kTurntable + "-o a.mp4 --background transparent", kTurntable + "-o a.mp4 --stats a.mp4",
        std::string("delray render a.mp4 --turntable 2 -o a.mp4")}) {
    EXPECT_EQ(run(command, folder.path()).exit_code, 2) << command;
    EXPECT_EQ(folder.files(), std::vector<std::string>{"a.mp4"}) << command;
  }
  EXPECT_EQ(run(kTurntable + "-o missing/a.mp4", folder.path()).exit_code, 1);
  EXPECT_EQ(folder.read("a.mp4"), "old");
}

}  // namespace
}  // namespace delray::tests
