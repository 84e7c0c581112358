// Names in files, as they are printed: what a terminal would obey and what is no text is escaped.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/run_program.h"

namespace delray::tests {
namespace {

constexpr const char* kFaces = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\xff\nf 1 2 3\n";

// A triangle whose material has this name, and whose buffer is there or in the file `uri`.
std::string gltf(const std::string& name, const std::string& uri) {
  return R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":)"
         R"({"POSITION":0},"material":0}]}],"accessors":[{"bufferView":0,"count":3,"type":"VEC3",)"
         R"("componentType":5126}],"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{)"
         R"("byteLength":36,"uri":")" +
         uri + R"("}],"materials":[{"name":")" + name + "\"}]}";
}

bool has_controls(const std::string& text) {
  return std::any_of(text.begin(), text.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return (byte < 0x20 && c != '\n') || byte == 0x7F;
  });
}

TEST(Printing, NamesThatAreNotText) {
  const Folder folder;
  folder.write("a.mtl", "newmtl a\xff\nKd 1 0 0\n");
  folder.write("a.obj", std::string("mtllib a.mtl\n") + kFaces);
  const Ran ran = run("delray info a.obj", folder.path());
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_NE(ran.out.find("materials: [\"a\xef\xbf\xbd\"]"), std::string::npos) << ran.out;
  const Ran told = run("delray info a.obj --stats -", folder.path());
  EXPECT_EQ(told.exit_code, 0) << told.err;
  EXPECT_EQ(nlohmann::json::parse(told.out)["materials"][0], "a\xef\xbf\xbd");
}

TEST(Printing, NamesThatTerminalsWouldObey) {
  const Folder folder;
  const std::string escape = R"(\u001b[31mRED\u001b]0;owned\u0007\u009b2J\u202e)";
  const std::string triangle =
      "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
  folder.write("a.gltf", gltf(escape, triangle));
  for (const std::string options : {"", " --stats -"}) {
    const Ran ran = run("delray info a.gltf" + options, folder.path());
    EXPECT_EQ(ran.exit_code, 0) << ran.err;
    EXPECT_FALSE(has_controls(ran.out)) << ran.out;
    EXPECT_EQ(ran.out.find("\xc2\x9b"), std::string::npos);
    EXPECT_EQ(ran.out.find("\xe2\x80\xae"), std::string::npos);
    EXPECT_NE(ran.out.find("RED"), std::string::npos) << ran.out;
  }
  folder.write("b.gltf", gltf("", escape + R"(\nerror: not so)"));
  const Ran ran = run("delray render b.gltf -o a.png", folder.path());
  EXPECT_EQ(ran.exit_code, 3);
  EXPECT_FALSE(has_controls(ran.err)) << ran.err;
  EXPECT_NE(ran.err.find("\\x1b[31mRED\\x1b]0;owned\\x07\\u009b2J\\u202e\\nerror"),
            std::string::npos)
      << ran.err;
  const Ran named = run("delray info 'x\x1b[31m.obj'", folder.path());
  EXPECT_EQ(named.exit_code, 3);
  EXPECT_FALSE(has_controls(named.err)) << named.err;
}

}  // namespace
}  // namespace delray::tests
