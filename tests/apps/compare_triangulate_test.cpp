// delray compare triangulate: the built program, and the JSON that scripts rely on.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "delaunay/distributed.h"
#include "delaunay/methods.h"
#include "tests/support/run_program.h"

namespace delray::tests {
namespace {

using Json = nlohmann::json;

void generate(const Folder& folder, const std::string& arguments) {
  const Ran ran = run("delray generate points " + arguments + " -q", folder.path());
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
}

std::string hash_of(const Folder& folder, const std::string& arguments) {
  const Ran ran = run("delray triangulate " + arguments + " --stats - -q", folder.path());
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  return Json::parse(ran.out)["result"]["hash"];
}

// What every row promises, whatever was compared.
void check_rows(const Json& json, int dim, const std::set<int>& threads) {
  std::map<std::size_t, std::set<std::string>> hashes, methods;
  for (const Json& row : json["rows"]) {
    SCOPED_TRACE(row.dump());
    const int own_threads = row["threads"];
    hashes[row["points"]].insert(row["hash"].get<std::string>());
    methods[row["points"]].insert(row["method"].get<std::string>());
    std::uint64_t made = 0;
    for (const Json& count : row["simplices_by_thread"]) made += count.get<std::uint64_t>();
    EXPECT_EQ(row["simplices_by_thread"].size(), own_threads);
    EXPECT_EQ(made, row["simplices"]);
    EXPECT_GE(row["sync"]["fragments"], 1);
    EXPECT_LE(row["distinct"], row["points"]);
    EXPECT_GT(row["spread"]["triangulate"]["least"], 0);
    EXPECT_LE(row["spread"]["triangulate"]["least"], row["seconds"]["triangulate"]);
    EXPECT_GE(row["spread"]["triangulate"]["most"], row["seconds"]["triangulate"]);
    EXPECT_GE(row["spread"]["triangulate"]["runs"], 1);
    EXPECT_DOUBLE_EQ(row["efficiency"], row["speed_up"].get<double>() / own_threads);
    if (own_threads == 1) {
      EXPECT_EQ(row["sync"]["fragments"], 1);
      EXPECT_EQ(row["speed_up"], 1);
    } else {
      EXPECT_TRUE(threads.count(own_threads));
    }
    const auto& table = delaunay::methods();
    const auto method = std::find_if(table.begin(), table.end(),
                                     [&](const auto& m) { return m.name == row["method"]; });
    ASSERT_NE(method, table.end());
    EXPECT_TRUE(std::count(method->dims.begin(), method->dims.end(), dim));
  }
  for (const auto& [points, of_points] : hashes) EXPECT_EQ(of_points.size(), 1U) << points;
  std::set<std::string> expected;
  for (const delaunay::Method& method : delaunay::methods())
    if (std::count(method.dims.begin(), method.dims.end(), dim)) expected.emplace(method.name);
  for (const auto& [points, of_points] : methods) EXPECT_EQ(of_points, expected) << points;
}

TEST(CompareTriangulate, TellsOfEveryMethodWhatTheInterfaceSays) {
  const Folder folder;
  generate(folder, "cluster -n 1000 --dim 2 -o plane.xyz");
  const Ran ran =
      run("delray compare triangulate --quick --stats - -o report.html --threads 3,1,3 plane.xyz",
          folder.path());
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const Json json = Json::parse(ran.out);
  EXPECT_EQ(json["schema"], "delray.compare.triangulate/1");
  EXPECT_EQ(json["input"]["dim"], 2);
  EXPECT_EQ(json["options"]["threads"], Json({1, 3}));
  EXPECT_EQ(json["unfinished"], false);
  check_rows(json, 2, {3});
  std::set<std::size_t> sizes;
  std::set<std::string> splits;
  for (const Json& row : json["rows"]) {
    sizes.insert(row["points"].get<std::size_t>());
    if (row["method"] == "optimistic") splits.insert(row["split"].get<std::string>());
    // One thread makes what the others located.
    if (row["method"] == "batch") {
      EXPECT_EQ(row["simplices_by_thread"][0], row["simplices"]);
    }
    // Regions are locked only where there are several.
    if (row["method"] == "chrisochoides") continue;
    const std::set<std::string> lock = {"optimistic", "burglary", "circumcircle"};
    EXPECT_EQ(row["sync"]["free"] > 0, lock.contains(row["method"])) << row["method"];
  }
  EXPECT_EQ(sizes, (std::set<std::size_t>{125, 250, 500, 1000}));
  EXPECT_EQ(splits.size(), delaunay::splits().size());
  EXPECT_EQ(json["rows"].back()["hash"], hash_of(folder, "plane.xyz --dim 2"));
  const std::string page = folder.read("report.html");
  for (const char* part : {"Use <strong>", "That is <code>delray triangulate", "(measured, ",
                           "(counted; hash ", "Speed-up", "Phases", "MA/N",
                           "data:image/png;base64,", "fragments (counted)", "thread 2"}) {
    EXPECT_NE(page.find(part), std::string::npos) << part;
  }
}

TEST(CompareTriangulate, WithRanksComparesDistributedMethods) {
  const Folder folder;
  generate(folder, "uniform -n 400 --dim 2 -o plane.xyz");
  const Ran ran =
      run("delray compare triangulate --quick --stats - -o report.html --ranks 3,1,2 plane.xyz",
          folder.path());
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const Json json = Json::parse(ran.out);
  EXPECT_EQ(json["schema"], "delray.compare.distributed/1");
  EXPECT_EQ(json["options"]["ranks"], Json({1, 2, 3}));
  std::map<std::string, std::set<int>> ranks;
  const std::string hash = hash_of(folder, "plane.xyz --dim 2");
  for (const Json& row : json["rows"]) {
    SCOPED_TRACE(row.dump());
    if (row["points"] != 400) continue;
    ranks[row["method"]].insert(row["ranks"].get<int>());
    EXPECT_EQ(row["hash"], hash);
    EXPECT_EQ(row["predicted"].size(), 4U);
    for (const Json& one : row["predicted"]) EXPECT_GT(one["seconds"], 0);
    EXPECT_EQ(row["messages"] > 0, row["ranks"] > 1);
    EXPECT_EQ(row["bytes"] > 0, row["ranks"] > 1);
  }
  for (const std::string_view name : delaunay::distributed_methods_for(2)) {
    EXPECT_EQ(ranks[std::string(name)], (std::set<int>{1, 2, 3})) << name;
  }
  const std::string page = folder.read("report.html");
  for (const char* part : {"Messages of all ranks", "square root of the points", "(predicted)",
                           "All methods give the same simplices"}) {
    EXPECT_NE(page.find(part), std::string::npos) << part;
  }
  for (const char* more : {"--ranks 2 --threads 1", "--distributed tiles",
                           "--ranks 2 --method cavity", "--dim 3 --ranks 2 --distributed chen"}) {
    EXPECT_EQ(
        run(std::string("delray compare triangulate plane.xyz ") + more, folder.path()).exit_code,
        2)
        << more;
  }
}

TEST(CompareTriangulate, TakesPointsWithAZForPointsInSpaceUnlessTold) {
  const Folder folder;
  generate(folder, "gauss -n 300 --dim 3 -o space.xyz");
  for (const int dim : {3, 2}) {
    const Ran ran = run("delray compare triangulate space.xyz --threads 2 --quick --stats f.json" +
                            std::string(dim == 2 ? " --dim 2" : ""),
                        folder.path());
    ASSERT_EQ(ran.exit_code, 0) << ran.err;
    EXPECT_NE(ran.out.find("optimistic, slabs"), std::string::npos) << ran.out;
    const Json json = Json::parse(folder.read("f.json"));
    EXPECT_EQ(json["input"]["dim"], dim);
    EXPECT_EQ(json["rows"].back()["hash"],
              hash_of(folder, "space.xyz --dim " + std::to_string(dim)));
    // Nobody measured one thread of these.
    const std::set<std::string> alone = {"insertion", "bowyer-watson", "gift-wrapping", "quickhull",
                                         "sweep"};
    for (const Json& row : json["rows"])
      EXPECT_EQ(row["speed_up"].is_null(), !alone.contains(row["method"]));
  }
}

TEST(CompareTriangulate, ComparesOnEachInput) {
  const Folder folder;
  generate(folder, "uniform -n 120 --dim 2 -o uniform.xyz");
  generate(folder, "gauss -n 130 --dim 2 -o gauss.xyz");
  const std::string arguments =
      "delray compare triangulate uniform.xyz gauss.xyz --dim 2 --quick --threads 1,2 --method "
      "spielman,batch,optimistic";
  const Ran ran = run(arguments + " --each --stats f.json -o report.html", folder.path());
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const Json json = Json::parse(folder.read("f.json"));
  ASSERT_EQ(json["inputs"].size(), 2U);
  EXPECT_EQ(json["rows"], json["inputs"][0]["rows"]);
  EXPECT_EQ(json["inputs"][0]["input"]["points"], 120);
  EXPECT_EQ(json["inputs"][1]["input"]["file"], "gauss.xyz");
  EXPECT_EQ(json["inputs"][0]["rows"].back()["hash"], hash_of(folder, "uniform.xyz --dim 2"));
  EXPECT_EQ(json["inputs"][1]["rows"].back()["hash"], hash_of(folder, "gauss.xyz --dim 2"));
  const std::string page = folder.read("report.html");
  for (const char* part :
       {"spielman, efficiency", "gauss.xyz", "and 1 more inputs", "law makes of it",
        "The queue of the batch method", "optimistic, priorities",
        "Atomic instructions against mutexes", "optimistic, striped", "Unlocking early"}) {
    EXPECT_NE(page.find(part), std::string::npos) << part;
  }
  const Ran as_one = run(arguments + " --stats -", folder.path());
  EXPECT_EQ(Json::parse(as_one.out)["input"]["points"], 250);
  EXPECT_EQ(run(arguments + " --each --ranks 2", folder.path()).exit_code, 2);
}

TEST(CompareTriangulate, LivesWithFewPointsAndFlatOnes) {
  const Folder folder;
  folder.write("three.xyz", "0 0\n1 0\n0 1\n");
  folder.write("line.xyz", "0 0\n1 1\n2 2\n3 3\n");
  for (const std::string name : {"three", "line"}) {
    const Ran ran = run("delray compare triangulate " + name +
                            ".xyz --threads 1,2 --quick --stats - -o report.html",
                        folder.path());
    ASSERT_EQ(ran.exit_code, 0) << ran.err;
    const Json json = Json::parse(ran.out);
    for (const Json& row : json["rows"]) {
      EXPECT_EQ(row["simplices"], name == "three" ? 1 : 0) << row.dump();
      EXPECT_EQ(row["sync"]["fragments"], row["simplices"]) << row.dump();
    }
    const std::string page = folder.read("report.html");
    for (const char* no_number : {"\"nan", " nan", "\"-nan", "\"inf", " inf", "Lnan", "Mnan"}) {
      EXPECT_EQ(page.find(no_number), std::string::npos) << no_number;
    }
  }
}

// By --stats and on the page; on points that take no time.
TEST(CompareTriangulate, TellsWhichMethodsAreMissing) {
  const Folder folder;
  std::string equal;
  for (int row = 0; row < 20'001; ++row) equal += "1 1\n";
  folder.write("equal.xyz", equal);
  const Ran ran =
      run("delray compare triangulate equal.xyz --threads 1 --quick -q -o report.html --stats -",
          folder.path());
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const Json json = Json::parse(ran.out);
  const std::string page = folder.read("report.html");
  std::set<std::string> run;
  for (const Json& row : json["rows"]) run.insert(row["method"].get<std::string>());
  std::size_t missing = 0;
  for (const delaunay::Method& method : delaunay::methods()) {
    if (std::count(method.dims.begin(), method.dims.end(), 2) == 0) continue;
    if (run.count(std::string(method.name)) != 0) continue;
    const std::string told = std::string(method.name) + " (slow above 20000 points)";
    EXPECT_EQ(json["left_out"][missing++], told);
    EXPECT_NE(page.find(told), std::string::npos) << told;
  }
  EXPECT_GT(missing, 0U);
  EXPECT_EQ(json["left_out"].size(), missing);
}

TEST(CompareTriangulate, RefusesWhatItCannotDo) {
  const Folder folder;
  folder.write("p.xyz", "0 0\n1 0\n0 1\n");
  for (const std::string arguments :
       {"", "p.xyz --method nothing", "p.xyz --dim 3", "p.xyz --method cavity",
        "p.xyz -o report.png", "p.xyz --terrain-rgb"}) {
    const Ran ran = run("delray compare triangulate " + arguments, folder.path());
    EXPECT_EQ(ran.exit_code, 2) << arguments << ran.err;
    EXPECT_EQ(ran.out, "");
  }
  EXPECT_EQ(run("delray compare triangulate missing.xyz", folder.path()).exit_code, 3);
  const Ran list = run("delray compare triangulate --list", folder.path());
  EXPECT_NE(list.out.find("circumcircle\t"), std::string::npos);
}

}  // namespace
}  // namespace delray::tests
