// delray render and info of scenes far from the origin: the picture is that of the scene near it.
#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/run_program.h"

namespace delray::tests {
namespace {

using nlohmann::json;

// An octahedron of radius 8 around (x, y, 0).
std::string octahedron(int x, int y) {
  std::string obj;
  for (const auto& [dx, dy, dz] :
       {std::array{8, 0, 0}, {-8, 0, 0}, {0, 8, 0}, {0, -8, 0}, {0, 0, 8}, {0, 0, -8}}) {
    obj += "v " + std::to_string(x + dx) + " " + std::to_string(y + dy) + " " + std::to_string(dz) +
           "\n";
  }
  for (const char* face :
       {"1 3 5", "3 2 5", "2 4 5", "4 1 5", "3 1 6", "2 3 6", "4 2 6", "1 4 6"}) {
    obj += std::string("f ") + face + "\n";
  }
  return obj;
}

json rendered(const std::string& arguments, const Folder& folder) {
  const Ran ran = run("delray render " + arguments + " -o a.png --size 80x60 --stats stats.json -q",
                      folder.path());
  EXPECT_EQ(ran.exit_code, 0) << arguments << "\n" << ran.err;
  EXPECT_EQ(ran.err, "") << arguments;
  return json::parse(folder.read("stats.json"));
}

TEST(RenderFar, GivesThePictureOfTheSceneNearTheOrigin) {
  const Folder folder;
  folder.write("near.obj", octahedron(0, 0));
  folder.write("far.obj", octahedron(512345, 5412345));
  folder.write("near.txt", "2,-40,12,0,0,0,0,0,1,40\n9,-40,12,0,0,0,0,0,1,40\n");
  folder.write("far.txt",
               "512347,5412305,12,512345,5412345,0,0,0,1,40\n"
               "512354,5412305,12,512345,5412345,0,0,0,1,40\n");
  for (const std::string engine :
       {"", "--ranks 2 --strategy sort-last ", "--engine raytrace --ranks 2 --data object "}) {
    EXPECT_EQ(rendered("far.obj " + engine, folder)["image"]["hash"],
              rendered("near.obj " + engine, folder)["image"]["hash"])
        << engine;
    const json far =
        rendered("far.obj --camera 512347,5412305,12,512345,5412345,0,0,0,1,40 " + engine, folder);
    EXPECT_EQ(far["image"]["hash"], rendered("near.obj --camera 2,-40,12,0,0,0,0,0,1,40 " + engine,
                                             folder)["image"]["hash"])
        << engine;
    EXPECT_EQ(far["camera"]["eye"], (json{512347, 5412305, 12}));
    EXPECT_EQ(far["camera"]["at"], (json{512345, 5412345, 0}));
  }
  EXPECT_EQ(rendered("far.obj --camera-path far.txt", folder)["image"]["hash"],
            rendered("near.obj --camera-path near.txt", folder)["image"]["hash"]);
}

TEST(RenderFar, InfoTellsTheCoordinatesOfTheFile) {
  const Folder folder;
  folder.write("far.obj", octahedron(512345, 5412345));
  const json info = json::parse(run("delray info far.obj --stats - -q", folder.path()).out);
  EXPECT_EQ(info["low"], (json{512337, 5412337, -8}));
  EXPECT_EQ(info["high"], (json{512353, 5412353, 8}));
}

}  // namespace
}  // namespace delray::tests
