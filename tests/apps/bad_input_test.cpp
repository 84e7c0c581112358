// Broken files of every format, through the program: exit code 3, a message that names the file,
// nothing written, no crash.
#include <gtest/gtest.h>

#include <cstring>

#include "tests/support/run_program.h"

namespace delray::tests {
namespace {

struct BadFile {
  std::string name, content;
};

// A LAS header that promises `points` points of format 0.
std::string las_header(std::uint32_t points) {
  std::string header(227, '\0');
  header.replace(0, 4, "LASF");
  header[24] = 1;
  header[25] = 2;
  const auto put = [&](std::size_t at, auto value) {
    std::memcpy(header.data() + at, &value, sizeof value);
  };
  put(94, std::uint16_t{227});
  put(96, std::uint32_t{227});
  put(105, std::uint16_t{20});
  put(107, points);
  return header;
}

std::vector<BadFile> bad_point_files() {
  std::vector<BadFile> files = {
      {"nan.xyz", "0 0\n1 nan\n2 2\n"},
      {"infinite.csv", "x,y\n0,0\n1,inf\n"},
      {"garbage.xyz", "hello world\nthis is not a number\n"},
      {"short.csv", "0,0\n1\n"},
      {"cut.json", "[[0,0],[1,"},
      {"garbage.json", "{\"a\": 1}"},
      {"nan.json", "[[0,0],[1,NaN]]"},
      {"huge.node", "99999999999 2 0 0\n1 0 0\n"},
      {"cut.node", "4 2 0 0\n1 0 0\n2 1 0\n"},
      {"huge.las", las_header(4000000000U)},
      {"cut.las", las_header(10) + std::string(7 * 20 + 5, '\0')},
      {"headless.las", "LASF"},
      {"huge.ply",
       "ply\nformat binary_little_endian 1.0\nelement vertex 1000000000000\nproperty float x\n"
       "property float y\nproperty float z\nend_header\nabc"},
      {"nan.ply",
       "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty "
       "float z\nend_header\n0 0 0\n1 nan 2\n"},
      {"cut.ply", "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\n"},
      {"empty.obj", "# nothing\n"},
  };
  for (const char* suffix : {"xyz", "csv", "txt", "ply", "obj", "off", "las", "json", "node"}) {
    files.push_back({std::string("zero.") + suffix, ""});
    files.push_back(
        {std::string("binary.") + suffix, std::string("\0\xff\x80\x01garbage\xfe", 12)});
  }
  return files;
}

std::vector<BadFile> bad_scene_files() {
  const std::string ply_head =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
      "z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  std::vector<BadFile> files = {
      {"index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n"},
      {"nan.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n"},
      {"infinite.obj", "v 0 0 0\nv 1e999 0 0\nv 0 1 0\nf 1 2 3\n"},
      {"index.ply", ply_head + "0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n"},
      {"nan.ply", ply_head + "0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n"},
      {"cut.ply", ply_head + "0 0 0\n1 0"},
      {"huge.off", "OFF\n1000000000000 1000000000000 0\n0 0 0\n"},
      {"index.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 5\n"},
      {"huge.stl", std::string(80, 'x') + std::string("\xff\xff\xff\xff", 4) + "abc"},
      {"cut.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1"},
      {"length.glb", std::string("glTF\x02\0\0\0\xff\xff\xff\x7f", 12)},
      {"cut.glb", std::string("glTF\x02\0\0\0\x40\0\0\0\x20\0\0\0JSON{\"asset\"", 28)},
      {"index.gltf",
       R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":7}]})"},
      {"buffer.gltf",
       R"({"asset":{"version":"2.0"},"buffers":[{"uri":"missing.bin","byteLength":99}],)"
       R"("bufferViews":[{"buffer":0,"byteLength":36}],"accessors":[{"bufferView":0,)"
       R"("componentType":5126,"count":3,"type":"VEC3"}],"meshes":[{"primitives":[{"attributes":)"
       R"({"POSITION":0}}]}],"nodes":[{"mesh":0}],"scenes":[{"nodes":[0]}],"scene":0})"},
      {"count.gltf",
       R"({"asset":{"version":"2.0"},"buffers":[{"uri":"data:application/octet-stream;base64,AAAA",)"
       R"("byteLength":3}],"bufferViews":[{"buffer":0,"byteLength":3}],"accessors":[{"bufferView":0,)"
       R"("componentType":5126,"count":4000000000,"type":"VEC3"}],"meshes":[{"primitives":[)"
       R"({"attributes":{"POSITION":0}}]}],"nodes":[{"mesh":0}],"scenes":[{"nodes":[0]}]})"},
  };
  for (const char* suffix :
       {"obj", "ply", "off", "stl", "glb", "gltf", "png", "exr", "vtu", "xyz"}) {
    files.push_back({std::string("zero.") + suffix, ""});
    files.push_back(
        {std::string("binary.") + suffix, std::string("\0\xff\x80\x01garbage\xfe", 12)});
  }
  files.push_back(
      {"cut.png", std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\xff\xff\0\0\xff\xff", 24)});
  return files;
}

void expect_refused(const Folder& folder, const BadFile& file, const std::string& command) {
  folder.write(file.name, file.content);
  const Ran ran = run(command, folder.path());
  EXPECT_EQ(ran.exit_code, 3) << command << "\n" << ran.err;
  EXPECT_NE(ran.err.find(file.name), std::string::npos) << command << "\n" << ran.err;
  EXPECT_EQ(folder.files(), std::vector<std::string>{file.name}) << command;
  std::filesystem::remove(folder / file.name);
}

TEST(BadInput, PointFiles) {
  const Folder folder;
  for (const BadFile& file : bad_point_files()) {
    expect_refused(folder, file, "delray triangulate " + file.name + " -o m.out.ply");
  }
}

TEST(BadInput, SceneFiles) {
  const Folder folder;
  for (const BadFile& file : bad_scene_files()) {
    expect_refused(folder, file, "delray render " + file.name + " -o a.out.png --size 16x16");
  }
}

TEST(BadInput, CameraPaths) {
  const Folder folder;
  expect_refused(folder, {"path.txt", "1,2,3\n"},
                 "delray render gen:cornell -o a.out.png --size 16x16 --camera-path path.txt");
}

TEST(BadInput, MeshFilesOfVerify) {
  const Folder folder;
  folder.write("p.xyz", "0 0\n1 0\n0 1\n");
  for (const BadFile& file :
       std::vector<BadFile>{{"a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 9\n"},
                            {"b.off", "OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n"},
                            {"c.vtu", "<VTKFile type=\"UnstructuredGrid\""},
                            {"d.stl", "solid a\nendsolid a\n"},
                            {"e.ele", "1 3 0\n1 1 2 3\n"}}) {
    folder.write(file.name, file.content);
    const Ran ran = run("delray verify " + file.name + " --points p.xyz", folder.path());
    EXPECT_EQ(ran.exit_code, 3) << file.name << "\n" << ran.err;
    EXPECT_NE(ran.err.find(file.name.substr(0, 2)), std::string::npos) << ran.err;
    std::filesystem::remove(folder / file.name);
  }
  EXPECT_EQ(run("delray verify missing.ply --points p.xyz", folder.path()).exit_code, 3);
}

TEST(BadInput, MissingFilesAndFolders) {
  const Folder folder;
  for (const std::string command :
       {"delray render missing.obj -o a.png", "delray triangulate missing.las -o m.ply",
        "delray info missing.glb", "delray triangulate . -o m.ply", "delray render . -o a.png",
        "delray triangulate - -o m.ply"}) {
    const Ran ran = run(command, folder.path());
    EXPECT_EQ(ran.exit_code, 3) << command << "\n" << ran.err;
    EXPECT_TRUE(folder.files().empty()) << command;
  }
}

}  // namespace
}  // namespace delray::tests
