// The built program, and a page that is a test.
#include <gtest/gtest.h>
#include <signal.h>

#include <cstdio>
#include <glm/glm.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/apps/view/running.h"
#include "tests/support/run_program.h"

namespace delray::tests {
namespace {

using Json = nlohmann::json;

TEST(View, ADragTurnsThePictureAndRestsAsRenderMakesIt) {
  Running view({"gen:spheres:500", "--ranks", "2", "--threads", "1"});
  PageClient page(view.address());
  page.say(hello(160, 90));
  EXPECT_EQ(page.wait_for("scene")["name"], "gen:spheres:500");
  const Json placed = page.wait_for("camera");
  const PageFrame first = page.wait_for_frame(is_complete);
  EXPECT_EQ(first.header["type"], "image/png");
  EXPECT_EQ(first.header["width"], 160);
  for (std::uint64_t i = 1; i <= 5; ++i) {
    page.say(camera(placed, i, true, 0.1 * static_cast<double>(i)));
    const PageFrame frame =
        page.wait_for_frame([&](const Json& header) { return header["camera"] == i; });
    EXPECT_EQ(frame.header["stage"], "moving");
    EXPECT_EQ(frame.header["type"], "image/jpeg");
  }
  page.say(camera(placed, 6, false, 0.6));
  const PageFrame last = page.wait_for_frame(
      [](const Json& header) { return header["camera"] == 6 && is_complete(header); });
  EXPECT_NE(hash_of(first), hash_of(last));

  page.say({{"type", "command"}});
  const std::string command = page.wait_for("command")["text"];
  Folder folder;
  const Ran rendered = run(command + " --stats -", folder.path());
  ASSERT_EQ(rendered.exit_code, 0) << command << rendered.err;
  EXPECT_EQ(Json::parse(rendered.out)["image"]["hash"], hash_of(last)) << command;
}

TEST(View, OptionsArePerPageButForTheScene) {
  Running view({"gen:spheres:300", "--ranks", "2", "--threads", "1"});
  PageClient a(view.address()), b(view.address());
  for (PageClient* page : {&a, &b}) {
    page->say(hello(96, 64));
    page->wait_for("camera");
  }
  const std::string before = hash_of(a.wait_for_frame(is_complete));
  a.say({{"type", "watch"}, {"visible", true}, {"figures", true}});
  a.say({{"type", "option"}, {"name", "--strategy"}, {"value", "sort-first"}});
  const Json figures = [&] {
    for (;;) {
      Json found = a.wait_for("figures");
      if (!found["regions"].empty()) return found;
    }
  }();
  EXPECT_EQ(figures["regions"].size(), 2U);
  EXPECT_EQ(figures["loads"].size(), 2U);
  EXPECT_GE(figures["imbalance"], 1.0);
  EXPECT_NE(figures["html"].get<std::string>().find("<svg"), std::string::npos);
  a.say({{"type", "option"}, {"name", "--strategy"}, {"value", "sort-frist"}});
  EXPECT_NE(a.wait_for("error")["text"].get<std::string>().find("did you mean 'sort-first'"),
            std::string::npos);
  EXPECT_EQ(hash_of(b.wait_for_frame(is_complete)), before);

  b.say({{"type", "option"}, {"name", "--ranks"}, {"value", "3"}});
  b.wait_for("scene");
  a.say({{"type", "watch"}, {"visible", true}, {"figures", false}});
  a.say({{"type", "watch"}, {"visible", true}, {"figures", true}});
  for (Json found = figures; found["loads"].size() != 3; found = a.wait_for("figures")) {
  }
}

TEST(View, RaysGrowAndArePickedThrough) {
  Running view({"gen:spheres:300", "--engine", "raytrace", "--integrator", "path", "--spp", "8",
                "--threads", "1"});
  PageClient page(view.address());
  page.say(hello(64, 48));
  const Json placed = page.wait_for("camera");
  bool had_coarse = false;
  const PageFrame still = page.wait_for_frame([&](const Json& header) {
    had_coarse = had_coarse || header["stage"] == "coarse";
    return is_complete(header);
  });
  EXPECT_TRUE(had_coarse);
  EXPECT_EQ(still.header["samples"], 8.0);
  page.say({{"type", "pick"}, {"x", 0.5}, {"y", 0.5}});
  const Json pick = page.wait_for("pick");
  ASSERT_TRUE(pick["hit"]);
  EXPECT_EQ(pick["facts"][0][0], "coordinates");
  page.say({{"type", "command"}});
  Folder folder;
  const std::string command = page.wait_for("command")["text"];
  const Ran rendered = run(command + " --stats -", folder.path());
  ASSERT_EQ(rendered.exit_code, 0) << command << rendered.err;
  EXPECT_EQ(Json::parse(rendered.out)["image"]["hash"], hash_of(still)) << command;
}

TEST(View, EndsWithCtrlCAndWithTheLastPage) {
  Running one({"gen:spheres:100", "--threads", "1"});
  ::kill(one.process(), SIGINT);
  EXPECT_EQ(one.exit_code(), 130);
  Running other({"gen:spheres:100", "--threads", "1", "--once"});
  { PageClient page(other.address()); }
  EXPECT_EQ(other.exit_code(), 0);
}

TEST(View, AClippedPictureIsTheOneThatItsCommandMakes) {
  Running view({"gen:spheres:500", "--ranks", "2", "--threads", "1", "--view", "top"});
  PageClient page(view.address());
  page.say(hello(160, 90));
  Json placed = page.wait_for("camera");
  EXPECT_EQ(placed["clip"], 0);
  const PageFrame whole = page.wait_for_frame(is_complete);
  glm::dvec3 eye, at;
  for (int i = 0; i < 3; ++i) {
    eye[i] = placed["eye"][static_cast<std::size_t>(i)].get<double>();
    at[i] = placed["at"][static_cast<std::size_t>(i)].get<double>();
  }
  placed["clip"] = static_cast<float>(glm::distance(eye, at));
  page.say(camera(placed, 1, false, 0));
  const PageFrame cut = page.wait_for_frame(
      [](const Json& header) { return header["camera"] == 1 && is_complete(header); });
  EXPECT_NE(hash_of(whole), hash_of(cut));

  page.say({{"type", "command"}});
  const std::string command = page.wait_for("command")["text"];
  EXPECT_NE(command.find("--clip="), std::string::npos);
  EXPECT_EQ(command.find("--view"), std::string::npos) << "the camera stands for it";
  Folder folder;
  const Ran rendered = run(command + " --stats -", folder.path());
  ASSERT_EQ(rendered.exit_code, 0) << command << rendered.err;
  EXPECT_EQ(Json::parse(rendered.out)["image"]["hash"], hash_of(cut)) << command;
}

// What the page is told of the place in the middle of its picture, by name.
std::map<std::string, std::string> facts_in_the_middle(PageClient& page) {
  page.say({{"type", "pick"}, {"x", 0.5}, {"y", 0.5}});
  const Json pick = page.wait_for("pick");
  std::map<std::string, std::string> facts;
  if (!pick["hit"].get<bool>()) return facts;
  for (const Json& fact : pick["facts"]) facts[fact[0]] = fact[1];
  return facts;
}

TEST(View, APickedPointHasTheAttributesOfItsFile) {
  Folder folder;
  folder.write("survey.csv",
               "x,y,z,intensity,classification,red,green,blue\n"
               "500,500,7,0.25,2,10,20,30\n"
               "510,500,7,0.5,6,40,50,60\n"
               "500,510,7,0.5,9,70,80,90\n"
               "510,510,7,0.5,5,1,2,3\n"
               "505,505,9,0.75,6,255,128,0\n");
  const std::string file = (folder.path() / "survey.csv").string();
  for (const char* const shown : {"points", "relief"}) {
    Running view(
        {file, "--show-as", shown, "--view", "top", "--exaggeration", "3", "--threads", "1"});
    PageClient page(view.address());
    page.say(hello(160, 160));
    page.wait_for("camera");
    page.wait_for_frame(is_complete);
    const auto facts = facts_in_the_middle(page);
    EXPECT_EQ(facts.at("nearest point"), "row 4") << shown;
    EXPECT_EQ(facts.at("classification"), "6 building");
    EXPECT_EQ(facts.at("rgb"), "#ff8000");
    EXPECT_TRUE(facts.contains("intensity"));
    double z = 0;
    ASSERT_EQ(std::sscanf(facts.at("coordinates").c_str(), "%*f, %*f, %lf", &z), 1);
    EXPECT_NEAR(z, 9, 0.1) << "without the exaggeration";
  }
}

TEST(View, ManyPointsAreShownBeforeTheirSurfaceIsThere) {
  Folder folder;
  ASSERT_EQ(run("delray generate points uniform -n 250000 --dim 3 -q -o many.ply", folder.path())
                .exit_code,
            0);
  Running view({(folder.path() / "many.ply").string(), "--show-as", "relief", "--threads", "1"});
  PageClient page(view.address());
  page.say(hello(64, 48));
  Json scene = page.wait_for("scene");
  if (scene["triangles"] == 0) {  // otherwise this machine was faster than the connection
    EXPECT_GT(scene["points"], 50000);
    EXPECT_LT(scene["points"], 150000);
    page.wait_for("camera");
    page.wait_for_frame([](const Json&) { return true; });
    const Json before = scene;
    scene = page.wait_for("scene");
    EXPECT_EQ(scene["origin"], before["origin"]);
  }
  EXPECT_GT(scene["triangles"], 400000);
  page.wait_for_frame(is_complete);
}

TEST(View, WhatIsWrongEndsBeforeAnythingIsServed) {
  Folder folder;
  folder.write("bad.obj", "v 1 2\nf 1 2 3\n");
  EXPECT_EQ(run("delray view", folder.path()).exit_code, 2);
  const Ran missing = run("delray view missing.glb", folder.path());
  EXPECT_EQ(missing.exit_code, 3);
  EXPECT_EQ(missing.out, "");
  EXPECT_NE(missing.err.find("missing.glb"), std::string::npos);
  EXPECT_EQ(run("delray view bad.obj", folder.path()).exit_code, 3);
  EXPECT_EQ(run("delray view gen:spheres:100 --bind nowhere", folder.path()).exit_code, 2);
  EXPECT_EQ(run("DELRAY_VIEW_TOKEN=short delray view gen:spheres:100", folder.path()).exit_code, 2);
  const Ran idle = run("delray view gen:spheres:100 --bind 192.0.2.1", folder.path());
  EXPECT_EQ(idle.exit_code, 1) << "no address of this machine";
}

TEST(View, MpiRanksRenderAndRankZeroServes) {
  Running view({"gen:spheres:300", "--threads", "1"}, "env " + mpirun(2));
  PageClient page(view.address());
  page.say(hello(96, 64));
  const Json placed = page.wait_for("camera");
  page.say({{"type", "watch"}, {"visible", true}, {"figures", true}});
  EXPECT_EQ(page.wait_for("figures")["loads"].size(), 2U);
  page.say(camera(placed, 1, true, 0.1));
  page.wait_for_frame([](const Json& header) { return header["camera"] == 1; });
  page.say({{"type", "option"}, {"name", "--ranks"}, {"value", "3"}});
  EXPECT_NE(page.wait_for("error")["text"].get<std::string>().find("launcher"), std::string::npos);
  ::kill(view.process(), SIGINT);
  EXPECT_NE(view.exit_code(), 0);
}

}  // namespace
}  // namespace delray::tests
