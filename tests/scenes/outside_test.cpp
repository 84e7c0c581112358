// Scenes that name files elsewhere: what lies outside of their folder, and what is no file, is not
// opened.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <string>

#include "files/error.h"
#include "files/read_file.h"
#include "image/io.h"
#include "scenes/load.h"
#include "tests/support/temporary_folder.h"

namespace delray::scenes {
namespace {

namespace fs = std::filesystem;
using files::Outside;

// A triangle whose coordinates are in the file `uri` and whose colour is in the picture `picture`.
std::string triangle(const std::string& uri, const std::string& picture) {
  return R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":)"
         R"({"POSITION":0},"material":0}]}],"accessors":[{"bufferView":0,"count":3,"type":"VEC3",)"
         R"("componentType":5126}],"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{)"
         R"("byteLength":36,"uri":")" +
         uri + R"("}],"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],)" +
         R"("textures":[{"source":0}],"images":[{"uri":")" + picture + "\"}]}";
}

// scene/ with a link to ../secret.bin and a pipe, and the files beside and in it that are named.
class OutsideFiles : public testing::Test {
 protected:
  OutsideFiles() {
    fs::create_directory(folder_ / "scene");
    const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const std::string bytes(reinterpret_cast<const char*>(corners), sizeof corners);
    const std::vector<std::byte> png = image::encode_png(1, 1, std::vector<image::Rgba8>(1));
    const std::string_view picture(reinterpret_cast<const char*>(png.data()), png.size());
    for (const std::string place : {"", "scene/"}) {
      folder_.write(place + "secret.bin", bytes);
      folder_.write(place + "secret.png", picture);
    }
    folder_.write("secret.mtl", "newmtl m\nKd 1 0 0\n");
    fs::create_symlink("../secret.bin", folder_ / "scene/link.bin");
    fs::create_symlink("../secret.png", folder_ / "scene/link.png");
    ::mkfifo((folder_ / "scene/pipe.bin").c_str(), 0600);
    ::mkfifo((folder_ / "scene/pipe.png").c_str(), 0600);
  }
  Scene load_text(const std::string& name, const std::string& content,
                  Outside outside = Outside::refused) {
    warnings_.clear();
    LoadOptions options;
    options.outside = outside;
    return load(folder_.write("scene/" + name, content), warnings_, options);
  }
  std::string whole(const std::string& name) const { return fs::canonical(folder_ / name); }

  const tests::TemporaryFolder folder_;
  std::vector<std::string> warnings_;
};

TEST_F(OutsideFiles, BuffersAreRefused) {
  for (const std::string& uri : {std::string("../secret.bin"), std::string("%2e%2e/secret.bin"),
                                 std::string("..%2Fsecret.bin"), std::string("..%5csecret.bin"),
                                 std::string("link.bin"), whole("secret.bin")}) {
    SCOPED_TRACE(uri);
    try {
      load_text("a.gltf", triangle(uri, "secret.png"));
      ADD_FAILURE() << "was read";
    } catch (const files::FileError& error) {
      EXPECT_EQ(error.cause(), files::Cause::input);
      EXPECT_EQ(error.place(), "buffers[0].uri");
      EXPECT_NE(std::string(error.what()).find("outside"), std::string::npos) << error.what();
    }
    const Scene scene = load_text("a.gltf", triangle(uri, "secret.png"), Outside::allowed);
    EXPECT_EQ(triangle_count(scene), 1U);
    EXPECT_TRUE(warnings_.empty());
  }
  EXPECT_EQ(triangle_count(load_text("a.gltf", triangle("secret.bin", "secret.png"))), 1U);
}

TEST_F(OutsideFiles, PipesAndDevicesAreNeverOpened) {
  for (const Outside outside : {Outside::refused, Outside::allowed}) {
    for (const std::string uri : {"pipe.bin", "/dev/zero", "/dev/urandom", "/dev/stdin", "."}) {
      EXPECT_THROW(load_text("a.gltf", triangle(uri, "secret.png"), outside), files::FileError)
          << uri;
    }
    for (const std::string picture : {"pipe.png", "/dev/zero"}) {
      const Scene scene = load_text("a.gltf", triangle("secret.bin", picture), outside);
      EXPECT_TRUE(scene.textures.empty()) << picture;
      EXPECT_EQ(warnings_.size(), 1U) << picture;
    }
  }
}

TEST_F(OutsideFiles, TexturesOfGltfAreLeftOut) {
  for (const std::string& picture : {std::string("../secret.png"), std::string("%2E%2E/secret.png"),
                                     std::string("link.png"), whole("secret.png")}) {
    SCOPED_TRACE(picture);
    const Scene scene = load_text("a.gltf", triangle("secret.bin", picture));
    EXPECT_TRUE(scene.textures.empty());
    ASSERT_EQ(warnings_.size(), 1U);
    EXPECT_NE(warnings_[0].find("--allow-outside"), std::string::npos) << warnings_[0];
    EXPECT_EQ(
        load_text("a.gltf", triangle("secret.bin", picture), Outside::allowed).textures.size(), 1U);
  }
}

TEST_F(OutsideFiles, MaterialsAndTexturesOfObjAreLeftOut) {
  const std::string faces = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n";
  const auto is_red = [](const Scene& scene) {
    return std::any_of(scene.materials.begin(), scene.materials.end(), [](const Material& m) {
      return glm::vec3(m.base_colour) == glm::vec3(1, 0, 0);
    });
  };
  for (const std::string& name : {std::string("../secret.mtl"), whole("secret.mtl")}) {
    SCOPED_TRACE(name);
    const std::string obj = "mtllib " + name + "\n" + faces;
    EXPECT_FALSE(is_red(load_text("a.obj", obj)));
    ASSERT_FALSE(warnings_.empty());
    EXPECT_NE(warnings_[0].find("--allow-outside"), std::string::npos) << warnings_[0];
  }
  EXPECT_TRUE(is_red(load_text("a.obj", "mtllib ../secret.mtl\n" + faces, Outside::allowed)));
  for (const std::string& picture :
       {std::string("../secret.png"), std::string("..\\secret.png"), std::string("link.png"),
        whole("secret.png"), std::string("pipe.png")}) {
    SCOPED_TRACE(picture);
    folder_.write("scene/a.mtl", "newmtl m\nKd 1 0 0\nmap_Kd " + picture + "\n");
    EXPECT_TRUE(load_text("a.obj", "mtllib a.mtl\n" + faces).textures.empty());
    EXPECT_EQ(warnings_.size(), 1U);
  }
}

TEST_F(OutsideFiles, MaterialsAreReadOnceHoweverOftenTheyAreNamed) {
  folder_.write("scene/a.mtl", "newmtl m\nKd 1 0 0\n");
  std::string text;
  for (int i = 0; i < 100; ++i) text += "mtllib a.mtl\nmtllib ./a.mtl\nmtllib none.mtl\n";
  const Scene scene = load_text("a.obj", text + "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n");
  EXPECT_EQ(scene.materials.size(), 1U);
  EXPECT_EQ(warnings_.size(), 1U);
}

}  // namespace
}  // namespace delray::scenes
