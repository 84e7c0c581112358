#include "apps/view/look.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "apps/session.h"
#include "raster/strategies.h"

namespace delray::apps::view {
namespace {

const Input kScene = {"gen:spheres:100"};

TEST(ViewLook, MovesByTheRasterizerAndRestsAsWanted) {
  const Look look = make_look(
      kScene,
      {{"--engine", "raytrace"}, {"--integrator", "path"}, {"--spp", "64"}, {"--samples", "4"}});
  EXPECT_EQ(look.still.engine, Engine::raytrace);
  EXPECT_EQ(look.still.raytrace.samples, 64);
  EXPECT_EQ(look.moving.engine, Engine::raster);
  EXPECT_EQ(look.moving.raster.supersampling, 1);
  EXPECT_EQ(option_of(look.still_options, "--samples"), "");  // the rasterizer's
  EXPECT_EQ(option_of(look.moving_options, "--spp"), "");
}

TEST(ViewLook, LeavesOutWhatChangesNothing) {
  const Look look = make_look(kScene, {{"--strategy", "sort-last"},
                                       {"--partition", "kd-split"},
                                       {"--regions", "2"},
                                       {"--codec", "active"}});
  EXPECT_EQ(look.still_options, (Options{{"--strategy", "sort-last"}, {"--codec", "active"}}));
}

TEST(ViewLook, SaysWhatIsWrong) {
  EXPECT_THROW(make_look(kScene, {{"--strategy", "sort-frist"}}), UsageError);
  EXPECT_THROW(make_look(kScene, {{"--samples", "3"}}), UsageError);
  EXPECT_THROW(make_look(kScene, {{"--exposure", "nan"}, {"--engine", "raytrace"}}), UsageError);
  EXPECT_THROW(make_look(kScene, {{"--ranks", "-4"}}), UsageError);
}

TEST(ViewLook, ValuesAreNeverOptions) {
  EXPECT_THROW(
      make_look(kScene, {{"--partition", "--output=/tmp/x"}, {"--strategy", "sort-first"}}),
      UsageError);
  EXPECT_THROW(make_look(kScene, {{"--spp", "4 --checkpoint x"}, {"--engine", "raytrace"}}),
               UsageError);
}

TEST(ViewLook, PanelHasWhatTheTablesHave) {
  std::set<std::string> names;
  for (const Json& group : panel_of(kScene, {{"--strategy", "sort-first"}})) {
    EXPECT_FALSE(group["name"].get<std::string>().empty());
    for (const Json& option : group["options"]) {
      names.insert(option["name"].get<std::string>());
      EXPECT_FALSE(option["help"].get<std::string>().empty()) << option["name"];
      if (option["name"] == "--strategy") {
        EXPECT_EQ(option["values"].size(), raster::strategies().size());
        EXPECT_EQ(option["value"], "sort-first");
        EXPECT_EQ(option["idle"], "");
      }
      if (option["name"] == "--compose") {
        EXPECT_EQ(option["idle"], "--strategy sort-first");
      }
      if (option["name"] == "--spp") {
        EXPECT_EQ(option["idle"], "--engine raster");
      }
    }
  }
  for (const PanelOption& option : panel_options())
    EXPECT_TRUE(names.contains(option.name)) << option.name;
}

TEST(ViewLook, NothingThatReadsOrWritesFilesIsOnThePanel) {
  for (const char* name : {"--output", "--light", "--stats", "--checkpoint", "--camera-path",
                           "--record", "--memory", "--allow-outside"}) {
    EXPECT_EQ(find_panel_option(name), nullptr) << name;
  }
}

TEST(ViewLook, CommandNamesSceneOptionsAndCamera) {
  Look look = make_look({"a b.glb", "--light=none"}, {{"--samples", "2"}, {"--legend", "true"}});
  set_size(640, 480, look.still);
  EXPECT_EQ(command_for({"a b.glb", "--light=none"}, look, {"1,2,3,0,0,0,0,0,1,40"}),
            "delray render 'a b.glb' --light=none --samples=2 --legend --size 640x480 "
            "--camera=1,2,3,0,0,0,0,0,1,40 -o picture.png");
}

}  // namespace
}  // namespace delray::apps::view
