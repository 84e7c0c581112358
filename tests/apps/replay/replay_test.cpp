// --record, delray replay, and networks from files, by the built program.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "tests/support/run_program.h"

namespace delray::tests {
namespace {

using Json = nlohmann::json;

const std::string kRing = R"({"schema": "delray.network/1", "topology": "ring", "latency": 1e-4,
    "overhead": 1e-6, "bytes_per_second": 1e9})";

TEST(Replay, PredictsARecordedRunOverNetworksOfTheTableAndOfFiles) {
  const Folder folder;
  folder.write("own.json", kRing);
  const std::string render = "delray render gen:cornell:100 --size 24x24 --strategy sort-last -o ";
  const Ran plain = run(render + "a.png --ranks 3 --threads 1", folder.path());
  ASSERT_EQ(plain.exit_code, 0) << plain.err;
  const Ran recorded = run(render + "b.png --ranks 3 --threads 1 --record l.json", folder.path());
  ASSERT_EQ(recorded.exit_code, 0) << recorded.err;
  EXPECT_EQ(folder.read("a.png"), folder.read("b.png"));

  const std::string command = "delray replay l.json --network this-machine,own.json,hypercube";
  const Ran ran = run(command + " --stats -", folder.path());
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const Json outcome = Json::parse(ran.out);
  EXPECT_EQ(outcome["schema"], "delray.replay/1");
  EXPECT_EQ(outcome["ledger"]["ranks"], 3);
  EXPECT_GT(outcome["ledger"]["bytes"], 0);
  EXPECT_GT(outcome["ledger"]["seconds"], 0);
  ASSERT_EQ(outcome["rows"].size(), 3U);
  EXPECT_EQ(outcome["rows"][1]["network"], "own");
  EXPECT_EQ(outcome["networks"][1]["topology"], "ring");
  for (const Json& row : outcome["rows"]) EXPECT_GT(row["seconds"], 0);
  EXPECT_GT(outcome["rows"][1]["seconds"], 1e-4);
  EXPECT_NE(run(command, folder.path()).out.find("hypercube"), std::string::npos);
  // What stands in the statistics is a network that can be read.
  folder.write("again.json", outcome["networks"][1].dump());
  const Ran again = run("delray replay l.json --network again.json --stats -", folder.path());
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(Json::parse(again.out)["rows"][0]["seconds"], outcome["rows"][1]["seconds"]);
}

TEST(Replay, RefusesWhatItCannotDo) {
  const Folder folder;
  folder.write("bad.json", "{\n\"schema\": 3}");
  folder.write("small.json", R"({"schema": "delray.network/1", "topology": "grid", "sides": [2],
      "latency": 0, "overhead": 0, "bytes_per_second": 1})");
  folder.write("ring.json", kRing);
  folder.write("l.json", R"({"schema": "delray.ledger/1", "seconds": 1, "machine": )" + kRing +
                             R"(, "ranks": [[], [], []]})");
  folder.write("stuck.json",
               R"({"schema": "delray.ledger/1", "seconds": 1, "machine": )" + kRing +
                   R"(, "ranks": [[["receive","other",0,1,1,1,0,1],["send","other",0,1,1,1,0,1]],
                                  [["receive","other",0,0,1,1,0,1],["send","other",0,0,1,1,0,1]]]})");
  const struct {
    std::string arguments;
    int exit_code;
    std::string why;
  } cases[] = {
      {"replay", 2, "LEDGER"},
      {"replay l.json --network nonsense", 2, "nonsense"},
      {"replay l.json --network ring,ring", 2, "two are called"},
      {"replay l.json --network small.json", 2, "no place for 3 ranks"},
      {"replay l.json --stats l.json", 2, "l.json"},
      {"replay l.json --network bad.json", 3, "bad.json: \"schema\""},
      {"replay l.json --network absent.json", 3, "absent.json"},
      {"replay bad.json", 3, "bad.json: \"schema\""},
      {"replay stuck.json", 3, "stuck.json: ranks wait for each other"},
      {"render gen:cornell:100 -o a.png --record r.json", 2, "single rank"},
      {"render gen:cornell:100 -o a.png --ranks 2 --record a.png", 2, "a.png"},
      {"compare compose gen:cornell:100 --ranks 5 --network small.json", 2, "no place for 5"},
      {"compare triangulate p.xyz --network ring", 2, "--network"},
  };
  for (const auto& one : cases) {
    const Ran ran = run("delray " + one.arguments, folder.path());
    EXPECT_EQ(ran.exit_code, one.exit_code) << one.arguments << '\n' << ran.err;
    EXPECT_NE(ran.err.find(one.why), std::string::npos) << one.arguments << '\n' << ran.err;
  }
  EXPECT_EQ(folder.files(), (std::vector<std::string>{"bad.json", "l.json", "ring.json",
                                                      "small.json", "stuck.json"}));
}

TEST(Replay, ComparisonsTellOfTheNetworksThatWereAskedFor) {
  const Folder folder;
  folder.write("own.json", kRing);
  const Ran ran =
      run("delray compare compose gen:cornell:100 --size 24x24 --ranks 8 --quick --compose tree "
          "pipeline "
          "--network own.json,tree,ring --stats -",
          folder.path());
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const Json outcome = Json::parse(ran.out);
  for (const Json& row : outcome["rows"]) {
    std::set<std::string> networks;
    for (const Json& predicted : row["predicted"])
      networks.insert(predicted["network"].get<std::string>());
    EXPECT_EQ(networks, (std::set<std::string>{"own", "tree", "ring", "this-machine"}));
  }
  // own.json has links of its own: nothing to compare with.
  ASSERT_EQ(outcome["own_networks"].size(), 2U);
  for (const Json& one : outcome["own_networks"])
    EXPECT_EQ(one["network"], one["scheme"] == "tree" ? "tree" : "ring");
}

}  // namespace
}  // namespace delray::tests
