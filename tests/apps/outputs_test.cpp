// Where outputs may go: not over inputs or each other, into pipes and devices, never half.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>

#include "tests/support/device.h"
#include "tests/support/run_program.h"

namespace delray::tests {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
const std::string kPicture = "delray render gen:spheres:300 --size 64x48 ";

void expect_refused(const std::string& command, const Folder& folder) {
  const std::vector<std::string> before = folder.files();
  const Ran ran = run(command, folder.path());
  EXPECT_EQ(ran.exit_code, 2) << command << "\n" << ran.err;
  EXPECT_EQ(folder.files(), before) << command;
}

TEST(Outputs, DoNotOverwriteTheirInput) {
  const Folder folder;
  folder.write("a.obj", kTriangle);
  ASSERT_EQ(run("delray generate points uniform -n 100 -o p.ply", folder.path()).exit_code, 0);
  ASSERT_EQ(run("delray generate points uniform -n 100 -o q.node", folder.path()).exit_code, 0);
  ASSERT_EQ(run(kPicture + "-o a.exr", folder.path()).exit_code, 0);
  ASSERT_EQ(run(kPicture + "-o a-0001.png", folder.path()).exit_code, 0);
  fs::create_symlink("p.ply", folder / "link.ply");
  fs::create_hard_link(folder / "p.ply", folder / "hard.ply");
  const std::string content = folder.read("p.ply");
  for (const std::string command :
       {"delray triangulate p.ply -o p.ply", "delray triangulate p.ply -o ./p.ply",
        "delray triangulate p.ply -o link.ply", "delray triangulate link.ply -o p.ply",
        "delray triangulate p.ply -o hard.ply", "delray triangulate p.ply --stats p.ply",
        "delray triangulate - -o p.ply < p.ply", "delray triangulate q.node -o q.ele",
        "delray verify p.ply --points p.ply --stats p.ply", "delray info a.obj --stats a.obj",
        "delray render a.obj -o b.png --stats a.obj",
        "delray render p.ply -o b.png --engine raytrace --checkpoint p.ply",
        "delray render a-0001.png -o a-0001.png", "delray render a-0001.png -o a.png --turntable 2",
        "delray compose a.exr -o a.exr", "delray compose a.exr -o b.exr --stats a.exr",
        "delray compare compose a.obj --quick --stats a.obj",
        "delray compare triangulate p.ply --quick --stats p.ply"}) {
    expect_refused(command, folder);
  }
  EXPECT_EQ(folder.read("p.ply"), content);
  EXPECT_EQ(folder.read("a.obj"), kTriangle);
}

TEST(Outputs, DoNotOverwriteFilesThatTheSceneNames) {
  const Folder folder;
  fs::create_directory(folder / "s");
  ASSERT_EQ(run(kPicture + "-o s/t.png && cp s/t.png s/t-0001.png && cp s/t.png outside.png && cp "
                           "s/t.png s/unused.png",
                folder.path())
                .exit_code,
            0);
  folder.write("s/a.mtl",
               "newmtl m\nmap_Kd t.png\nmap_Ns -s 1 1 unused.png\nnewmtl n\nmap_Kd t-0001.png\n"
               "newmtl o\nmap_Kd ../outside.png\n");
  folder.write("s/a.obj", std::string("mtllib a.mtl\nusemtl m\n") + kTriangle);
  folder.write("s/a.gltf", R"({"asset":{"version":"2.0"},"images":[{"uri":"t%2Epng"}],
"buffers":[{"uri":"a.bin","byteLength":36}],"bufferViews":[{"buffer":0,"byteLength":36}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"nodes":[{"mesh":0}]})");
  std::string positions(36, '\0');
  positions[14] = positions[30] = '\x80', positions[15] = positions[31] = '\x3f';
  folder.write("s/a.bin", positions);
  fs::create_symlink("t.png", folder / "s/link.png");
  const auto content = [&] {
    return folder.read("s/t.png") + folder.read("s/a.mtl") + folder.read("s/a.bin") +
           folder.read("outside.png") + folder.read("s/unused.png");
  };
  const std::string before = content(), render = "delray render s/a.obj --size 64x48 ";
  for (const std::string& command :
       {render + "-o s/t.png", render + "-o s/link.png", render + "-o b.png --stats s/a.mtl",
        render + "-o s/t.png --ranks 2", mpirun(2) + render + "-o s/t.png",
        render + "-o s/t.png --turntable 2", render + "-o outside.png", render + "-o s/unused.png",
        render + "-o b.png --engine raytrace --checkpoint s/t.png",
        std::string("delray render s/a.gltf --size 64x48 -o s/t.png"),
        std::string("delray info s/a.gltf --stats s/a.bin"),
        std::string("delray info s/a.obj --stats s/a.mtl"),
        std::string("delray compare partition s/a.obj --quick --stats s/t.png")}) {
    expect_refused(command, folder);
  }
  EXPECT_EQ(content(), before);
  for (const std::string scene : {"s/a.obj", "s/a.gltf"}) {
    EXPECT_EQ(run("delray render " + scene + " --size 64x48 -o s/b.png", folder.path()).exit_code,
              0);
  }
}

TEST(Outputs, DoNotOverwriteEachOther) {
  const Folder folder;
  folder.write("p.xyz", "0 0 0\n1 0 0\n0 1 0\n");
  fs::create_symlink("b.png", folder / "link.png");
  for (const std::string& command :
       {kPicture + "-o a.png --stats a.png", kPicture + "-o b.png --stats link.png",
        kPicture + "-o a.png --stats a-0001.png --turntable 2",
        kPicture + "-o a.png --engine raytrace --checkpoint ./a.png",
        std::string("delray triangulate p.xyz -o m.ply --stats m.ply"),
        std::string("delray triangulate p.xyz -o m.node --stats m.ele"),
        std::string("delray triangulate p.xyz -o - --stats -"),
        std::string("delray triangulate p.xyz -o m.ply --stats - > m.ply")}) {
    const Ran ran = run(command, folder.path());
    EXPECT_EQ(ran.exit_code, 2) << command << "\n" << ran.err;
  }
}

// A device of its own: a program that replaced the machine's would do harm.
TEST(Outputs, AreWrittenIntoDevices) {
  const Folder folder;
  if (!make_device(folder / "null.png", kNull)) {
    GTEST_SKIP() << "only root can make devices, and not everywhere";
  }
  EXPECT_EQ(run(kPicture + "-o null.png --stats null.png", folder.path()).exit_code, 0);
  EXPECT_TRUE(fs::is_character_file(folder / "null.png"));
  EXPECT_EQ(folder.files(), std::vector<std::string>{"null.png"});
}

TEST(Outputs, AreWrittenIntoPipesDevicesAndWhatLinksLeadTo) {
  const Folder folder;
  fs::create_symlink("/proc/self/fd/1", folder / "out");  // as /dev/stdout
  for (const std::string suffix : {"png", "jpg", "exr", "tif"}) {
    const std::string pipe = "p." + suffix, got = "got." + suffix;
    const Ran ran = run("mkfifo " + pipe + "; cat " + pipe + " > " + got + " & " + kPicture +
                            "-o " + pipe + " --stats out; code=$?; " +
                            // Should nobody have written into it, cat would wait for ever.
                            "test -p " + pipe + " && : <> " + pipe + "; wait; exit $code",
                        folder.path());
    EXPECT_EQ(ran.exit_code, 0) << ran.err;
    EXPECT_NE(ran.out.find("delray.render/1"), std::string::npos);
    EXPECT_TRUE(fs::is_fifo(folder / pipe)) << suffix;
    EXPECT_TRUE(fs::is_symlink(folder / "out")) << suffix;
    EXPECT_EQ(run("delray info " + got, folder.path()).exit_code, 0) << suffix;
  }
  fs::create_directory(folder / "results");
  fs::create_symlink("results/a.png", folder / "a.png");
  EXPECT_EQ(run(kPicture + "-o a.png", folder.path()).exit_code, 0);
  EXPECT_TRUE(fs::is_symlink(folder / "a.png"));
  EXPECT_EQ(run("delray info results/a.png", folder.path()).exit_code, 0);
}

TEST(Outputs, PicturesGoToStandardOutputAsPng) {
  const Folder folder;
  for (const std::string& command :
       {kPicture, kPicture + "--engine raytrace ", std::string("delray compose p.exr ")}) {
    ASSERT_EQ(run(kPicture + "-o p.exr", folder.path()).exit_code, 0);
    const Ran ran =
        run(command + "-o - --stats s.json > a.png && " + command + "-o b.png && cmp a.png b.png",
            folder.path());
    EXPECT_EQ(ran.exit_code, 0) << command << "\n" << ran.err;
  }
  for (const std::string options :
       {"-o - --stats -", "-o - --stats /dev/fd/1", "-o - --turntable 2",
        "-o - --engine raytrace --preview-every 1 --spp 64"}) {
    EXPECT_EQ(run(kPicture + options + " > got", folder.path()).exit_code, 2) << options;
    EXPECT_EQ(folder.read("got"), "") << options;
  }
  EXPECT_EQ(run(kPicture + "-o - > /dev/full", folder.path()).exit_code, 1);
}

TEST(Outputs, PicturesDoNotGoToTerminals) {
  if (std::system("command -v script > /dev/null") != 0) {
    GTEST_SKIP() << "script (bsdutils) is not installed: it makes terminals";
  }
  const Folder folder;
  for (const std::string& command : {kPicture, std::string("delray compose p.exr ")}) {
    ASSERT_EQ(run(kPicture + "-o p.exr", folder.path()).exit_code, 0);
    const Ran ran = run("script -qec \" " + command + "-o -\" log", folder.path());
    EXPECT_EQ(ran.exit_code, 2) << command << ran.out << ran.err;
  }
}

TEST(Outputs, KeepPermissions) {
  const Folder folder;
  folder.write("a.png", "old");
  fs::permissions(folder / "a.png", fs::perms(0640));
  EXPECT_EQ(run("umask 0; delray generate points uniform -o p.ply; " + kPicture + "-o a.png",
                folder.path())
                .exit_code,
            0);
  EXPECT_EQ(fs::status(folder / "a.png").permissions(), fs::perms(0640));
  EXPECT_EQ(fs::status(folder / "p.ply").permissions(), fs::perms(0666));
}

TEST(Outputs, OnAFullDiskAreNotThereAndSaidToBe) {
  const Folder folder;
  const std::string limit = "trap '' XFSZ; ulimit -f 2; ";  // half kibibytes
  for (const std::string name : {"a.jpg", "a.png", "a.exr", "a.tif"}) {
    for (const std::string& before : {limit, std::string("ulimit -f 2; ")}) {
      const Ran ran = run(before + kPicture + "-o " + name, folder.path());
      EXPECT_EQ(ran.exit_code, 1) << name << "\n" << ran.err;
      EXPECT_NE(ran.err.find(name), std::string::npos) << ran.err;
    }
  }
  const Ran ran =
      run("ulimit -f 2; delray generate points uniform -n 10000 -o a.ply", folder.path());
  EXPECT_EQ(ran.exit_code, 1) << ran.err;
  EXPECT_TRUE(folder.files().empty());
}

TEST(Outputs, OnAFullStandardOutputFail) {
  const Folder folder;
  folder.write("a.obj", kTriangle);
  folder.write("p.xyz", "0 0 0\n1 0 0\n0 1 0\n");
  for (const std::string command :
       {"delray --version", "delray --help", "delray render --list", "delray info a.obj",
        "delray info a.obj --stats -", "delray triangulate p.xyz -o -", "delray manual",
        "delray triangulate p.xyz --stats -", "delray generate points uniform -o -"}) {
    for (const std::string where : {" > /dev/full", " >&-"}) {
      const Ran ran = run(command + where, folder.path());
      EXPECT_EQ(ran.exit_code, 1) << command << where;
      EXPECT_NE(ran.err.find("error: "), std::string::npos) << command << where;
    }
  }
}

TEST(Outputs, DoNotGoWhereAClosedStreamWas) {
  const Folder folder;
  EXPECT_EQ(run(kPicture + "-q -o a.png && " + kPicture + "-v -o b.png >&- 2>&-", folder.path())
                .exit_code,
            0);
  EXPECT_EQ(folder.read("a.png").size(), folder.read("b.png").size());
}

TEST(Outputs, AreNotWrittenThroughALinkThatSomebodyElsePlanted) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root can make links of somebody else";
  const Folder folder;
  folder.write("victim.png", "old");
  fs::create_directory(folder / "open");
  fs::permissions(folder / "open", fs::perms(01777));
  fs::create_symlink("../victim.png", folder / "open/a.png");
  ASSERT_EQ(::lchown((folder / "open/a.png").c_str(), 65534, 65534), 0);
  const Ran ran = run(kPicture + "-o open/a.png", folder.path());
  EXPECT_EQ(ran.exit_code, 1) << ran.err;
  EXPECT_EQ(folder.read("victim.png"), "old");
}

}  // namespace
}  // namespace delray::tests
