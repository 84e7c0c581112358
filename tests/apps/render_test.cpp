// delray render as a user runs it: one picture however the work is shared out.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "raster/strategies.h"
#include "raytrace/distribution.h"
#include "scenes/generate.h"
#include "scenes/write_glb.h"
#include "tests/support/run_program.h"

namespace delray::tests {
namespace {

using nlohmann::json;

// The statistics of a rendering that must succeed.
json statistics(const std::string& command, const Folder& folder) {
  const Ran ran = run(command + " --stats stats.json -q", folder.path());
  EXPECT_EQ(ran.exit_code, 0) << command << "\n" << ran.err;
  return json::parse(folder.read("stats.json"));
}

TEST(RenderCommand, OnePictureForEveryStrategyRankCountAndThreadCount) {
  const Folder folder;
  const std::string base = "delray render gen:city:4000 -o a.png --size 161x97 ";
  const std::string hash = statistics(base, folder)["image"]["hash"];
  const std::string bytes = folder.read("a.png");
  for (const std::string options :
       {"--ranks 3", "--ranks 4 --threads 2", "--strategy sort-first --ranks 3",
        "--strategy sort-first --partition interlaced --ranks 5 --threads 1",
        "--strategy sort-last --compose centralized --ranks 2 --threads 3",
        "--frames 2 --ranks 2"}) {
    EXPECT_EQ(statistics(base + options, folder)["image"]["hash"], hash) << options;
  }
  for (const std::string options :
       {"--strategy sort-last --compose binary-swap", "--strategy sort-first --threads 2"}) {
    EXPECT_EQ(statistics(mpirun(4) + base + options, folder)["image"]["hash"], hash) << options;
  }
  EXPECT_EQ(folder.read("a.png"), bytes);
}

TEST(RenderCommand, RayTracerGivesOnePictureToo) {
  const Folder folder;
  const std::string base =
      "delray render gen:spheres:3000 -o a.png --size 95x61 --engine raytrace --spp 2 ";
  const std::string hash = statistics(base + "--threads 1", folder)["image"]["hash"];
  EXPECT_EQ(statistics(base + "--ranks 3 --threads 2", folder)["image"]["hash"], hash);
  EXPECT_EQ(statistics(mpirun(4) + base, folder)["image"]["hash"], hash);
  EXPECT_EQ(statistics(mpirun(4) + base + "--data ray", folder)["image"]["hash"], hash);
  for (const std::string options :
       {"--ranks 4 --schedule demand --block 32",
        "--ranks 3 --schedule stealing --partition mahd --costs measured --frames 2",
        "--ranks 2 --threads 2 --schedule guided",
        "--ranks 3 --data ray --deal random --schedule demand", "--ranks 2 --data ring",
        "--ranks 4 --data object --cache 0.1", "--ranks 2 --data hybrid --frames 2"}) {
    const json stats = statistics(base + options, folder);
    EXPECT_EQ(stats["image"]["hash"], hash) << options;
    EXPECT_EQ(stats["raytrace"].contains("partition"),
              options.find("--partition") != std::string::npos);
    std::uint64_t tasks = 0, rays = 0;
    for (const json& rank : stats["ranks"]) {
      tasks += rank["tasks"].get<std::uint64_t>();
      rays += rank["rays"]["primary"].get<std::uint64_t>();
      EXPECT_TRUE(rank["requests"].is_number());
      for (const json& interval : rank["timeline"]) EXPECT_GE(interval["end"], interval["begin"]);
    }
    EXPECT_EQ(tasks, options.find("--block") != std::string::npos ? 6U : 24U);
    EXPECT_EQ(rays, stats["rays"]["primary"].get<std::uint64_t>());
  }
}

TEST(RenderCommand, AMasterThatServesHandsEverythingOut) {
  const Folder folder;
  const std::string base = "delray render gen:spheres:3000 -o a.png --size 95x61 ";
  for (const std::string engine : {"--strategy sort-first ", "--engine raytrace "}) {
    const std::string hash = statistics(base + engine, folder)["image"]["hash"];
    for (const std::string schedule : {"demand", "guided", "hierarchical"}) {
      const std::string command =
          base + engine + "--ranks 3 --block 16 --master serves --schedule " + schedule;
      const json stats = statistics(command, folder);
      EXPECT_EQ(stats["image"]["hash"], hash) << command;
      EXPECT_EQ(stats["ranks"][0]["tasks"], 0) << command;
      EXPECT_EQ(stats["ranks"][1]["tasks"].get<int>() + stats["ranks"][2]["tasks"].get<int>(), 24)
          << command;
    }
  }
  EXPECT_EQ(run(base + "--engine raytrace --master serves", folder.path()).exit_code, 2);
  EXPECT_EQ(run(base + "--master serves", folder.path()).exit_code, 2);
}

TEST(RenderCommand, AnimationsWriteEveryFrameHoweverTheWorkIsShared) {
  const Folder folder;
  folder.write("path.txt", "0,1,4, 0,1,0, 0,1,0, 40 # frame 0\n3: 1,1,3.5, 0,1,0, 0,1,0, 45\n");
  const std::string base = "delray render gen:cornell -o a.png --size 48x32 ";
  for (const std::string options : {"--camera-path path.txt", "--turntable 4"}) {
    const json stats = statistics(base + options, folder);
    EXPECT_EQ(stats["animation"]["frames"], 4) << options;
    EXPECT_EQ(stats["animation"]["stages"].size(), 4U);
    EXPECT_GT(stats["animation"]["predicted_speed_up"], 0);
    std::set<std::string> pictures;
    for (const char* name : {"a-0000.png", "a-0001.png", "a-0002.png", "a-0003.png"}) {
      EXPECT_TRUE(pictures.insert(folder.read(name)).second) << name;
    }
    const std::string hash = stats["image"]["hash"];
    for (const std::string how : {"--ranks 3", "--ranks 2 --threads 2", "--frames-at-once 1",
                                  "--threads 3 --frames-at-once 6"}) {
      EXPECT_EQ(statistics(base + options + " " + how, folder)["image"]["hash"], hash) << how;
    }
    EXPECT_EQ(statistics(mpirun(4) + base + options, folder)["image"]["hash"], hash);
  }
  // The last key is a single picture.
  EXPECT_EQ(statistics(base + "--camera-path path.txt", folder)["image"]["hash"],
            statistics(base + "--camera 1,1,3.5,0,1,0,0,1,0,45", folder)["image"]["hash"]);
}

TEST(RenderCommand, FramesOfAMovingSceneAreItsPosesHoweverTheWorkIsShared) {
  const Folder folder;
  scenes::write_glb(folder.path() / "flag.glb", scenes::generate("gen:cloth:400"));
  const std::string base = "delray render flag.glb -o a.png --size 48x32 ";
  for (const std::string engine : {"--engine raster ", "--engine raytrace "}) {
    const json still = statistics(base + engine + "--pose-time 0.75", folder);
    EXPECT_NE(still["image"]["hash"], statistics(base + engine, folder)["image"]["hash"]);
    const bool rays = engine == "--engine raytrace ";
    for (const std::string& how :
         {std::string("--ranks 1"), std::string(rays ? "--data object --ranks 2" : "--ranks 3"),
          std::string(rays ? "--ranks 2" : "--strategy sort-first --ranks 3")}) {
      const json stats = statistics(base + engine + "--animate 0:1:4 " + how, folder);
      EXPECT_EQ(stats["image"]["hash"], still["image"]["hash"]) << engine << how;
      EXPECT_EQ(stats["animation"]["frames"], 4);
      EXPECT_EQ(stats["animation"]["motion"].size(), 4U);
      EXPECT_EQ(stats["animation"]["motion"][3]["seconds"], 0.75);
      EXPECT_EQ(stats["animation"]["motion"][3]["meshes"], 1);
    }
  }
  const Ran info = run("delray info flag.glb", folder.path());
  EXPECT_NE(info.out.find(R"({"name":"wave","seconds":2.0,"channels":1})"), std::string::npos)
      << info.out;
  EXPECT_EQ(statistics(base + "--animation wave --pose-time 9", folder)["image"]["hash"],
            statistics(base + "--animation 0 --pose-time 2", folder)["image"]["hash"]);
  for (const std::string wrong :
       {"--animate 0:1", "--animate 1:0:5", "--animate 0:1:0", "--pose-time soon",
        "--animation walk --pose-time 1", "--animation wave", "--animate 0:1:2 --turntable 3"}) {
    EXPECT_EQ(run(base + wrong, folder.path()).exit_code, 2) << wrong;
  }
  EXPECT_EQ(run("delray render gen:cornell -o a.png --pose-time 1", folder.path()).exit_code, 2);
}

TEST(RenderCommand, ReuseTracesAPartOfATurntable) {
  const Folder folder;
  const std::string base =
      "delray render gen:cornell:100 -o a.png --size 48x32 --engine raytrace --turntable 60 ";
  const auto rays = [&](const std::string& how) {
    return statistics(base + how, folder)["animation"]["rays"]["primary"].get<double>();
  };
  // The first frame is traced as a whole, a quarter of the others, and what comes into sight.
  const double all = rays(""), part = rays("--reuse 0.25 ");
  EXPECT_GE(part, all / 60 + 0.25 * all * 59 / 60);
  EXPECT_LT(part, 0.6 * all);
  for (const std::string how : {"--ranks 2", "--data object --ranks 2"})
    EXPECT_EQ(rays("--reuse 0.25 " + how), part) << how;
  EXPECT_EQ(run(base + "--reuse 0.25 --spp 4", folder.path()).exit_code, 2);
}

TEST(RenderCommand, CamerasOfTheSceneByNameAndNumber) {
  const Folder folder;
  scenes::Scene scene = scenes::generate("gen:cornell:100");
  scene.cameras[0].name = "front door";
  scenes::Camera plan = scene.cameras[0];
  plan.name = "plan";
  plan.height = 3;
  scene.cameras.push_back(plan);
  scenes::write_glb(folder.path() / "a.glb", scene);
  const std::string base = "delray render a.glb -o a.png --size 48x32 ";
  const std::string first = statistics(base, folder)["image"]["hash"];
  const std::string second = statistics(base + "--camera plan", folder)["image"]["hash"];
  EXPECT_NE(first, second);
  EXPECT_EQ(statistics(base + "--camera 'front door'", folder)["image"]["hash"], first);
  EXPECT_EQ(statistics(base + "--camera 1", folder)["image"]["hash"], first);
  EXPECT_EQ(statistics(base + "--camera 2", folder)["image"]["hash"], second);
  EXPECT_EQ(statistics(base + "--camera plan --ranks 3", folder)["image"]["hash"], second);
  EXPECT_EQ(statistics(base + "--camera plan", folder)["camera"]["height"], 3);
  const std::string traced =
      statistics(base + "--camera plan --engine raytrace", folder)["image"]["hash"];
  EXPECT_EQ(statistics(base + "--camera plan --engine raytrace --ranks 2", folder)["image"]["hash"],
            traced);
  for (const char* camera : {"door", "0", "3", "-1"}) {
    const auto refused = run(base + "--camera=" + std::string(camera), folder.path());
    EXPECT_EQ(refused.exit_code, 2) << camera;
    EXPECT_NE(refused.err.find("1 'front door', 2 'plan'"), std::string::npos) << refused.err;
  }
}

TEST(RenderCommand, AClipIsOnePictureHoweverTheWorkIsShared) {
  const Folder folder;
  const std::string size = "delray render gen:city:4000 -o a.png --size 121x77 ";
  // From above: all that reaches higher than 15 is cut off.
  const std::string base = size + "--camera 0,200,0,0,0,0,0,0,1,60 ";
  const std::string rays = "--engine raytrace --integrator direct ";
  std::map<std::string, std::string> hashes;  // of what is cut, by engine
  for (const std::string& engine : {std::string(), rays}) {
    const std::string whole = statistics(base + engine, folder)["image"]["hash"];
    const json cut = statistics(base + engine + "--clip 185", folder);
    hashes[engine] = cut["image"]["hash"];
    EXPECT_EQ(cut["options"]["clip"], 185);
    EXPECT_NE(hashes[engine], whole);
    EXPECT_EQ(statistics(base + engine + "--clip 1e-3", folder)["image"]["hash"], whole);
    EXPECT_EQ(statistics(base + engine + "--clip 185 --ranks 3", folder)["image"]["hash"],
              hashes[engine]);
  }
  const auto is_same = [&](const std::string& engine, const std::string& option) {
    EXPECT_EQ(statistics(base + engine + option + " --ranks 2 --threads 1 --clip 185",
                         folder)["image"]["hash"],
              hashes[engine])
        << option;
  };
  for (const raster::Strategy& strategy : raster::strategies())
    is_same("", "--strategy " + std::string(strategy.name));
  for (const raytrace::Distribution& data : raytrace::distributions())
    is_same(rays, "--data " + std::string(data.name));
  EXPECT_EQ(run(size + "--clip 0", folder.path()).exit_code, 2);
  EXPECT_EQ(run(size + "--clip -1", folder.path()).exit_code, 2);
}

TEST(RenderCommand, TellsTheCameraAsItCanBeGiven) {
  const Folder folder;
  const std::string base = "delray render gen:spheres:500 -o a.png --size 48x32 ";
  const json told = statistics(base + "--view iso", folder);
  std::string camera;
  for (const char* key : {"eye", "at", "up"}) {
    for (const json& number : told["camera"][key]) camera += number.dump() + ",";
  }
  camera += told["camera"]["fov"].dump();
  EXPECT_EQ(statistics(base + "--camera=" + std::string(camera), folder)["image"]["hash"],
            told["image"]["hash"]);
}

TEST(RenderCommand, AnimationsTellTheirStages) {
  const Folder folder;
  const std::string base = "delray render gen:cornell -o a.png --size 48x32 --turntable 4 ";
  using Names = std::vector<std::string>;
  const Names in_steps = {"transform", "rasterize", "compose", "encode"};
  const Names whole = {"render", "encode"};
  for (const auto& [options, names] : {std::pair<std::string, Names>{"--ranks 2", in_steps},
                                       {"--strategy sort-first --ranks 2", whole},
                                       {"--engine raytrace", whole}}) {
    const json animation = statistics(base + options, folder)["animation"];
    Names found;
    double alone = 0;
    for (const json& stage : animation["stages"]) {
      found.push_back(stage["name"]);
      alone += stage["seconds_alone"].get<double>();
      EXPECT_GE(stage["seconds"], stage["seconds_alone"]);
    }
    EXPECT_EQ(found, names) << options;
    EXPECT_EQ(animation["overlapped"]["frames"], 2);
    EXPECT_NEAR(animation["sequential_seconds"], 2 * alone, 1e-9);
    EXPECT_GE(animation["predicted_speed_up"], 1.0);
  }
  // Nothing overlaps in a single frame.
  const json one =
      statistics("delray render gen:cornell -o a.png --size 48x32 --turntable 1", folder);
  EXPECT_EQ(one["animation"]["speed_up"], 1);
}

TEST(RenderCommand, AnimationsEndWhenAFrameCannotBeWritten) {
  const Folder folder;
  // A folder where the third frame should go.
  std::filesystem::create_directory(folder / "a-0002.png");
  for (const std::string how :
       {"", "--threads 3", "--ranks 3", "--strategy sort-first --ranks 2", "--engine raytrace"}) {
    const Ran ran =
        run("delray render gen:cornell -o a.png --size 48x32 --turntable 40 " + how, folder.path());
    EXPECT_EQ(ran.exit_code, 1) << how << "\n" << ran.err;
    EXPECT_NE(ran.err.find("a-0002.png"), std::string::npos) << how << "\n" << ran.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "a-0039.png")) << how;
  }
}

TEST(RenderCommand, StatisticsHaveEveryKey) {
  const Folder folder;
  for (const std::string engine : {"raster", "raytrace"}) {
    const json stats = statistics(
        "delray render gen:cornell -o a.exr --size 64x48 --ranks 2 --frames 3 --engine " + engine,
        folder);
    EXPECT_EQ(stats["schema"], "delray.render/1");
    for (const char* key : {"file", "triangles", "vertices", "instances"}) {
      EXPECT_TRUE(stats["scene"].contains(key)) << key;
    }
    for (const char* key : {"load", "build", "frame", "frame_min", "write"}) {
      EXPECT_TRUE(stats["seconds"][key].is_number()) << key;
    }
    for (const char* key :
         {"transform", "bin", "rasterize", "trace", "shade", "redistribute", "compose", "gather"}) {
      EXPECT_TRUE(stats["phases"][key].is_number()) << key;
    }
    EXPECT_EQ(stats["image"]["width"], 64);
    EXPECT_EQ(stats["image"]["hash"].get<std::string>().size(), 32U);
    EXPECT_EQ(stats["rays"]["primary"], engine == "raster" ? 0 : 64 * 48);
    EXPECT_EQ(stats["embree"]["version"].is_string(), engine == "raytrace");
    EXPECT_GE(stats["imbalance"], 1.0);
    ASSERT_EQ(stats["ranks"].size(), 2U);
    std::uint64_t sent = 0, received = 0;
    for (const json& rank : stats["ranks"]) {
      for (const char* key : {"rank", "busy", "tasks", "steals", "bytes_sent", "bytes_received",
                              "messages", "peak_rss"}) {
        EXPECT_TRUE(rank[key].is_number()) << key;
      }
      sent += rank["bytes_sent"].get<std::uint64_t>();
      received += rank["bytes_received"].get<std::uint64_t>();
    }
    EXPECT_GT(sent, 0U);
    EXPECT_EQ(sent, received);
  }
}

TEST(RenderCommand, ProcessesTellTheirOwnMemoryAndWhatTheirPartTook) {
  const Folder folder;
  for (const std::string options : {"", "--engine raytrace --data ray"}) {
    const json stats = statistics(
        mpirun(4) + "delray render gen:terrain:100000 -o a.png --size 64x48 " + options, folder);
    std::set<std::uint64_t> peaks;
    for (const json& rank : stats["ranks"]) peaks.insert(rank["peak_rss"].get<std::uint64_t>());
    EXPECT_GT(peaks.size(), 1U) << options;
    EXPECT_GE(stats["options"]["threads"], 1) << options;
    if (options.empty()) continue;
    // No machine makes a part of the terrain, or the structures over it, any sooner.
    EXPECT_GT(stats["seconds"]["load"], 1e-4);
    EXPECT_GT(stats["seconds"]["build"], 1e-4);
  }
}

TEST(RenderCommand, CountsTrianglesWithoutArea) {
  const Folder folder;
  folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nf 1 2 3\nf 1 2 4\nf 4 2 1\n");
  for (const std::string data : {"replicated", "ray"}) {
    const json stats = statistics(
        "delray render a.obj -o a.png --size 64x48 --engine raytrace --data " + data, folder);
    EXPECT_EQ(stats["raytrace"]["degenerate"], 2) << data;
  }
}

TEST(RenderCommand, SaysAtOnceThatAFolderIsMissing) {
  const Folder folder;
  const std::string base = "delray render gen:spheres:500 --size 16x16 --engine raytrace -v ";
  for (const std::string options :
       {"-o missing/a.png", "-o a.png --stats missing/a.json", "-o a.png --checkpoint missing/a"}) {
    for (const std::string& launcher : {std::string(), mpirun(2)}) {
      if (!launcher.empty() && !options.starts_with("-o missing")) continue;
      const Ran ran = run(launcher + base + options, folder.path());
      EXPECT_EQ(ran.exit_code, 1) << options << "\n" << ran.err;
      EXPECT_NE(ran.err.find("missing/a"), std::string::npos) << options << "\n" << ran.err;
      EXPECT_TRUE(folder.files().empty()) << options;
    }
  }
}

TEST(RenderCommand, BlendsByCellOfSpaceWithSortLastAlone) {
  const Folder folder;
  const std::string base = "delray render gen:city:2000 -o a.png --size 80x60 --blend by-cell ";
  const json one = statistics(base + "--ranks 1", folder);
  EXPECT_EQ(one["options"]["blend"], "by-cell");
  // Nothing is transparent, so that nothing is rounded.
  EXPECT_EQ(statistics(base + "--ranks 5", folder)["image"]["hash"], one["image"]["hash"]);
  for (const std::string other : {"--strategy hybrid", "--shade composited", "--engine raytrace"}) {
    EXPECT_EQ(run(base + other, folder.path()).exit_code, 2) << other;
  }
}

TEST(RenderCommand, PointsBecomeAReliefInOneCommand) {
  const Folder folder;
  std::string rows;
  for (int y = 0; y < 20; ++y) {
    for (int x = 0; x < 20; ++x) {
      rows += std::to_string(500000 + x) + " " + std::to_string(4000000 + y) + " " +
              std::to_string((x * y) % 7) + "\n";
    }
  }
  folder.write("p.xyz", rows);
  for (const std::string options : {"", "--color-by z", "--color-by simplex", "--view top"}) {
    const json stats = statistics("delray render p.xyz -o a.png --size 64x64 " + options, folder);
    EXPECT_EQ(stats["scene"]["triangles"], 2 * 19 * 19) << options;
  }
  ASSERT_EQ(run("delray triangulate p.xyz -o m.ply -q", folder.path()).exit_code, 0);
  EXPECT_EQ(statistics("delray render m.ply -o b.png --size 64x64", folder)["image"]["hash"],
            statistics("delray render p.xyz -o a.png --size 64x64", folder)["image"]["hash"]);
}

TEST(RenderCommand, WarningsNameTheFileOnce) {
  const Folder folder;
  folder.write("edge.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2\n");
  const Ran ran = run("delray render edge.obj -o edge.png --size 16x16", folder.path());
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_NE(ran.err.find("warning: edge.obj: 1 faces of fewer than 3 corners"), std::string::npos)
      << ran.err;
}

TEST(RenderCommand, GlbRendersLikeTheGeneratedScene) {
  const Folder folder;
  ASSERT_EQ(run("delray generate scene spheres -n 2000 -o s.glb", folder.path()).exit_code, 0);
  EXPECT_EQ(
      statistics("delray render s.glb -o a.png --size 80x60", folder)["image"]["hash"],
      statistics("delray render gen:spheres:2000 -o b.png --size 80x60", folder)["image"]["hash"]);
}

TEST(RenderCommand, APictureOfNothingSaysSo) {
  const Folder folder;
  folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  for (const std::string engine : {"raster", "raytrace"}) {
    const std::string render = "delray render a.obj -o a.png --size 40x30 --engine " + engine;
    const std::string warning = "warning: a.obj: nothing of the scene is in view";
    EXPECT_EQ(run(render, folder.path()).err.find(warning), std::string::npos);
    const Ran away = run(render + " --camera 0,0,5,0,0,9,0,1,0,45", folder.path());
    EXPECT_EQ(away.exit_code, 0);
    EXPECT_NE(away.err.find(warning), std::string::npos) << away.err;
  }
  folder.write("path.txt", "0,0,5,0,0,0,0,1,0,45\n0,0,5,0,0,9,0,1,0,45\n");
  const Ran path =
      run("delray render a.obj -o f.png --size 40x30 --camera-path path.txt", folder.path());
  EXPECT_NE(path.err.find("nothing of the scene is in view in 1 of 2 frames"), std::string::npos)
      << path.err;
  EXPECT_EQ(
      run("delray render a.obj -o a.png --camera 0,0,0,0,0,0,0,1,0,45", folder.path()).exit_code,
      2);
  EXPECT_EQ(
      run("delray render a.obj -o a.png --camera 0,0,5,0,0,0,0,0,0,45", folder.path()).exit_code,
      2);
}

TEST(RenderCommand, VerboseTellsMore) {
  const Folder folder;
  const std::string render = "delray render gen:spheres:500 -o a.png --size 40x30 ";
  const std::string plain = run(render, folder.path()).err;
  const std::string more = run(render + "-v", folder.path()).err;
  for (const std::string what : {"scene: ", "seconds: ", "seconds of phases: ", "rank: "}) {
    EXPECT_NE(more.find(what), std::string::npos) << more;
    EXPECT_EQ(plain.find(what), std::string::npos) << plain;
  }
}

TEST(RenderCommand, RanksUnderMpirunAreWrongUsage) {
  const Folder folder;
  EXPECT_EQ(
      run(mpirun(4) + "delray render gen:cornell -o a.png --ranks 2", folder.path()).exit_code, 2);
  EXPECT_TRUE(folder.files().empty());
}

TEST(RenderCommand, WrongUsageFoundWhileLoadingUnderMpirunIsTwo) {
  const Folder folder;
  const Ran ran =
      run(mpirun(4) + "delray render gen:cornell -o a.png --exaggeration 3", folder.path());
  EXPECT_EQ(ran.exit_code, 2) << ran.err;
  EXPECT_TRUE(folder.files().empty());
}

TEST(RenderCommand, BadInputUnderMpirunIsThreeOnAllRanks) {
  const Folder folder;
  const Ran ran = run(mpirun(4) + "delray render missing.glb -o a.png", folder.path());
  EXPECT_EQ(ran.exit_code, 3) << ran.err;
  EXPECT_NE(ran.err.find("missing.glb"), std::string::npos) << ran.err;
  EXPECT_TRUE(folder.files().empty());
}

}  // namespace
}  // namespace delray::tests
