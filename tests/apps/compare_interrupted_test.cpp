// Ctrl-C: every comparison writes what it has finished, and says so.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/run_program.h"

namespace delray::tests {
namespace {

using Json = nlohmann::json;

struct Interrupted {
  const char* command;  // of two steps, of which the second takes a second and more
  const char* key;      // of a row: which step it belongs to
  const char* second;   // what the log says when the second begins
  int first;            // value of the key in the first
};
void PrintTo(const Interrupted& c, std::ostream* out) { *out << c.command; }

class Comparisons : public testing::TestWithParam<Interrupted> {};

TEST_P(Comparisons, WriteWhatIsFinishedWhenInterrupted) {
  const Interrupted& c = GetParam();
  const Folder folder;
  ASSERT_EQ(
      run("delray generate points uniform -n 20000 --dim 2 -o points.xyz", folder.path()).exit_code,
      0);
  const Ran ran = run("delray compare " + std::string(c.command) +
                          " -v -o report.html --stats f.json >table 2>log & p=$!; "
                          "while kill -0 $p && ! grep -q '" +
                          c.second +
                          "' log; do sleep 0.02; done; "
                          "kill -INT $p; wait $p",
                      folder.path());
  EXPECT_EQ(ran.exit_code, 130) << folder.read("log");
  const Json json = Json::parse(folder.read("f.json"));
  EXPECT_EQ(json["unfinished"], true);
  ASSERT_FALSE(json["rows"].empty());
  EXPECT_EQ(json["rows"].front()[c.key], c.first);
  EXPECT_NE(folder.read("report.html").find("was interrupted"), std::string::npos);
  EXPECT_NE(folder.read("log").find("interrupted: what was finished is written"),
            std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(
    OfAllFour, Comparisons,
    testing::Values(
        Interrupted{"triangulate points.xyz --threads 2", "points", "5000 points", 2500},
        Interrupted{"compose gen:city:3000 --size 97x65 --ranks 2,64", "ranks", "64 ranks", 2},
        Interrupted{"partition gen:city:3000 --size 97x65 --ranks 2,128", "ranks", "128 ranks", 2},
        Interrupted{"schedule gen:spheres:500 --size 160x120 --tile 16 --ranks 2,300", "ranks",
                    "300 ranks", 2}),
    [](const auto& tested) {
      const std::string command = tested.param.command;
      return command.substr(0, command.find(' '));
    });

}  // namespace
}  // namespace delray::tests
