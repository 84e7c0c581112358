// delray compare partition: the built program, and the JSON that scripts rely on.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "loadbalance/partition.h"
#include "raster/strategies.h"
#include "tests/support/run_program.h"

namespace delray::tests {
namespace {

using Json = nlohmann::json;

Json render(const Folder& folder, const std::string& scene_and_options) {
  const Ran ran =
      run("delray render " + scene_and_options + " -o a.png --stats - -q", folder.path());
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  return Json::parse(ran.out);
}

void check_frames(const Json& row, const std::string& hash) {
  EXPECT_GT(row["seconds"]["busiest"], 0);
  const double least = row["spread"]["busiest"]["least"], most = row["spread"]["busiest"]["most"];
  EXPECT_GE(most, least);
  EXPECT_EQ(row["spread"]["busiest"]["runs"], 3);
  EXPECT_EQ(row["spread"]["busiest"]["low"], least);
  EXPECT_EQ(row["spread"]["busiest"]["high"], most);
  EXPECT_GE(row["imbalance"], 1);
  EXPECT_GE(row["work_imbalance"], 1);
  EXPECT_GT(row["work_over_share"], 0);
  EXPECT_LE(row["triangles_max"], row["triangles_total"]);
  EXPECT_LE(row["bytes_next_frame"], row["bytes_total"]);
  EXPECT_EQ(row["image_hash"], hash);
  std::set<std::string> networks;
  for (const Json& predicted : row["predicted"]) {
    networks.insert(predicted["network"].get<std::string>());
    EXPECT_EQ(predicted["ranks"], row["ranks"]);
    EXPECT_GT(predicted["seconds"], 0);
    EXPECT_GT(predicted["first_seconds"], 0);
  }
  EXPECT_EQ(networks.size(), 4U);
}

bool differ(const Json& a, const Json& b) { return a["high"] < b["low"] || b["high"] < a["low"]; }

// Those of the rows whose time is the least, by the median, or cannot be told from it.
// Medians so close to it may be counted as equal.
std::vector<Json> least_of(const std::vector<Json>& rows, const char* time, double equal) {
  std::vector<Json> result;
  if (rows.empty()) return result;
  const Json& least = *std::min_element(
      rows.begin(), rows.end(),
      [&](const Json& a, const Json& b) { return a["seconds"][time] < b["seconds"][time]; });
  for (const Json& row : rows) {
    if (!differ(row["spread"][time], least["spread"][time]) ||
        row["seconds"][time] <= least["seconds"][time].get<double>() * equal)
      result.push_back(row);
  }
  return result;
}

// Those of the rows that the page may name, and whether processor time contradicts them: about as
// even as can be by what is counted, of these those whose busiest rank takes least processor time
// if there are any, of these those cut soonest.
struct Best {
  std::vector<std::string> names;
  bool contradicted = false;
};
Best best_of(const Json& rows, int ranks, const char* over_share) {
  std::vector<Json> all, even, both;
  for (const Json& row : rows)
    if (row["ranks"] == ranks && row["regions_per_rank"] == 1) all.push_back(row);
  double least = 1e300;
  for (const Json& row : all) least = std::min(least, row[over_share].get<double>());
  for (const Json& row : all)
    if (row[over_share] <= least * 1.05) even.push_back(row);
  const bool drawn = all[0]["seconds"]["busiest"].is_number();
  if (drawn) {
    for (const Json& row : least_of(all, "busiest", 1.05))
      if (row[over_share] <= least * 1.05) both.push_back(row);
  }
  Best best;
  best.contradicted = drawn && both.empty();
  for (const Json& row : least_of(both.empty() ? even : both, "cut", 1))
    best.names.push_back(row["partition"]);
  return best;
}

// Which partition the page says to take for so many ranks.
std::string advised(const std::string& page, int ranks) {
  const std::string before = "For " + std::to_string(ranks) + " ranks cut the screen by <strong>";
  const std::size_t at = page.find(before);
  EXPECT_NE(at, std::string::npos);
  if (at == std::string::npos) return "";
  const std::size_t begin = at + before.size();
  return page.substr(begin, page.find('<', begin) - begin);
}

double sum_of(const Json& parts) {
  double sum = 0;
  for (const Json& seconds : parts) sum += seconds.get<double>();
  return sum;
}

// Every strategy on each of so many numbers of ranks, the last of which is not timed.
void check_scaling(const Json& scaling, std::size_t numbers) {
  const std::size_t strategies = raster::strategies().size();
  ASSERT_EQ(scaling["rows"].size(), numbers * strategies);
  EXPECT_TRUE(scaling["left_out"].empty());
  for (const Json& row : scaling["rows"]) {
    SCOPED_TRACE(row.dump());
    EXPECT_EQ(row["drawing"], row["ranks"] > 64 ? "priced" : "timed");
    EXPECT_GT(row["messages"], 0);
    ASSERT_EQ(row["predicted"].size(), 4U);
    for (const Json& over : row["predicted"]) {
      for (const char* motion : {"at_rest", "turning"}) {
        const Json& frame = over[motion];
        const double seconds = frame["seconds"], alone = scaling["alone"][motion];
        EXPECT_NEAR(sum_of(frame["busiest_rank_seconds"]), seconds, 1e-9);
        EXPECT_NEAR(frame["speed_up"].get<double>(), alone / seconds, 1e-9);
        EXPECT_NEAR(frame["efficiency"].get<double>() * row["ranks"].get<double>(), alone / seconds,
                    1e-9);
      }
    }
  }
  ASSERT_EQ(scaling["stops_gaining"].size(), 4 * strategies);
  // No other number of ranks is faster by more than 5 %, and of fewer all are slower by more.
  for (const Json& limit : scaling["stops_gaining"]) {
    SCOPED_TRACE(limit.dump());
    for (const char* motion : {"at_rest", "turning"}) {
      double least = 1e300;
      const auto frames = [&](auto&& f) {
        for (const Json& row : scaling["rows"]) {
          for (const Json& over : row["predicted"])
            if (row["strategy"] == limit["strategy"] && over["network"] == limit["network"])
              f(row["ranks"].get<int>(), over[motion]["seconds"].get<double>());
        }
      };
      frames([&](int, double seconds) { least = std::min(least, seconds); });
      frames([&](int ranks, double seconds) {
        if (ranks < limit[motion]["ranks"]) {
          EXPECT_GT(seconds, 1.05 * least);
        } else if (ranks == limit[motion]["ranks"]) {
          EXPECT_LE(seconds, 1.05 * least);
        }
      });
      EXPECT_EQ(limit[motion]["grows"].is_null(), limit[motion]["ranks"] == 80);
    }
  }
}

TEST(ComparePartition, TellsOfEveryPartitionAndStrategyWhatTheInterfaceSays) {
  const Folder folder;
  const std::string scene = "gen:city:2000 --size 121x80";
  const Ran ran =
      run("delray compare partition --quick --stats - -o report.html --ranks 3,17,80 "
          "--regions 1,2 " +
              scene,
          folder.path());
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const Json json = Json::parse(ran.out);
  EXPECT_EQ(json["schema"], "delray.compare.partition/1");
  EXPECT_EQ(json["unfinished"], false);
  const Json rendered =
      render(folder, scene + " --ranks 3 --strategy sort-first --partition mahd --regions 1");
  const std::string hash = rendered["image"]["hash"];
  const std::size_t partitions = loadbalance::partitioners().size();
  ASSERT_EQ(json["rows"].size(), 4 * partitions);  // 3 ranks with 1 and 2 regions, 17, 80 ranks
  std::set<std::string> rows;
  for (const Json& row : json["rows"]) {
    SCOPED_TRACE(row.dump());
    rows.insert(row["partition"].get<std::string>() + std::to_string(row["ranks"].get<int>()) +
                std::to_string(row["regions_per_rank"].get<int>()));
    EXPECT_GE(row["overlap"], 1);
    EXPECT_GE(row["regions"], 1);
    EXPECT_GE(row["predicted_imbalance"], 1);
    EXPECT_GE(row["predicted_over_share"].get<double>(), 0.999);
    EXPECT_LE(row["primitives_shared"], row["primitives"]);
    EXPECT_GE(row["seconds"]["cut"], 0);
    if (row["ranks"] == 3 && row["partition"] == "mahd" && row["regions_per_rank"] == 1) {
      const Json& cut = rendered["raster"]["partition"];
      EXPECT_EQ(row["overlap"], cut["overlap"]);
      EXPECT_EQ(row["predicted_over_share"], cut["over_share"]);
    }
    if (row["ranks"] <= 64) {
      check_frames(row, hash);
    } else {
      EXPECT_TRUE(row["seconds"]["busiest"].is_null());
      EXPECT_TRUE(row["predicted"].empty());
    }
  }
  EXPECT_EQ(rows.size(), json["rows"].size());
  check_scaling(json["scaling"], 3);
  ASSERT_EQ(json["strategies"].size(), 2 * raster::strategies().size());
  for (const Json& row : json["strategies"]) {
    SCOPED_TRACE(row.dump());
    EXPECT_EQ(row["image_hash"], hash);
    EXPECT_EQ(row["predicted"].size(), 4U);
  }
  const std::string page = folder.read("report.html");
  for (const loadbalance::Partitioner& partitioner : loadbalance::partitioners())
    EXPECT_NE(page.find(std::string(partitioner.name) + ", by rank"), std::string::npos);
  const Best best = best_of(json["rows"], 17, "work_over_share");
  EXPECT_NE(std::find(best.names.begin(), best.names.end(), advised(page, 17)), best.names.end());
  EXPECT_EQ(best.contradicted, page.find("That contradicts what is counted") != std::string::npos);
  // What is equal is named beside it.
  EXPECT_EQ(best.names.size() > 1, page.find("</strong> (no difference to ") != std::string::npos);
}

TEST(ComparePartition, AnswersByWhatIsForetoldOfMoreRanksThanAreDrawn) {
  const Folder folder;
  const Ran ran =
      run("delray compare partition gen:city:2000 --size 121x80 --quick --stats - -o report.html "
          "--ranks 80 --regions 1",
          folder.path());
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const std::vector<std::string> best =
      best_of(Json::parse(ran.out)["rows"], 80, "predicted_over_share").names;
  const std::string page = folder.read("report.html");
  EXPECT_NE(std::find(best.begin(), best.end(), advised(page, 80)), best.end());
  EXPECT_NE(page.find("So many ranks are not drawn: their shares are predicted."),
            std::string::npos);
}

TEST(ComparePartition, CountsAlikeFromRunToRun) {
  const Folder folder;
  Json runs[2];
  for (Json& json : runs) {
    const Ran ran =
        run("delray compare partition gen:spheres:500 --size 61x47 --ranks 4 --regions 1 "
            "--partition mahd,graph --quick --stats -",
            folder.path());
    ASSERT_EQ(ran.exit_code, 0) << ran.err;
    json = Json::parse(ran.out);
    ASSERT_EQ(json["rows"].size(), 2U);
  }
  const std::set<std::string> ratios = {"overlap", "work_over_share", "image_hash"};
  for (const char* list : {"rows", "strategies"}) {
    for (std::size_t i = 0; i < runs[0][list].size(); ++i) {
      for (const auto& [key, value] : runs[0][list][i].items()) {
        if (!value.is_number_integer() && ratios.count(key) == 0) continue;
        EXPECT_EQ(runs[1][list][i][key], value) << key;
      }
    }
  }
}

TEST(ComparePartition, RefusesBezelsOfNoWall) {
  const Folder folder;
  const Ran ran = run("delray compare partition gen:cornell:100 --quick --bezel 6", folder.path());
  EXPECT_EQ(ran.exit_code, 2);
  EXPECT_EQ(ran.err, "error: --bezel has no effect with no --wall\n");
}

// 12 displays of 60 x 40 pixels: rank 0 would be sent all but its own.
TEST(ComparePartition, CountsPixelsOnTheirWayToAWall) {
  const Folder folder;
  const Ran ran =
      run("delray compare partition gen:spheres:500 --wall 4x3 --size 60x40 --bezel 6x4 "
          "--ranks 3,12 --regions 1 --partition mahd,interlaced --quick -o wall.html "
          "--stats wall.json -q",
          folder.path());
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const Json json = Json::parse(folder.read("wall.json"));
  ASSERT_EQ(json["wall"]["by_ranks"].size(), 2U);
  for (const Json& row : json["wall"]["by_ranks"]) {
    const int ranks = row["ranks"];
    EXPECT_EQ(row["gathered_pixels_busiest"], 60 * 40 * (12 - 12 / ranks));
    EXPECT_GE(row["at_home"]["predicted_over_share"], 1.0);
  }
  for (const Json& row : json["rows"]) {
    EXPECT_GT(row["to_displays"]["pixels"], 0);
    EXPECT_GE(row["to_displays"]["pixels"], row["to_displays"]["pixels_busiest"]);
  }
  EXPECT_NE(folder.read("wall.html").find("busiest rank sends and receives"), std::string::npos);
}

TEST(ComparePartition, RefusesWhatItCannotDo) {
  const Folder folder;
  for (const std::string arguments :
       {"", "gen:spheres --ranks 2,x", "gen:spheres --partition nothing", "gen:spheres --regions 0",
        "gen:spheres --threads 2", "gen:spheres -o report.png"}) {
    const Ran ran = run("delray compare partition " + arguments, folder.path());
    EXPECT_EQ(ran.exit_code, 2) << arguments << ran.err;
    EXPECT_EQ(ran.out, "");
  }
  EXPECT_EQ(run(mpirun(2) + "delray compare partition gen:spheres", folder.path()).exit_code, 2);
}

TEST(ComparePartition, ListsPartitionsStrategiesAndNetworks) {
  const Folder folder;
  const Ran ran = run("delray compare partition --list", folder.path());
  EXPECT_EQ(ran.exit_code, 0);
  for (const char* name : {"mahd\t", "sort-middle\t", "hdr-infiniband\t"})
    EXPECT_NE(ran.out.find(name), std::string::npos) << name;
}

}  // namespace
}  // namespace delray::tests
