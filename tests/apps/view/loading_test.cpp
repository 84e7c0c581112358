// What pages see while a scene is loaded. Its light comes through a pipe, so that a test says how
// long that takes.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cerrno>
#include <chrono>
#include <string>
#include <thread>
#include <utility>

#include "image/io.h"
#include "scenes/generate.h"
#include "scenes/write_glb.h"
#include "tests/apps/view/running.h"
#include "tests/support/run_program.h"

namespace delray::tests {
namespace {

using Json = nlohmann::json;

class ViewLoading : public testing::Test {
 protected:
  ViewLoading() {
    image::Image8 white(2, 1);
    for (image::Rgba8& c : white.colour.span()) c = {255, 255, 255, 255};
    image::write_image(path("white.png"), white);
    if (::mkfifo(pipe_.c_str(), 0600) != 0) throw std::runtime_error("mkfifo");
  }
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  std::string glb() const {
    scenes::Scene terrain = scenes::generate("gen:terrain:2100000");
    terrain.meshes[0].normals.clear();
    scenes::write_glb(path("terrain.glb"), terrain);
    return path("terrain.glb");
  }
  std::string points() const {
    const Ran ran =
        run("delray generate points uniform -n 250000 --dim 3 -q -o many.ply", folder_.path());
    EXPECT_EQ(ran.exit_code, 0) << ran.err;
    return path("many.ply");
  }
  std::vector<std::string> arguments(const std::string& scene,
                                     std::vector<std::string> more = {}) const {
    more.insert(more.end(), {scene, "--light", pipe_, "--threads", "2"});
    return more;
  }
  // Waits for a load to wait for its light.
  void wait_for_load() {
    constexpr std::chrono::milliseconds kAgain{5};
    constexpr int kTimes = 20000;
    for (int i = 0; i < kTimes && light_ < 0; ++i) {
      light_ = ::open(pipe_.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
      if (light_ < 0) std::this_thread::sleep_for(kAgain);
    }
    ASSERT_GE(light_, 0) << "nobody wants light";
  }
  // It goes on.
  void light() {
    wait_for_load();
    const std::string picture = folder_.read("white.png");
    EXPECT_EQ(::write(light_, picture.data(), picture.size()),
              static_cast<ssize_t>(picture.size()));
    ::close(std::exchange(light_, -1));
  }

  Folder folder_;
  const std::string pipe_ = path("light.png");
  int light_ = -1;  // of a load that waits
};

std::uint64_t primitives(const Json& scene) {
  return scene["triangles"].get<std::uint64_t>() + scene["points"].get<std::uint64_t>();
}

TEST_F(ViewLoading, AFirstPictureComesBeforeAllTrianglesAreThere) {
  Running view(arguments(glb()));
  PageClient page(view.address());
  page.say(hello(64, 48));
  const Json some = page.wait_for("scene");
  EXPECT_LE(primitives(some), 200'000U);
  EXPECT_GT(primitives(some), 10'000U);
  const Json placed = page.wait_for("camera");
  const PageFrame first = page.wait_for_frame([](const Json&) { return true; });
  EXPECT_EQ(first.header["stage"], "sharp");
  page.say({{"type", "pick"}, {"x", 0.5}, {"y", 0.5}});
  const Json pick = page.wait_for("pick");
  EXPECT_TRUE(pick["hit"]);
  for (const Json& fact : pick["facts"]) EXPECT_NE(fact[0], "triangle") << "none of the file's";
  light();
  const Json whole = page.wait_for("scene");
  EXPECT_GT(primitives(whole), 2'000'000U);
  EXPECT_EQ(whole["origin"], some["origin"]);
  EXPECT_EQ(whole["z_up"], some["z_up"]);
  // The same place but for what was left out.
  const Json again = page.wait_for("camera");
  EXPECT_NEAR(again["eye"][0].get<double>(), placed["eye"][0].get<double>(),
              0.02 * whole["size"].get<double>());
  page.wait_for_frame(is_complete);
}

TEST_F(ViewLoading, ACameraThatWasMovedInTheFirstPictureStays) {
  Running view(arguments(glb()));
  PageClient page(view.address());
  page.say(hello(64, 48));
  const Json placed = page.wait_for("camera");
  page.say(camera(placed, 1, true, 0.5));
  page.wait_for_frame([](const Json& header) { return header["camera"] == 1; });
  page.say(camera(placed, 2, false, 1));
  page.wait_for_frame([](const Json& header) { return header["camera"] == 2; });
  light();
  page.watch([](const Json& message) { EXPECT_NE(message["type"], "camera"); });
  page.wait_for("scene");
  page.wait_for_frame(
      [](const Json& header) { return header["camera"] == 2 && is_complete(header); });
}

TEST_F(ViewLoading, ProgressIsShownBesideTheFirstPictures) {
  Running view(arguments(points(), {"--show-as", "relief"}));
  PageClient page(view.address());
  page.say(hello(64, 48));
  const Json placed = page.wait_for("camera");
  std::vector<std::string> told;
  page.watch([&](const Json& message) {
    if (message["type"] == "progress") told.push_back(message["text"]);
  });
  for (std::uint64_t i = 1; i <= 20; ++i) {
    page.say(camera(placed, i, true, 0.001 * static_cast<double>(i)));
    page.say({{"type", "pick"}, {"x", 0.5}, {"y", 0.5}});
    page.wait_for("pick");
    page.wait_for_frame([&](const Json& header) { return header["camera"] == i; });
  }
  page.say({{"type", "pick"}, {"x", 0.5}, {"y", 0.5}});
  page.wait_for("pick");
  for (const std::string& text : told) EXPECT_NE(text, "");
  light();
  page.wait_for_frame(is_complete);
}

TEST_F(ViewLoading, AnOptionThatCannotBeIsTakenBackBeforeAllIsThere) {
  Running view(arguments(points(), {"--show-as", "relief"}));
  PageClient page(view.address());
  page.say(hello(64, 48));
  page.wait_for("camera");
  wait_for_load();
  page.say({{"type", "option"}, {"name", "--color-by"}, {"value", "classification"}});
  page.wait_for("panel");  // it was heard
  light();                 // of the first load, which is left
  EXPECT_NE(page.wait_for("error")["text"].get<std::string>().find("classification"),
            std::string::npos);
  light();
  for (Json scene = page.wait_for("scene"); scene["triangles"] == 0;)
    scene = page.wait_for("scene");
  page.wait_for_frame(is_complete);
}

TEST_F(ViewLoading, AnOptionSetMeanwhileBeginsAnewWithAFirstPicture) {
  Running view(arguments(points(), {"--show-as", "relief"}));
  PageClient page(view.address());
  page.say(hello(64, 48));
  const Json placed = page.wait_for("camera");
  wait_for_load();
  page.say({{"type", "option"}, {"name", "--exaggeration"}, {"value", "2"}});
  page.wait_for("panel");  // it was heard
  light();                 // of the first load, which is left
  const Json some = page.wait_for("scene");
  EXPECT_EQ(some["triangles"], 0);
  page.say(camera(placed, 1, false, 0.1));
  page.wait_for_frame([](const Json& header) { return header["camera"] == 1; });
  light();
  EXPECT_GT(page.wait_for("scene")["triangles"], 400000);
  page.wait_for_frame(is_complete);
}

}  // namespace
}  // namespace delray::tests
