// delray compare schedule: the built program, and the JSON that scripts rely on.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "loadbalance/schedule.h"
#include "raytrace/distribution.h"
#include "tests/support/run_program.h"

namespace delray::tests {
namespace {

using Json = nlohmann::json;

TEST(CompareSchedule, TellsOfEveryScheduleWhatTheInterfaceSays) {
  const Folder folder;
  const std::string scene = "gen:spheres:500 --size 97x65 --integrator direct";
  const Ran ran = run("delray compare schedule " + scene +
                          " --ranks 2,5,80 --tile 16 --quick --data "
                          "object,ray,hybrid,ring,voxels,packed-voxels,hybrid-by-load --stats "
                          "- -o report.html",
                      folder.path());
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const Json json = Json::parse(ran.out);
  EXPECT_EQ(json["schema"], "delray.compare.schedule/1");
  EXPECT_EQ(json["unfinished"], false);
  const Ran render =
      run("delray render " + scene + " --engine raytrace -o a.png --stats - -q", folder.path());
  ASSERT_EQ(render.exit_code, 0) << render.err;
  const Json rendered = Json::parse(render.out);
  ASSERT_EQ(json["tiles"].size(), 7U * 5);
  std::uint64_t rays = 0;
  for (const Json& tile : json["tiles"]) rays += tile[2].get<std::uint64_t>();
  EXPECT_EQ(json["alone"]["rays"], rays);
  std::uint64_t sent = 0;
  for (const auto& [kind, count] : rendered["rays"].items()) sent += count.get<std::uint64_t>();
  EXPECT_EQ(rays, sent);
  const double seconds = json["alone"]["seconds"];
  EXPECT_GT(seconds, 0);
  ASSERT_EQ(json["rows"].size(), loadbalance::schedules().size() * 3);
  std::set<std::string> rows;
  for (const Json& row : json["rows"]) {
    SCOPED_TRACE(row.dump());
    const int ranks = row["ranks"];
    rows.insert(row["schedule"].get<std::string>() + std::to_string(ranks));
    for (const char* key :
         {"requests", "steals", "tasks_stolen", "rays_stolen", "messages", "bytes_total"})
      ASSERT_TRUE(row[key].is_number_unsigned()) << key;
    EXPECT_GE(row["imbalance_rays"], 1);
    EXPECT_LE(row["imbalance_rays"], ranks * 1.0001);
    EXPECT_EQ(row["predicted"].size(), 4U);
    EXPECT_EQ(row["predicted"][0]["network"], "10-gigabit-ethernet");
    for (const Json& predicted : row["predicted"]) {
      EXPECT_GE(predicted["seconds"].get<double>() * ranks, seconds * 0.9999);
      EXPECT_GE(predicted["idle"].get<double>(), -1e-4);
      EXPECT_LT(predicted["idle"], 1);
      const double frame = predicted["frame_seconds"];
      EXPECT_GT(frame, predicted["seconds"]);
      EXPECT_NEAR(predicted["efficiency"].get<double>() * ranks, seconds / frame, 1e-9);
      double sum = 0;
      for (const Json& part : predicted["busiest_rank_seconds"]) {
        EXPECT_GE(part.get<double>(), -1e-12);
        sum += part.get<double>();
      }
      EXPECT_NEAR(sum, frame, 1e-9);
    }
    if (ranks == 2) {
      EXPECT_GT(row["seconds"]["frame"], 0);
      EXPECT_EQ(row["image_hash"], rendered["image"]["hash"]);
    }
    if (ranks == 80) {
      EXPECT_TRUE(row["traced"].is_null());
    }
  }
  EXPECT_EQ(rows.size(), json["rows"].size());
  std::set<std::string> distributions;
  for (const Json& row : json["distributions"]) {
    SCOPED_TRACE(row.dump());
    distributions.insert(row["distribution"].get<std::string>() + row["ranks"].dump());
    ASSERT_EQ(row["predicted"].size(), 3U);  // not the bus
    for (const Json& predicted : row["predicted"]) {
      const double frame = predicted["frame_seconds"];
      double sum = 0;
      for (const Json& part : predicted["busiest_rank_seconds"]) sum += part.get<double>();
      EXPECT_NEAR(sum, frame, 1e-9);
      EXPECT_GT(predicted["messages"], 0);
    }
  }
  // All but the one that leaves the whole scene on every rank, on 2 and on 5.
  EXPECT_EQ(distributions.size(), 2 * (raytrace::distributions().size() - 1));
  EXPECT_EQ(json["stops_gaining"].size(), loadbalance::schedules().size() * 4);
  for (const Json& limit : json["stops_gaining"])
    EXPECT_EQ(limit["grows"].is_null(), limit["ranks"] == 80) << limit;
  const std::string page = folder.read("report.html");
  EXPECT_NE(page.find("Who traced which tile: a colour for each of 5 ranks"), std::string::npos);
  EXPECT_NE(page.find("gen:spheres:500:1"), std::string::npos);  // with the seed
  EXPECT_NE(page.find("<dt>seed</dt><dd>1"), std::string::npos);
}

TEST(CompareSchedule, RefusesWhatItCannotDo) {
  const Folder folder;
  for (const std::string arguments :
       {"", "gen:spheres --schedule nothing", "gen:spheres --tile -1", "gen:spheres --network none",
        "gen:spheres --integrator none", "gen:spheres --data replicated",
        "gen:spheres -o report.png"}) {
    const Ran ran = run("delray compare schedule " + arguments, folder.path());
    EXPECT_EQ(ran.exit_code, 2) << arguments << ran.err;
    EXPECT_EQ(ran.out, "");
  }
}

TEST(CompareSchedule, ListsSchedulesIntegratorsAndNetworks) {
  const Folder folder;
  const Ran ran = run("delray compare schedule --list", folder.path());
  EXPECT_EQ(ran.exit_code, 0);
  for (const char* name : {"guided\t", "whitted\t", "hdr-infiniband\t"})
    EXPECT_NE(ran.out.find(name), std::string::npos) << name;
}

}  // namespace
}  // namespace delray::tests
