// delray compare: the built program, and the JSON that scripts rely on.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "composite/codec.h"
#include "composite/scheme.h"
#include "tests/support/run_program.h"

namespace delray::tests {
namespace {

using Json = nlohmann::json;

std::string hash_of_render(const Folder& folder, const std::string& scene_and_size) {
  const Ran ran = run("delray render " + scene_and_size + " -o a.png --stats - -q", folder.path());
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  return Json::parse(ran.out)["image"]["hash"];
}

TEST(CompareCompose, TellsOfEverySchemeWhatTheInterfaceSays) {
  const Folder folder;
  const std::string scene = "gen:city:3000 --size 150x101";
  const Ran ran = run("delray compare compose " + scene +
                          " --ranks 3,2,80 --codec active,bounds --interlace --quick --stats -",
                      folder.path());
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const Json json = Json::parse(ran.out);
  EXPECT_EQ(json["schema"], "delray.compare.compose/1");
  const std::string hash = hash_of_render(folder, scene);
  ASSERT_EQ(json["rows"].size(), composite::schemes().size() * 3 * 2);
  std::set<std::string> rows;
  for (const Json& row : json["rows"]) {
    const int ranks = row["ranks"];
    rows.insert(row["scheme"].get<std::string>() + row["codec"].get<std::string>() +
                std::to_string(ranks));
    SCOPED_TRACE(row.dump());
    for (const char* key : {"rounds", "bytes_total", "bytes_sent_max", "bytes_received_max",
                            "messages", "pixels_composited_total", "pixels_composited_max"}) {
      ASSERT_TRUE(row[key].is_number_unsigned()) << key;
    }
    EXPECT_GE(row["rounds"], 1);
    EXPECT_GE(row["bytes_total"], row["bytes_sent_max"]);
    EXPECT_GE(row["messages"], ranks - 1);
    EXPECT_GE(row["pixels_composited_total"], row["pixels_composited_max"]);
    std::set<std::string> networks;
    for (const Json& predicted : row["predicted"]) {
      networks.insert(predicted["network"].get<std::string>());
      EXPECT_EQ(predicted["ranks"], ranks);
      EXPECT_GT(predicted["seconds"], 0);
    }
    EXPECT_TRUE(networks.count("shared-bus") && networks.count("this-machine"));
    if (ranks <= 64) {
      EXPECT_GT(row["seconds"]["compose"], 0);
      EXPECT_GE(row["seconds"]["gather"], 0);
      EXPECT_EQ(row["image_hash"], hash);
    } else {
      EXPECT_TRUE(row["seconds"]["compose"].is_null());
      EXPECT_TRUE(row["image_hash"].is_null());
    }
  }
  EXPECT_EQ(rows.size(), json["rows"].size());
}

TEST(CompareCompose, BlendsTransparentScenesAlikeAndTakesEveryCodec) {
  const Folder folder;
  for (const std::string scene : {"gen:spheres:500", "gen:cornell"}) {
    const Ran ran = run("delray compare compose " + scene +
                            " --size 61x47 --ranks 1,4 --codec lz4,bounds --compose tree "
                            "radix-k:2 bus --quick --stats f.json -o report.html",
                        folder.path());
    ASSERT_EQ(ran.exit_code, 0) << ran.err;
    EXPECT_NE(ran.out.find("radix-k:2"), std::string::npos) << ran.out;
    const std::string hash = hash_of_render(folder, scene + " --size 61x47");
    EXPECT_NE(folder.read("report.html").find(">radix-k:2</td>"), std::string::npos);
    const Json json = Json::parse(folder.read("f.json"));
    EXPECT_GE(json["rows"].size(), 6U);
    for (const Json& row : json["rows"]) EXPECT_EQ(row["image_hash"], hash) << row.dump();
  }
}

TEST(CompareCompose, SimulatesListsOfSurfacesAsItCountsThem) {
  const Folder folder;
  folder.write("glass.mtl", "newmtl glass\nKd 0.8 0.2 0.1\nd 0.4\nnewmtl wall\nKd 0.2 0.6 0.9\n");
  std::string scene = "mtllib glass.mtl\n";
  for (int i = 0; i < 300; ++i) {
    const int x = i * 37 % 101, y = i * 59 % 97, z = i * 83 % 89;
    scene += "usemtl " + std::string(i % 3 == 0 ? "wall" : "glass");
    for (const int k : {0, 12, 25}) {
      scene += "\nv " + std::to_string(x + k % 2 * 9) + " " + std::to_string(y + k) + " " +
               std::to_string(z + k / 2);
    }
    scene += "\nf -3 -2 -1\n";
  }
  folder.write("glass.obj", scene);
  const std::string arguments = "glass.obj --size 120x80";
  const Ran ran = run("delray compare compose " + arguments +
                          " --ranks 2,64,65 --codec dense --compose tree direct-send --quick "
                          "--stats - -o report.html",
                      folder.path());
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_NE(ran.err.find("whatever --codec says"), std::string::npos) << ran.err;
  const std::string hash = hash_of_render(folder, arguments);
  const Json rows = Json::parse(ran.out)["rows"];
  ASSERT_EQ(rows.size(), 6U);
  std::map<std::string, std::vector<double>> fragments;  // by scheme, ascending ranks
  for (const Json& row : rows) {
    SCOPED_TRACE(row.dump());
    EXPECT_EQ(row["codec"], "deep");
    EXPECT_EQ(row["predicted"].size(), 5U);
    for (const Json& predicted : row["predicted"]) EXPECT_GT(predicted["seconds"], 0);
    const bool is_measured = row["ranks"] <= 64;
    EXPECT_EQ(row["image_hash"], is_measured ? Json(hash) : Json(nullptr));
    fragments[row["scheme"]].push_back(row["pixels_composited_total"]);
  }
  // What is simulated continues what is counted: a rank more makes little difference.
  for (const auto& [scheme, counts] : fragments) {
    EXPECT_NEAR(counts[2] / counts[1], 1, 0.1) << scheme;
    EXPECT_LT(counts[0], counts[1] * 0.9) << scheme;
  }
}

TEST(CompareCompose, ForetellsManyRanksUnaskedOfSchemesThatAreSoonSimulated) {
  const Folder folder;
  const std::string command =
      "delray compare compose gen:city:3000 --size 64x48 --compose tree tiles -q --quick ";
  const Ran ran = run(command + "-o report.html --stats f.json", folder.path());
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const Json json = Json::parse(folder.read("f.json"));
  std::map<std::string, int> most;
  for (const Json& row : json["rows"]) most[row["scheme"]] = row["ranks"];
  EXPECT_EQ(most["tree"], 4096);
  EXPECT_LT(most["tiles"], 4096);
  EXPECT_EQ(json["rows"].size() + json["left_out"].size(), 2 * json["options"]["ranks"].size());
  for (const Json& one : json["left_out"]) {
    EXPECT_EQ(one["scheme"], "tiles");
    EXPECT_GT(one["ranks"], most["tiles"]);
  }
  EXPECT_NE(folder.read("report.html").find("4096 ranks without tiles"), std::string::npos);
  // What is asked for is not left out, and answered although nothing is measured of it.
  const Ran asked = run(command + "--ranks 256 -o report.html --stats -", folder.path());
  ASSERT_EQ(asked.exit_code, 0) << asked.err;
  EXPECT_EQ(Json::parse(asked.out)["rows"].size(), 2U);
  EXPECT_NE(folder.read("report.html").find("On 256 ranks over "), std::string::npos);
}

// Of the text between `before` and the next paragraph's end.
std::string sentence_after(const std::string& page, const std::string& before) {
  const std::size_t at = page.find(before);
  return at == std::string::npos ? "" : page.substr(at, page.find("</p>", at) - at);
}

TEST(CompareCompose, NamesAllThatMayBeFirstAndSaysWhatIsPredicted) {
  const Folder folder;
  const Ran ran =
      run("delray compare compose gen:city:3000 --size 150x101 --ranks 1,64 --quick "
          "--compose tree bus centralized direct-send --stats - -o report.html",
          folder.path());
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  std::vector<Json> rows;
  const Json json = Json::parse(ran.out);
  for (const Json& row : json["rows"])
    if (row["ranks"] == 1) rows.push_back(row);
  const auto total = [](const Json& row) { return row["seconds"]["total"].get<double>(); };
  const Json least = *std::min_element(
      rows.begin(), rows.end(), [&](const Json& a, const Json& b) { return total(a) < total(b); });
  const std::string page = folder.read("report.html");
  // One rank has a core anywhere; for 64 there would have to be as many cores.
  const std::string here = sentence_after(page, "On 1 rank of this machine ");
  std::size_t equal = 0;
  for (const Json& row : rows) {
    SCOPED_TRACE(row.dump());
    const Json &a = row["spread"]["total"], &b = least["spread"]["total"];
    const std::string scheme = row["scheme"];
    if (a["high"] < b["low"] || b["high"] < a["low"]) continue;
    ++equal;
    EXPECT_NE(here.find(scheme), std::string::npos) << here;
  }
  EXPECT_EQ(equal > 1, here.find("there is no difference between") != std::string::npos) << here;
  EXPECT_NE(here.find(" (measured, median of 3 runs, "), std::string::npos) << here;
  if (std::thread::hardware_concurrency() >= 64) GTEST_SKIP() << "a core for each of 64 ranks";
  EXPECT_EQ(page.find("On 64 ranks of this machine"), std::string::npos);
  const std::string many = sentence_after(page, "On 64 ranks over ");
  EXPECT_NE(many.find("(predicted)"), std::string::npos) << many;
  EXPECT_NE(many.find("simulated, not measured"), std::string::npos) << many;
}

TEST(CompareCompose, RefusesWhatItCannotDo) {
  const Folder folder;
  for (const std::string arguments : {"", "gen:spheres --ranks 2,x", "gen:spheres --codec nothing",
                                      "gen:spheres --compose nothing", "gen:spheres -o report.png",
                                      "gen:city --codec lz4 --ranks 2,65"}) {
    const Ran ran = run("delray compare compose " + arguments, folder.path());
    EXPECT_EQ(ran.exit_code, 2) << arguments << ran.err;
    EXPECT_EQ(ran.out, "");
  }
  // Where nothing can be written it says so before anything is read or run.
  for (const std::string output : {"-o no/report.html", "--stats no/f.json"}) {
    for (const std::string report : {"compose", "partition", "schedule", "triangulate"}) {
      const Ran ran = run("delray compare " + report + " missing.obj " + output, folder.path());
      EXPECT_EQ(ran.exit_code, 1) << report << ran.err;
      EXPECT_NE(ran.err.find("cannot write"), std::string::npos) << ran.err;
    }
  }
}

TEST(CompareCompose, ListsSchemesCodecsAndNetworks) {
  const Folder folder;
  const Ran ran = run("delray compare compose --list", folder.path());
  EXPECT_EQ(ran.exit_code, 0);
  for (const char* name : {"tree\t", "active\t", "hdr-infiniband\t"}) {
    EXPECT_NE(ran.out.find(name), std::string::npos) << name;
  }
}

TEST(CompareCompose, MeasuresTheProcessesOfMpirun) {
  const Folder folder;
  const Ran ran =
      run(mpirun(3) + "delray compare compose gen:city:2000 --size 64x48 --quick --stats - -q",
          folder.path());
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const Json json = Json::parse(ran.out);
  ASSERT_EQ(json["rows"].size(), composite::schemes().size());
  const std::string hash = hash_of_render(folder, "gen:city:2000 --size 64x48");
  for (const Json& row : json["rows"]) {
    EXPECT_EQ(row["ranks"], 3);
    EXPECT_EQ(row["image_hash"], hash);
    EXPECT_EQ(row["predicted"].size(), 5U);
  }
}

}  // namespace
}  // namespace delray::tests
