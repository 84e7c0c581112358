#include "raytrace/integrators/wavefront_integrator.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <string>

#include "raytrace/integrator.h"
#include "raytrace/integrators/intersect.h"
#include "raytrace/scene/hit_points.h"
#include "raytrace/scene/intersection.h"
#include "tests/raytrace/small_scenes.h"

namespace delray::raytrace {
namespace {

scenes::Camera camera() {
  scenes::Camera c;
  c.eye = {0.5F, 1, 6};
  return c;
}

// All samples of a frame, sample by sample, whole rows of pixels.
struct Samples {
  std::vector<glm::vec4> colours;
  std::vector<float> depths;
  RayCounts rays;
  int misses = 0;  // groups that were not sent
};

Samples walk_over(const Tracer& tracer, const char* name, int width, int height, int samples,
                  int side, int samples_at_a_time, bool all_filled = true) {
  const shading::BatchShader shader = shading::make_batch_shader(tracer.shader);
  TraceOptions options;
  options.depth = 4;
  FrameContext context{shader, tracer.lights, scenes::make_view(camera(), width, height), options,
                       samples};
  if (!all_filled) context.filled = scenes::pixels_of(context.view, tracer.embree.bounds());
  const auto pixels = static_cast<std::size_t>(width * height);
  Samples result;
  result.colours.resize(pixels * static_cast<std::size_t>(samples));
  result.depths.resize(result.colours.size());
  const std::unique_ptr<WavefrontIntegrator> wavefront = integrator(name).make(context);
  for (int y = 0; y < height; y += side) {
    for (int x = 0; x < width; x += side) {
      for (int s = 0; s < samples; s += samples_at_a_time) {
        const Task task{{x, y, std::min(x + side, width), std::min(y + side, height)},
                        s,
                        std::min(samples_at_a_time, samples - s)};
        for (wavefront->start(task); !wavefront->done(); wavefront->advance()) {
          for (const RayGroup& group : wavefront->batch().rays)
            result.misses += group.misses ? 1 : 0;
          intersect(tracer, shader, wavefront->batch());
        }
        result.rays += wavefront->rays();
        for (std::size_t b = 0; b < wavefront->samples().size(); ++b) {
          const auto blocks = static_cast<std::size_t>(task.blocks());
          const SampleBlock& block = wavefront->samples()[b];
          const int at = static_cast<int>(b % blocks);
          for (int i = 0; i < kPacketRays; ++i) {
            const int column = x + at % task.columns() * kBlockSide + i % kBlockSide;
            const int row = y + at / task.columns() * kBlockSide + i / kBlockSide;
            if (!task.pixels.contains(column, row)) continue;
            const std::size_t to = (static_cast<std::size_t>(s) + b / blocks) * pixels +
                                   static_cast<std::size_t>(row * width + column);
            result.colours[to] = {block.colour.get(i), block.alpha[i]};
            result.depths[to] = block.depth[i];
          }
        }
      }
    }
  }
  return result;
}

TEST(WavefrontIntegrator, PixelsThatNothingFillsAreNotSentAndStayTheSame) {
  scenes::Scene scene;
  add(scene, sphere(12));
  scene.environment.zenith = {0.2F, 0.3F, 0.6F};
  const Tracer tracer = make_tracer(scene);
  for (const Integrator& one : integrators()) {
    const Samples sent = walk_over(tracer, one.name, 64, 40, 1, 16, 1);
    const Samples spared = walk_over(tracer, one.name, 64, 40, 1, 16, 1, false);
    EXPECT_EQ(sent.misses, 0);
    EXPECT_GT(spared.misses, 20);
    EXPECT_EQ(sent.rays, spared.rays);
    EXPECT_EQ(std::memcmp(sent.colours.data(), spared.colours.data(),
                          sent.colours.size() * sizeof(glm::vec4)),
              0)
        << one.name;
    EXPECT_EQ(sent.depths, spared.depths) << one.name;
  }
}

TEST(WavefrontIntegrator, CutsIntoTasksChangeNoPixel) {
  const scenes::Scene scene = mixture();
  const Tracer tracer = make_tracer(scene);
  for (const Integrator& one : integrators()) {
    const Samples whole = walk_over(tracer, one.name, 37, 26, 3, 64, 3);
    const std::string name = one.name;
    const bool lit = name != "albedo" && name != "normal" && name != "identity";
    EXPECT_EQ(whole.rays.shadow > 0, lit) << name;
    for (const int side : {4, 12, 16}) {
      const Samples cut = walk_over(tracer, one.name, 37, 26, 3, side, 1 + side % 3);
      EXPECT_EQ(whole.rays, cut.rays) << one.name << " " << side;
      EXPECT_EQ(std::memcmp(whole.colours.data(), cut.colours.data(),
                            whole.colours.size() * sizeof(glm::vec4)),
                0)
          << one.name << " " << side;
      EXPECT_EQ(whole.depths, cut.depths) << one.name << " " << side;
    }
  }
}

// Rays that start anywhere around and go to anywhere within.
RayGroup random_group(std::mt19937& random) {
  std::uniform_real_distribution<float> number(-1.0F, 1.0F);
  RayGroup group;
  for (int i = 0; i < kPacketRays; ++i) {
    const glm::vec3 from = glm::vec3(number(random), number(random), number(random)) * 4.0F;
    const glm::vec3 to = glm::vec3(number(random), number(random), number(random)) * 1.5F;
    const glm::vec3 unit = glm::normalize(to - from);
    group.active.ray[i] = i % 7 == 3 ? 0 : -1;
    RayPacket& p = group.packet;
    p.origin_x[i] = from.x, p.origin_y[i] = from.y, p.origin_z[i] = from.z;
    p.direction_x[i] = unit.x, p.direction_y[i] = unit.y, p.direction_z[i] = unit.z;
    p.near[i] = p.time[i] = 0.0F;
    p.far[i] = std::numeric_limits<float>::infinity();
    p.mask[i] = 0xFFFFFFFFU;
    p.id[i] = p.flags[i] = 0;
    p.triangle[i] = p.geometry[i] = p.instance[i] = kMiss;
    group.view.set(i, -unit);
    group.width[i] = 0.01F;
    group.spread[i] = 0.001F * static_cast<float>(i);
  }
  return group;
}

scenes::Scene attributes() {
  scenes::Scene scene;
  scenes::Texture texture;
  texture.width = texture.height = 1;
  texture.texels.resize(1);
  scene.textures.push_back(texture);
  texture.set = 1;
  scene.textures.push_back(texture);
  for (int kind = 0; kind < 4; ++kind) {
    scenes::Mesh mesh = sphere(6);
    if (kind == 1) mesh.normals.clear();
    for (const glm::vec3& p : mesh.positions) {
      if (kind >= 1) mesh.uvs.emplace_back(p.x, p.y);
      if (kind >= 2) mesh.tangents.emplace_back(p.y, -p.x, 0.1F, p.z < 0 ? -1 : 1);
      if (kind == 3) mesh.uvs2.emplace_back(p.z * 0.3F, p.x + p.y);
      if (kind == 3) mesh.colours.emplace_back(0.5F + 0.5F * p.x, 0.5F, 0.2F, 0.7F);
    }
    glm::mat4x3 at = placed(0.9F, {kind % 2 * 1.5F - 0.7F, kind / 2 * 1.5F - 0.7F, 0});
    if (kind == 2) at[0].x = -0.8F;
    scenes::Material& material = add(scene, mesh, at);
    if (kind >= 1) material.normal_texture = 0;
    if (kind >= 2) material.base_colour_texture = 1;
    if (kind == 3) scene.instances.push_back({3, placed(0.5F, {0, 0, 1})});
  }
  return scene;
}

TEST(HitPoints, AgreeWithIntersectionToTheLastBit) {
  const scenes::Scene scene = attributes();
  const Tracer tracer = make_tracer(scene);
  std::mt19937 random(7);
  int hits = 0, second_hits = 0;
  for (int turn = 0; turn < 200; ++turn) {
    RayGroup group = random_group(random);
    if (turn % 2 == 0) {  // neighbours, which hit the same instance
      for (int i = 1; i < kPacketRays; ++i) {
        const auto next = [&](float* v) { v[i] = v[0] + 0.01F * static_cast<float>(i % 4); };
        next(group.packet.origin_x), next(group.packet.origin_y), next(group.packet.origin_z);
        group.packet.direction_x[i] = group.packet.direction_x[0];
        group.packet.direction_y[i] = group.packet.direction_y[0];
        group.packet.direction_z[i] = group.packet.direction_z[0];
        group.view.set(i, group.view.get(0));
      }
    }
    tracer.embree.intersect(group.active, group.packet, false);
    find_points(tracer.instances, group);
    for (int i = 0; i < kPacketRays; ++i) {
      const bool hit = group.active.ray[i] != 0 && group.packet.triangle[i] != kMiss;
      ASSERT_EQ(group.hits >> i & 1, hit ? 1U : 0U);
      if (!hit) continue;
      ++hits;
      const GeometryInstance& instance = tracer.instances[hit_of(group.packet, i).instance];
      const Intersection at =
          intersection(instance, hit_of(group.packet, i), -group.view.get(i),
                       {group.width[i] + group.packet.far[i] * group.spread[i]});
      const shading::Points& p = group.points;
      ASSERT_EQ(p.position.get(i), at.point.position);
      ASSERT_EQ(p.geometric_normal.get(i), at.point.geometric_normal);
      ASSERT_EQ(p.normal.get(i), at.point.normal);
      ASSERT_EQ(group.offset[i], at.offset);
      ASSERT_EQ(group.material[i], instance.material);
      if (p.coloured) {
        ASSERT_EQ(glm::vec4(p.colour.get(i), p.colour_alpha[i]), at.point.colour);
      } else {
        ASSERT_EQ(at.point.colour, glm::vec4(1.0F));
      }
      if (instance.texture_sets == 0) continue;
      const shading::TexturePoint first = p.uvs[0].get(i), second = p.uvs[1].get(i);
      ASSERT_EQ(first.uv, at.point.uv);
      ASSERT_EQ(first.footprint.dx, at.point.footprint.dx);
      ASSERT_EQ(first.footprint.dy, at.point.footprint.dy);
      if (instance.texture_sets > 1) {
        ASSERT_EQ(second.uv, at.point.second.uv);
        ASSERT_EQ(second.footprint.dx, at.point.second.footprint.dx);
        ASSERT_EQ(second.footprint.dy, at.point.second.footprint.dy);
        ++second_hits;
      }
      ASSERT_EQ(glm::vec4(p.tangent.get(i), p.handedness[i]), at.point.tangent);
    }
  }
  EXPECT_GT(hits, 500);
  EXPECT_GT(second_hits, 100);
}

// What lets rays share groups with any others.
TEST(EmbreeScene, EveryKernelFindsTheSameToTheLastBit) {
  const scenes::Scene scene = attributes();
  const Tracer tracer = make_tracer(scene);
  std::mt19937 random(11);
  for (int turn = 0; turn < 500; ++turn) {
    const RayGroup group = random_group(random);
    RayGroup together = group;
    tracer.embree.intersect(together.active, together.packet, true);
    for (const bool alone : {true, false}) {
      RayGroup other = group;
      if (!alone) tracer.embree.intersect(other.active, other.packet, false);
      for (int i = 0; i < kPacketRays; ++i) {
        if (group.active.ray[i] == 0) continue;
        if (alone) {
          RayGroup one = group;
          for (int j = 0; j < kPacketRays; ++j) one.active.ray[j] = i == j ? -1 : 0;
          tracer.embree.intersect(one.active, one.packet, false);
          other.packet.far[i] = one.packet.far[i];
          other.packet.u[i] = one.packet.u[i];
          other.packet.v[i] = one.packet.v[i];
          other.packet.triangle[i] = one.packet.triangle[i];
        }
        ASSERT_EQ(together.packet.triangle[i], other.packet.triangle[i]) << alone;
        ASSERT_EQ(together.packet.far[i], other.packet.far[i]) << alone;
        if (together.packet.triangle[i] == kMiss) continue;
        ASSERT_EQ(together.packet.u[i], other.packet.u[i]) << alone;
        ASSERT_EQ(together.packet.v[i], other.packet.v[i]) << alone;
      }
    }
  }
}

}  // namespace
}  // namespace delray::raytrace
