// Samples that change integrators while their rays wait: as if they had stayed.
#include "raytrace/integrators/waiting_rays.h"

#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <random>

#include "raytrace/integrator.h"
#include "raytrace/integrators/intersect.h"
#include "tests/raytrace/small_scenes.h"

namespace delray::raytrace {
namespace {

struct Setting {
  scenes::Scene scene = mixture();
  Tracer tracer = make_tracer(scene);
  shading::BatchShader shader = shading::make_batch_shader(tracer.shader);

  FrameContext context(TraceOptions::Background background) const {
    scenes::Camera camera;
    camera.eye = {0.5F, 1, 6};
    TraceOptions options;
    options.depth = 4;
    options.background = background;
    return {shader, tracer.lights, scenes::make_view(camera, 50, 37), options, 2};
  }
};

std::uint64_t active_rays(RayBatch& batch) {
  std::uint64_t count = 0;
  for (const RayGroup& group : batch.rays)
    count += static_cast<std::uint64_t>(std::popcount(active_lanes(group.active)));
  for (const ShadowGroup& group : batch.shadows)
    count += static_cast<std::uint64_t>(std::popcount(active_lanes(group.active)));
  return count;
}

// After every generation some blocks go from one of several integrators to a fresh one.
TEST(WaitingRays, SamplesThatMoveAreTheSame) {
  const Setting setting;
  const Task task{{16, 8, 48, 37}, 1, 1};
  int moves = 0;
  for (const Integrator& kind : integrators()) {
    for (const auto background :
         {TraceOptions::Background::environment, TraceOptions::Background::transparent}) {
      const FrameContext context = setting.context(background);
      const std::unique_ptr<WavefrontIntegrator> alone = kind.make(context);
      for (alone->start(task); !alone->done(); alone->advance())
        intersect(setting.tracer, setting.shader, alone->batch());
      for (std::uint64_t seed = 0; seed < 12; ++seed) {
        SCOPED_TRACE(std::string(kind.name) + ", seed " + std::to_string(seed));
        std::mt19937_64 random(seed);
        struct Share {
          std::unique_ptr<WavefrontIntegrator> integrator;
          std::vector<std::uint8_t> here;
        };
        const std::size_t blocks = alone->samples().size();
        std::vector<Share> parts;
        parts.push_back({kind.make(context), std::vector<std::uint8_t>(blocks, 1)});
        parts[0].integrator->start(task);
        for (bool any = true; any;) {
          any = false;
          for (std::size_t k = parts.size(); k-- > 0 && parts.size() < 9;) {
            if (parts[k].integrator->done() || random() % 2 == 0) continue;
            std::vector<std::uint8_t> moved(blocks, 0);
            std::uint64_t expected = 0;
            const std::vector<std::uint32_t> waiting = parts[k].integrator->waiting();
            for (std::size_t b = 0; b < blocks; ++b) {
              if (parts[k].here[b] == 0 || random() % 3 != 0) continue;
              moved[b] = 1;
              parts[k].here[b] = 0;
              expected += waiting[b];
            }
            RayWriter message;
            parts[k].integrator->release(moved, message);
            RayReader from(message.bytes());
            Share part{kind.make(context), {}};
            part.here = part.integrator->resume(task, from);
            EXPECT_TRUE(from.at_end());
            EXPECT_EQ(part.here, moved);
            EXPECT_EQ(active_rays(part.integrator->batch()), expected);
            EXPECT_EQ(part.integrator->rays().sent(), expected);
            parts.push_back(std::move(part));
            moves += expected > 0 ? 1 : 0;
          }
          for (Share& part : parts) {
            if (part.integrator->done()) continue;
            any = true;
            intersect(setting.tracer, setting.shader, part.integrator->batch());
            part.integrator->advance();
          }
        }
        RayCounts rays;
        std::size_t found = 0;
        for (const Share& part : parts) {
          rays += part.integrator->rays();
          for (std::size_t b = 0; b < blocks; ++b) {
            if (part.here[b] == 0) continue;
            ++found;
            const SampleBlock &is = part.integrator->samples()[b], &was = alone->samples()[b];
            for (int i = 0; i < kPacketRays; ++i) {
              const int x = task.pixels.x0 + static_cast<int>(b) % task.columns() * 4 + i % 4;
              const int y = task.pixels.y0 + static_cast<int>(b) / task.columns() * 4 + i / 4;
              if (!task.pixels.contains(x, y)) continue;
              ASSERT_EQ(is.colour.get(i), was.colour.get(i)) << b << ' ' << i;
              ASSERT_EQ(is.alpha[i], was.alpha[i]);
              ASSERT_EQ(is.depth[i], was.depth[i]);
            }
          }
        }
        EXPECT_EQ(found, blocks);
        EXPECT_EQ(rays, alone->rays());
      }
    }
  }
  EXPECT_GT(moves, 200);
}

TEST(WaitingRays, AMessageThatEndsTooSoonIsNoMessage) {
  const Setting setting;
  const Task task{{0, 0, 16, 16}, 0, 1};
  const FrameContext context = setting.context(TraceOptions::Background::environment);
  const std::unique_ptr<WavefrontIntegrator> path = integrator("path").make(context);
  path->start(task);
  RayWriter message;
  path->release(std::vector<std::uint8_t>(16, 1), message);
  for (const std::size_t less : {std::size_t{1}, message.bytes().size() / 2}) {
    RayReader from(message.bytes().first(message.bytes().size() - less));
    EXPECT_THROW(integrator("path").make(context)->resume(task, from), comm::BadMessage);
  }
}

}  // namespace
}  // namespace delray::raytrace
