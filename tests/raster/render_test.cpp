#include "raster/render.h"

#include <gtest/gtest.h>

#include <cstring>
#include <mutex>

#include "comm/simulated.h"
#include "comm/threads.h"
#include "composite/scheme.h"
#include "image/srgb.h"
#include "loadbalance/partition.h"
#include "loadbalance/schedule.h"
#include "parallel/arena.h"
#include "raster/combinations.h"
#include "scenes/generate.h"
#include "tests/raster/allow_threads.h"
#include "tests/raster/kinds_of_picture.h"
#include "tests/support/targets.h"

namespace delray::raster {
namespace {

Result rendered_alone(const scenes::Scene& scene, const scenes::Camera& camera,
                      const RenderOptions& options, int ranks = 1, int threads = 1) {
  Result result;
  comm::run_threads(ranks, threads, [&](comm::Communicator& communicator) {
    Result mine = render(communicator, scene, camera, options);
    if (communicator.rank() == 0) result = std::move(mine);
  });
  return result;
}

std::string described(const RenderOptions& options, int ranks, int threads) {
  return name_of(options) + " " + std::to_string(ranks) + " x " + std::to_string(threads);
}

// Every third combination, beginning with another one for each `turn`: combinations_test.cpp looks
// at all of them.
std::vector<RenderOptions> some_combinations(const RenderOptions& base, int turn) {
  const std::vector<RenderOptions> all = combinations(base);
  std::vector<RenderOptions> some;
  for (std::size_t i = static_cast<std::size_t>(turn) % 3; i < all.size(); i += 3)
    some.push_back(all[i]);
  return some;
}

TEST(Render, ShadingAtOnceGivesTheSamePictureAndShadesMore) {
  for (const bool transparent : {false, true}) {
    for (const Lighting lighting : {Lighting::phong, Lighting::gouraud}) {
      for (const int samples : {1, 2}) {
        const scenes::Scene scene = transparent ? transparent_scene(9) : random_scene(9);
        RenderOptions options;
        options.width = 61;
        options.height = 67;
        options.lighting = lighting;
        options.supersampling = samples;
        const Result deferred = rendered_alone(scene, random_scene_camera(), options);
        EXPECT_GE(deferred.statistics.shaded, deferred.statistics.fragments);
        options.shade = Shade::immediate;
        const Result immediate = rendered_alone(scene, random_scene_camera(), options, 1, 3);
        EXPECT_TRUE(same_bytes(immediate.picture, deferred.picture));
        // Deferred shades what is below glass twice.
        if (!transparent) {
          EXPECT_GT(immediate.statistics.shaded, deferred.statistics.shaded);
        }
      }
    }
  }
}

TEST(Render, AveragesSamplesInLinearLight) {
  const scenes::Scene scene = transparent_scene(10);
  for (const int n : {2, 4}) {
    RenderOptions options;
    options.width = 30;
    options.height = 22;
    options.float_pixels = true;
    options.supersampling = n;
    const Result averaged = rendered_alone(scene, random_scene_camera(), options);
    const auto& pixels = std::get<image::ImageF>(averaged.picture);
    options.supersampling = 1;
    options.width *= n;
    options.height *= n;
    const Result fine = rendered_alone(scene, random_scene_camera(), options);
    const auto& samples = std::get<image::ImageF>(fine.picture);
    for (int y = 0; y < pixels.height; ++y) {
      for (int x = 0; x < pixels.width; ++x) {
        image::RgbaF sum;
        float depth = image::kEmptyDepth;
        for (int j = 0; j < n; ++j) {
          for (int i = 0; i < n; ++i) {
            const int at = (y * n + j) * samples.width + x * n + i;
            const image::RgbaF& sample = samples.colour[at];
            sum = {sum.r + sample.r, sum.g + sample.g, sum.b + sample.b, sum.a + sample.a};
            depth = std::min(depth, samples.depth[at]);
          }
        }
        const int at = y * pixels.width + x;
        const float count = static_cast<float>(n * n);
        EXPECT_FLOAT_EQ(pixels.colour[at].r, sum.r / count);
        EXPECT_FLOAT_EQ(pixels.colour[at].b, sum.b / count);
        EXPECT_FLOAT_EQ(pixels.colour[at].a, sum.a / count);
        EXPECT_EQ(pixels.depth[at], depth);
      }
    }
    options = {};
    options.width = 30;
    options.height = 22;
    options.supersampling = n;
    const auto coded = rendered_alone(scene, random_scene_camera(), options);
    const auto& bytes = std::get<image::Image8>(coded.picture);
    for (std::size_t i = 0; i < bytes.pixels(); ++i) {
      // The samples were rounded to codes before, and dark ones are far apart; lights beyond 1 were
      // cut off.
      if (pixels.colour[i].r > 0.05F && pixels.colour[i].r < 0.2F) {
        EXPECT_NEAR(bytes.colour[i].r, image::encode_srgb(pixels.colour[i].r), 2);
      }
      EXPECT_NEAR(bytes.colour[i].a, pixels.colour[i].a * 255, 1.01);
    }
  }
}

// Panes of glass before a wall, given in the wrong order.
TEST(Render, BlendsFrontToBack) {
  scenes::Scene scene;
  scene.materials.resize(4);
  for (int i = 0; i < 4; ++i) {
    scene.materials[i].base_colour = glm::vec4(0, 0, 0, i == 3 ? 1.0F : 0.25F * (i + 1));
    scene.materials[i].emission = glm::vec3(i == 0, i == 1, i == 2);
    if (i == 3) scene.materials[i].emission = glm::vec3(1, 1, 1);
    if (i < 3) scene.materials[i].alpha = scenes::Material::Alpha::blend;
  }
  const int order[] = {2, 3, 0, 1};  // material; 0 is nearest
  for (const int i : order) {
    scenes::Mesh mesh;
    mesh.material = static_cast<std::uint32_t>(i);
    const float z = -0.1F * static_cast<float>(i), right = i == 3 ? 0.0F : 9.0F;
    mesh.positions = {{-9, -9, z}, {right, -9, z}, {right, 9, z}, {-9, 9, z}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    scene.instances.push_back({static_cast<std::uint32_t>(scene.meshes.size()), glm::mat4x3(1)});
    scene.meshes.push_back(mesh);
  }
  scenes::Camera camera;
  camera.eye = {0, 0, 2};
  RenderOptions base;
  base.width = 20;
  base.height = 10;
  base.float_pixels = true;
  for (const RenderOptions& options : some_combinations(base, 1)) {
    for (const int ranks : {1, 2, 3, 8}) {
      SCOPED_TRACE(described(options, ranks, 1));
      const Result result = rendered_alone(scene, camera, options, ranks);
      const auto& picture = std::get<image::ImageF>(result.picture);
      for (int y = 0; y < 10; ++y) {
        for (int x = 0; x < 20; ++x) {
          const image::RgbaF& pixel = picture.colour[y * 20 + x];
          const float through = 0.75F * 0.5F * 0.25F;
          const float wall = x < 10 ? through : 0.0F;
          EXPECT_NEAR(pixel.r, 0.25F + wall, 1e-6F);
          EXPECT_NEAR(pixel.g, 0.75F * 0.5F + wall, 1e-6F);
          EXPECT_NEAR(pixel.b, 0.75F * 0.5F * 0.75F + wall, 1e-6F);
          EXPECT_NEAR(pixel.a, x < 10 ? 1.0F : 1 - through, 1e-6F);
          EXPECT_NEAR(picture.depth[y * 20 + x], 2.0F, 1e-5F);
        }
      }
    }
  }
}

TEST(Render, SimulatedRanksGiveTheSamePicture) {
  const scenes::Scene scene = random_scene(3);
  RenderOptions base;
  base.width = 70;
  base.height = 50;
  const Result expected = rendered_alone(scene, random_scene_camera(), base);
  for (const RenderOptions& options : some_combinations(base, 2)) {
    for (std::uint64_t seed = 0; seed < 3; ++seed) {
      Picture picture;
      comm::run_simulated(3 + static_cast<int>(seed), comm::any_order(), seed,
                          [&](comm::Communicator& communicator) {
                            Result result =
                                render(communicator, scene, random_scene_camera(), options);
                            if (communicator.rank() == 0) picture = std::move(result.picture);
                          });
      EXPECT_TRUE(same_bytes(picture, expected.picture)) << described(options, 3, 1);
    }
  }
}

TEST(Render, EveryInstructionSetGivesTheSamePicture) {
  const scenes::Scene scene = random_scene(4);
  RenderOptions options;
  options.width = 133;
  options.height = 77;
  const Result expected = rendered_alone(scene, random_scene_camera(), options);
  tests::for_each_target([&] {
    EXPECT_TRUE(same_bytes(rendered_alone(scene, random_scene_camera(), options).picture,
                           expected.picture));
  });
}

TEST(Render, MemoryOfOneFrameLeavesNoTraceInTheNext) {
  const scenes::Scene scene = random_scene(5);
  RenderOptions large, small;
  large.width = 200;
  large.height = 130;
  small.width = 33;
  small.height = 90;
  small.strategy = "sort-first";
  scenes::Camera other = random_scene_camera();
  other.eye = {-3, 0.5F, 1};
  const Result expected = rendered_alone(scene, random_scene_camera(), small);
  comm::run_threads(1, 2, [&](comm::Communicator& communicator) {
    Renderer renderer(scene);
    renderer.recycle(renderer.render(communicator, other, large).picture);
    Result result = renderer.render(communicator, random_scene_camera(), small);
    EXPECT_TRUE(same_bytes(result.picture, expected.picture));
    const auto* const memory = std::get<image::Image8>(result.picture).colour.data();
    renderer.recycle(renderer.render(communicator, other, small).picture);
    renderer.recycle(std::move(result.picture));
    result = renderer.render(communicator, random_scene_camera(), small);
    EXPECT_TRUE(same_bytes(result.picture, expected.picture));
    EXPECT_EQ(std::get<image::Image8>(result.picture).colour.data(), memory);
  });
}

TEST(Render, EmptyScenesAndTinyPicturesWork) {
  scenes::Scene nothing;
  nothing.materials.resize(1);
  scenes::Scene one = nothing;
  one.meshes.resize(1);
  one.meshes[0].positions = {{-900, -900, 0}, {900, -900, 0}, {0, 900, 0}};
  one.meshes[0].triangles = {{0, 1, 2}};
  one.instances.resize(1);
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 65}, {129, 1}, {2, 3}}) {
    RenderOptions base;
    base.width = width;
    base.height = height;
    for (const RenderOptions& options : some_combinations(base, 3)) {
      for (const int ranks : {1, 2, 7}) {
        SCOPED_TRACE(described(options, ranks, 1));
        const Result empty = rendered_alone(nothing, {}, options, ranks);
        const auto& blank = std::get<image::Image8>(empty.picture);
        ASSERT_EQ(blank.pixels(), static_cast<std::size_t>(width * height));
        for (std::size_t i = 0; i < blank.pixels(); ++i) {
          EXPECT_EQ(blank.colour[i], image::Rgba8());
          EXPECT_EQ(blank.depth[i], image::kEmptyDepth);
        }
        const Result full = rendered_alone(one, {}, options, ranks);
        const auto& covered = std::get<image::Image8>(full.picture);
        for (std::size_t i = 0; i < covered.pixels(); ++i) {
          EXPECT_EQ(covered.colour[i].a, 255);
          EXPECT_NEAR(covered.depth[i], 1.0F, 1e-5F);
        }
      }
    }
  }
}

TEST(Render, NearerWinsAndEqualDepthsGoToTheFirst) {
  scenes::Scene scene;
  scene.materials.resize(3);
  for (int i = 0; i < 3; ++i) {
    scene.materials[i].base_colour = glm::vec4(0, 0, 0, 1);
    scene.materials[i].emission[i] = 1;
    scenes::Mesh mesh;
    mesh.material = static_cast<std::uint32_t>(i);
    const float z = i == 2 ? 0.5F : 0.0F;  // the last one is nearer
    const float right = i == 2 ? 0.0F : 9.0F;
    mesh.positions = {{-9, -9, z}, {right, -9, z}, {right, 9, z}, {-9, 9, z}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    scene.meshes.push_back(mesh);
    scene.instances.push_back({static_cast<std::uint32_t>(i), glm::mat4x3(1.0F)});
  }
  scenes::Camera camera;
  camera.eye = {0, 0, 2};
  RenderOptions base;
  base.width = 20;
  base.height = 10;
  base.float_pixels = true;
  for (const RenderOptions& options : some_combinations(base, 4)) {
    for (const int ranks : {1, 2, 3, 6}) {
      SCOPED_TRACE(described(options, ranks, 1));
      const Result result = rendered_alone(scene, camera, options, ranks);
      const auto& picture = std::get<image::ImageF>(result.picture);
      for (int y = 0; y < 10; ++y) {
        for (int x = 0; x < 20; ++x) {
          const image::RgbaF& pixel = picture.colour[y * 20 + x];
          EXPECT_EQ(pixel.g, 0.0F);  // the second is never seen
          EXPECT_EQ(pixel.r, x < 10 ? 0.0F : 1.0F);
          EXPECT_EQ(pixel.b, x < 10 ? 1.0F : 0.0F);
          EXPECT_NEAR(picture.depth[y * 20 + x], x < 10 ? 1.5F : 2.0F, 1e-5F);
        }
      }
    }
  }
}

TEST(Render, CullsBackFacesOnlyOfSingleSidedMaterialsWhenAsked) {
  scenes::Scene scene;
  scene.materials.resize(2);
  scene.materials[1].double_sided = false;
  for (std::uint32_t i = 0; i < 2; ++i) {
    scenes::Mesh mesh;
    mesh.material = i;
    mesh.positions = {{-9, -9, 0}, {9, -9, 0}, {0, 9, 0}};
    mesh.triangles = {{0, 1, 2}};
    scene.meshes.push_back(mesh);
  }
  glm::mat4x3 mirrored(1.0F);
  mirrored[2].z = -1;
  for (const std::uint32_t mesh : {0U, 1U}) {
    for (const bool mirror : {false, true}) {
      for (const bool behind : {false, true}) {
        for (const bool cull : {false, true}) {
          scene.instances = {{mesh, mirror ? mirrored : glm::mat4x3(1.0F)}};
          scenes::Camera camera;
          camera.eye.z = behind ? -1.0F : 1.0F;
          RenderOptions options;
          options.width = options.height = 9;
          options.cull_single_sided = cull;
          // A mirrored instance is inside out: its outside is where the triangle runs clockwise.
          const bool hidden = mesh == 1 && cull && behind != mirror;
          EXPECT_EQ(rendered_alone(scene, camera, options).statistics.fragments, hidden ? 0U : 81U)
              << mesh << mirror << behind << cull;
        }
      }
    }
  }
}

// Of a picture that shows something in a small part, ranks of sort-last composite that part.
TEST(Render, SortLastSendsOfWhereSomethingIsSeen) {
  const scenes::Scene scene = random_scene(6);
  scenes::Camera camera = random_scene_camera();
  camera.eye = camera.at + (camera.eye - camera.at) * 8.0F;
  RenderOptions options;
  options.width = 640;
  options.height = 512;
  options.scheme = "centralized";
  options.codec = "dense";
  const Result alone = rendered_alone(scene, camera, options),
               last = rendered_alone(scene, camera, options, 3);
  EXPECT_TRUE(same_bytes(last.picture, alone.picture));
  EXPECT_GT(alone.statistics.fragments, 100U);
  constexpr std::uint64_t kTileBytes = 64 * 64 * 8;
  EXPECT_LE(last.statistics.ranks[1].bytes_sent, 9 * kTileBytes + 80 * 32 * 4 * 4);
}

TEST(Render, CountsWhatTravels) {
  const scenes::Scene scene = random_scene(6);
  RenderOptions options;
  options.width = 128;
  options.height = 128;
  options.scheme = "centralized";
  const Result active = rendered_alone(scene, random_scene_camera(), options, 3);
  options.codec = "dense";
  const Result last = rendered_alone(scene, random_scene_camera(), options, 3);
  const std::uint64_t image_bytes = 128 * 128 * 8;
  EXPECT_LT(active.statistics.ranks[1].bytes_sent, last.statistics.ranks[1].bytes_sent);
  EXPECT_GE(last.statistics.ranks[1].bytes_sent, image_bytes);
  const std::uint64_t cover_bytes = 4 * 32 * 8;
  EXPECT_LE(last.statistics.ranks[1].bytes_sent, image_bytes + cover_bytes + 500);
  EXPECT_EQ(last.statistics.triangles_travelled, 0U);
  EXPECT_EQ(last.statistics.triangles_in, scenes::triangle_count(scene));

  options.strategy = "sort-first";
  const Result geometry = rendered_alone(scene, random_scene_camera(), options, 3);
  options.travel = Travel::numbers;
  const Result numbers = rendered_alone(scene, random_scene_camera(), options, 3);
  EXPECT_GT(numbers.statistics.triangles_travelled, 0U);
  EXPECT_EQ(geometry.statistics.triangles_travelled, numbers.statistics.triangles_travelled);
  const auto sent = [](const Statistics& statistics) {
    std::uint64_t sum = 0, received = 0;
    for (const RankStatistics& rank : statistics.ranks) {
      sum += rank.bytes_sent;
      received += rank.bytes_received;
    }
    EXPECT_EQ(sum, received);
    return sum;
  };
  // A triangle has three indices of its own and, here, three vertices of position, normal and uv.
  EXPECT_GE(sent(geometry.statistics),
            sent(numbers.statistics) + geometry.statistics.triangles_travelled * 12 * 8 / 2);
}

TEST(Render, TellsOfWhatItDoesNotKnow) {
  const scenes::Scene scene = random_scene(7);
  const auto expect_refused = [&](auto change) {
    RenderOptions options;
    options.width = options.height = 8;
    change(options);
    comm::run_threads(1, 1, [&](comm::Communicator& communicator) {
      EXPECT_THROW(render(communicator, scene, {}, options), std::invalid_argument);
    });
  };
  expect_refused([](RenderOptions& o) { o.strategy = "sort-of"; });
  expect_refused([](RenderOptions& o) { o.scheme = "none"; });
  expect_refused([](RenderOptions& o) { o.partition = "none"; });
  expect_refused([](RenderOptions& o) { o.codec = "none"; });
  expect_refused([](RenderOptions& o) { o.width = 0; });
  expect_refused([](RenderOptions& o) { o.height = 65535; });
  expect_refused([](RenderOptions& o) { o.schedule = "stealing"; });
  expect_refused([](RenderOptions& o) {
    o.strategy = "sort-first";
    o.schedule = "none";
  });
  expect_refused([](RenderOptions& o) {
    o.strategy = "sort-first";
    o.schedule = "stealing";
    o.block = 0;
  });
  expect_refused([](RenderOptions& o) { o.supersampling = 3; });
  expect_refused([](RenderOptions& o) {
    o.width = 40000;
    o.supersampling = 2;
  });
  expect_refused([](RenderOptions& o) {
    o.strategy = "sort-middle";
    o.geometry_ranks = 1;
  });
  expect_refused([](RenderOptions& o) {
    o.groups = Groups::two;
    o.geometry_ranks = 1;
  });
  expect_refused([](RenderOptions& o) {
    o.shade = Shade::composited;
    o.strategy = "sort-first";
  });
  expect_refused([](RenderOptions& o) {
    o.shade = Shade::composited;
    o.lighting = Lighting::gouraud;
  });
}

TEST(Render, StopsWhenAsked) {
  const scenes::Scene scene = random_scene(8);
  RenderOptions options;
  options.width = options.height = 8;
  parallel::Progress progress;
  progress.request_stop();
  comm::run_threads(1, 1, [&](comm::Communicator& communicator) {
    EXPECT_THROW(render(communicator, scene, random_scene_camera(), options, &progress),
                 parallel::Interrupted);
  });
}

// Wherever a mesh has the coordinates of a texture, and whoever shades what.
TEST(Render, TexturesOfASecondSetLookAsThoseOfTheFirst) {
  int turn = 0;
  for (const Lighting lighting : {Lighting::phong, Lighting::gouraud}) {
    for (const bool transparent : {false, true}) {
      scenes::Scene scene = transparent ? transparent_scene(17) : random_scene(17);
      scene.materials[3].base_colour_texture = 0;  // beside a normal texture
      RenderOptions options;
      options.width = 97;
      options.height = 61;
      options.lighting = lighting;
      const Result expected = rendered_alone(scene, random_scene_camera(), options);
      const scenes::Scene moved = with_second_uvs(scene);
      EXPECT_TRUE(same_bytes(rendered_alone(moved, random_scene_camera(), options).picture,
                             expected.picture));
      for (const RenderOptions& way : some_combinations(options, ++turn)) {
        EXPECT_TRUE(same_bytes(rendered_alone(moved, random_scene_camera(), way, 3).picture,
                               expected.picture))
            << described(way, 3, 1);
      }
      if (lighting == Lighting::gouraud) continue;
      options.shade = Shade::composited;
      EXPECT_TRUE(same_bytes(rendered_alone(moved, random_scene_camera(), options, 3).picture,
                             expected.picture));
    }
  }
}

TEST(Render, PicturesOfGeneratedScenesDoNotDependOnRanks) {
  for (const char* name : {"gen:terrain:20000", "gen:city:5000"}) {
    const scenes::Scene scene = scenes::generate(name);
    ASSERT_FALSE(scene.cameras.empty());
    RenderOptions options;
    options.width = 257;
    options.height = 190;
    const Result expected = rendered_alone(scene, scene.cameras[0], options, 1, 2);
    for (const RenderOptions& way : some_combinations(options, 5)) {
      EXPECT_TRUE(
          same_bytes(rendered_alone(scene, scene.cameras[0], way, 4, 1).picture, expected.picture))
          << name << " " << described(way, 4, 1);
    }
  }
}

}  // namespace
}  // namespace delray::raster
