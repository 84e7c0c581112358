// Tracers that follow a scene: the pictures of tracers that are made of each pose.
#include <gtest/gtest.h>

#include <cstring>

#include "comm/threads.h"
#include "parallel/arena.h"
#include "raytrace/render.h"
#include "raytrace/scene/refit_cost.h"
#include "scenes/generate.h"
#include "scenes/pose.h"
#include "tests/raytrace/small_scenes.h"

namespace delray::raytrace {
namespace {

image::ImageF picture(const Tracer& tracer, const scenes::Camera& camera) {
  image::ImageF image;
  comm::run_threads(1, 1, [&](comm::Communicator& communicator) {
    image = render(communicator, tracer, camera, small(48, 36)).image;
  });
  return image;
}

bool same(const image::ImageF& a, const image::ImageF& b) {
  return std::memcmp(a.colour.data(), b.colour.data(), a.pixels() * sizeof(image::RgbaF)) == 0 &&
         std::memcmp(a.depth.data(), b.depth.data(), a.pixels() * sizeof(float)) == 0;
}

TEST(MovingTracer, ShowsWhatATracerOfEachPoseShows) {
  for (const char* name : {"gen:machine:6400", "gen:cloth:600", "gen:arm:600"}) {
    scenes::Scene scene = scenes::generate(name);
    Tracer tracer = make_tracer(scene);
    image::ImageF last = picture(tracer, scene.cameras[0]);
    for (const double t : {0.3, 0.9, 1.6}) {
      follow(tracer, scene, scenes::pose(scene, {0, t}));
      image::ImageF now = picture(tracer, scene.cameras[0]);
      EXPECT_TRUE(same(now, picture(make_tracer(scene), scene.cameras[0]))) << name << " " << t;
      EXPECT_FALSE(same(now, last)) << name << " " << t;
      last = std::move(now);
    }
  }
}

TEST(MovingTracer, RanksThatShareTheSceneOutShowTheSame) {
  const parallel::AllowThreads allowed(3);
  for (const char* name : {"gen:machine:6400", "gen:cloth:600", "gen:arm:600"}) {
    scenes::Scene scene = scenes::generate(name);
    pose(scene, {0, 0.7});
    const image::ImageF alone = picture(make_tracer(scene), scene.cameras[0]);
    for (const Distribution& distribution : distributions()) {
      if (distribution.replicated) continue;
      image::ImageF image;
      comm::run_threads(3, 1, [&](comm::Communicator& communicator) {
        SharedScene mine = SharedScene::make(communicator, scene, share_options(distribution));
        Renderer renderer(mine, distribution);
        Result one = renderer.render(communicator, scene.cameras[0], small(48, 36));
        if (communicator.rank() == 0) image = std::move(one.image);
      });
      EXPECT_TRUE(same(alone, image)) << name << " " << distribution.name;
    }
  }
}

TEST(MovingTracer, KeepsWhatStandsStillAndRefitsWhileThatIsGood) {
  scenes::Scene machine = scenes::generate("gen:machine:6400");
  Tracer tracer = make_tracer(machine);
  FollowCounts counts = follow(tracer, machine, scenes::pose(machine, {0, 0.5}));
  EXPECT_EQ(counts.moved, 12U);
  EXPECT_EQ(counts.refitted + counts.built, 0U);
  EXPECT_GT(counts.top_seconds, 0);

  scenes::Scene cloth = scenes::generate("gen:cloth:600");
  for (const double limit : {1e9, 0.0}) {
    BuildOptions options;
    options.refit_limit = limit;
    Tracer of_cloth = make_tracer(cloth, options);
    counts = follow(of_cloth, cloth, scenes::pose(cloth, {0, limit > 0 ? 0.3 : 0.5}));
    EXPECT_EQ(counts.refitted, limit > 0 ? 1U : 0U);
    EXPECT_EQ(counts.built, limit > 0 ? 0U : 1U);
  }
  EXPECT_TRUE(scenes::pose(cloth, {0, 0.5}).empty());
  counts = follow(tracer, machine, scenes::pose(machine, {0, 0.5}));
  EXPECT_EQ(counts.moved + counts.refitted + counts.built, 0U);
}

TEST(RefitCost, GrowsAsNeighboursPart) {
  scenes::Scene scene = scenes::generate("gen:cloth:40000");
  const scenes::Mesh& mesh = scene.meshes[0];
  std::vector<glm::vec3> positions = mesh.positions;
  const RefitCost cost(mesh.triangles, positions);
  EXPECT_EQ(cost.growth(mesh.triangles, positions), 1);
  for (glm::vec3& p : positions) p = p * 2.0F + glm::vec3(1, 2, 3);
  EXPECT_NEAR(cost.growth(mesh.triangles, positions), 1, 1e-4);
  // Wrung: neighbours stay neighbours.
  for (glm::vec3& p : positions) {
    const float angle = 0.5F * p.x;
    p = {p.x, p.y * std::cos(angle) - p.z * std::sin(angle),
         p.y * std::sin(angle) + p.z * std::cos(angle)};
  }
  EXPECT_LT(cost.growth(mesh.triangles, positions), 2);
  // Dealt like cards: every other vertex goes elsewhere.
  for (std::size_t i = 0; i < positions.size(); ++i)
    positions[i] = mesh.positions[i] + glm::vec3(0, 0, i % 2 == 0 ? 3 : -3);
  EXPECT_GT(cost.growth(mesh.triangles, positions), 3);
  EXPECT_EQ(RefitCost({}, {}).growth({}, {}), 1);
}

}  // namespace
}  // namespace delray::raytrace
