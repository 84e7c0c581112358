#include "raytrace/render.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "parallel/arena.h"
#include "parallel/parallel_for.h"
#include "scenes/framing.h"
#include "scenes/generate.h"
#include "tests/raytrace/small_scenes.h"

namespace delray::raytrace {
namespace {

scenes::Scene showcase() {
  scenes::Scene scene = scenes::generate("gen:spheres:4000");
  scenes::complete(scene, scenes::Camera{});
  return scene;
}

scenes::Camera view_of(const scenes::Scene& scene) {
  return scene.cameras.empty() ? scenes::camera_around(scene, "default", 1.5F) : scene.cameras[0];
}

Result render_on(const Tracer& tracer, const scenes::Camera& camera, const RenderOptions& options,
                 int ranks, int threads) {
  Result result;
  comm::run_threads(ranks, threads, [&](comm::Communicator& communicator) {
    Result mine = render(communicator, tracer, camera, options);
    if (communicator.rank() == 0) {
      result = std::move(mine);
    } else {
      EXPECT_EQ(mine.image.pixels(), 0U);
    }
  });
  return result;
}

void expect_same_bytes(const Result& a, const Result& b, const std::string& what) {
  ASSERT_EQ(a.image.pixels(), b.image.pixels()) << what;
  EXPECT_EQ(std::memcmp(a.image.colour.data(), b.image.colour.data(),
                        a.image.pixels() * sizeof(image::RgbaF)),
            0)
      << what;
  EXPECT_EQ(
      std::memcmp(a.image.depth.data(), b.image.depth.data(), a.image.pixels() * sizeof(float)), 0)
      << what;
}

TEST(Render, SameBytesForEveryNumberOfRanksAndThreads) {
  const scenes::Scene scene = showcase();
  const Tracer tracer = make_tracer(scene);
  RenderOptions options = small(101, 67);
  options.samples = 2;
  const Result alone = render_on(tracer, view_of(scene), options, 1, 1);
  for (int ranks = 1; ranks <= 4; ++ranks) {
    for (int threads = 1; threads <= 3; ++threads) {
      const Result many = render_on(tracer, view_of(scene), options, ranks, threads);
      expect_same_bytes(alone, many, std::to_string(ranks) + " x " + std::to_string(threads));
      EXPECT_EQ(alone.statistics.rays, many.statistics.rays);
      ASSERT_EQ(many.statistics.ranks.size(), static_cast<std::size_t>(ranks));
      std::uint64_t tasks = 0, sent = 0;
      for (const RankStatistics& rank : many.statistics.ranks) {
        tasks += rank.tasks;
        sent += rank.bytes_sent;
      }
      EXPECT_EQ(tasks, 7U * 5);
      EXPECT_EQ(sent, many.statistics.ranks[0].bytes_received);
    }
  }
}

TEST(Render, BuildingTwiceGivesTheSameBytes) {
  const scenes::Scene scene = showcase();
  const RenderOptions options = small(64, 48);
  Result results[3];
  for (int i = 0; i < 3; ++i) {
    parallel::Arena arena(1 + i);
    const Tracer tracer = arena.execute([&] { return make_tracer(scene); });
    results[i] = render_on(tracer, view_of(scene), options, 1, 1);
  }
  expect_same_bytes(results[0], results[1], "built with 2 threads");
  expect_same_bytes(results[0], results[2], "built with 3 threads");
}

TEST(Render, InstancesAndCopiesGiveTheSamePicture) {
  const scenes::Scene scene = showcase();
  RenderOptions options = small(96, 64);
  const Result shared = render_alone(scene, view_of(scene), options);
  options.build.share_meshes = false;
  const Result moved = render_alone(scene, view_of(scene), options);
  EXPECT_GT(moved.statistics.structure_bytes, shared.statistics.structure_bytes);
  // Edges and paths through glass differ where rounding sends a ray to the other side.
  std::size_t different = 0;
  for (std::size_t i = 0; i < shared.image.pixels(); ++i) {
    const image::RgbaF &a = shared.image.colour[i], &b = moved.image.colour[i];
    const float difference =
        std::max(std::max(std::abs(a.r - b.r), std::abs(a.g - b.g)), std::abs(a.b - b.b));
    different += difference > 0.01F ? 1 : 0;
  }
  EXPECT_LE(different, shared.image.pixels() / 100);
}

TEST(Render, LeavesTheCallersFloatingPointModeAlone) {
  const scenes::Scene scene = showcase();
  const Tracer tracer = make_tracer(scene);
  comm::run_threads(2, 2, [&](comm::Communicator& communicator) {
    render(communicator, tracer, view_of(scene), small(64, 64));
    volatile float smallest = std::numeric_limits<float>::min();
    volatile float half = 0.5F;
    EXPECT_GT(smallest * half, 0.0F);
    parallel::parallel_for(0, 64, 1, [&](std::size_t) {
      volatile float x = std::numeric_limits<float>::min();
      EXPECT_GT(x * half, 0.0F);
    });
  });
}

TEST(Render, AveragesSamples) {
  scenes::Scene scene;
  add(scene, quad({0, -50, 0}, {50, 0, 0}, {0, 100, 0})).emission = {1, 1, 1};
  scenes::Camera camera;
  camera.eye = {0, 0, 5};
  RenderOptions options = small(5, 5);
  options.samples = 16;
  options.trace.background = TraceOptions::Background::transparent;
  const Result result = render_alone(scene, camera, options);
  EXPECT_NEAR(pixel(result, 2, 2).a, 0.5F, 1e-6);  // the edge runs through the middle column
  EXPECT_EQ(pixel(result, 1, 2).a, 0.0F);
  EXPECT_EQ(pixel(result, 3, 2).a, 1.0F);
  EXPECT_NEAR(depth(result, 2, 2), 5.0F, 1e-5);
  EXPECT_EQ(result.statistics.rays.primary, 25U * 16U);
}

TEST(Render, EmptyFrameAndMoreRanksThanTiles) {
  const scenes::Scene scene = showcase();
  const Tracer tracer = make_tracer(scene);
  EXPECT_EQ(render_on(tracer, view_of(scene), small(0, 10), 2, 1).image.pixels(), 0U);
  const Result one = render_on(tracer, view_of(scene), small(3, 2), 1, 1);
  expect_same_bytes(one, render_on(tracer, view_of(scene), small(3, 2), 5, 1), "5 ranks");
}

TEST(Render, StopsWhenAsked) {
  const scenes::Scene scene = showcase();
  const Tracer tracer = make_tracer(scene);
  parallel::Progress progress;
  progress.request_stop();
  RenderOptions options = small(64, 64);
  options.progress = &progress;
  EXPECT_THROW(render_on(tracer, view_of(scene), options, 1, 2), parallel::Interrupted);
}

TEST(Render, ReportsProgressAndVersions) {
  const scenes::Scene scene = showcase();
  parallel::Progress progress;
  RenderOptions options = small(64, 64);
  options.progress = &progress;
  const Result result = render_alone(scene, view_of(scene), options);
  EXPECT_EQ(progress.done(), 16U);
  EXPECT_EQ(progress.total(), 16U);
  EXPECT_FALSE(result.statistics.embree_version.empty());
  EXPECT_FALSE(result.statistics.embree_isa.empty());
  EXPECT_GT(result.statistics.structure_bytes, 0U);
  EXPECT_GT(result.statistics.ranks[0].busy, 0.0);
}

TEST(Render, UnknownNamesAreRefused) {
  scenes::Scene scene;
  RenderOptions options = small(8, 8);
  options.integrator = "nonsense";
  EXPECT_THROW(render_alone(scene, scenes::Camera{}, options), std::invalid_argument);
  EXPECT_EQ(std::string(integrator("whitted").name), "whitted");
  const auto refused = [&](auto change) {
    RenderOptions other = small(8, 8);
    change(other);
    EXPECT_THROW(render_alone(scene, scenes::Camera{}, other), std::invalid_argument);
  };
  refused([](RenderOptions& o) { o.schedule = "nonsense"; });
  refused([](RenderOptions& o) { o.partition = "nonsense"; });
  refused([](RenderOptions& o) { o.tile = -1; });
  refused([](RenderOptions& o) { o.tile = -16; });
}

}  // namespace
}  // namespace delray::raytrace
