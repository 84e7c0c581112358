// Sort-middle: all that its variants have in common is the picture.
#include <gtest/gtest.h>

#include <cstring>
#include <set>

#include "comm/ledger.h"
#include "comm/recording.h"
#include "comm/simulated.h"
#include "comm/threads.h"
#include "raster/distribute/cluster_messages.h"
#include "raster/render.h"
#include "scenes/generate.h"
#include "tests/raster/allow_threads.h"
#include "tests/raster/random_scene.h"

namespace delray::raster {
namespace {

bool same_picture_bytes(const Picture& a, const Picture& b) {
  return a.index() == b.index() &&
         std::visit(
             [&](const auto& image) {
               const auto& other = std::get<std::decay_t<decltype(image)>>(b);
               return image.pixels() == other.pixels() &&
                      std::memcmp(image.colour.data(), other.colour.data(),
                                  image.pixels() * sizeof(image.colour[0])) == 0 &&
                      std::memcmp(image.depth.data(), other.depth.data(),
                                  image.pixels() * sizeof(float)) == 0;
             },
             a);
}

Result rendered_by_ranks(const scenes::Scene& scene, const scenes::Camera& camera,
                         const RenderOptions& options, int ranks = 1, int threads = 1) {
  Result result;
  comm::run_threads(ranks, threads, [&](comm::Communicator& communicator) {
    Result mine = render(communicator, scene, camera, options);
    if (communicator.rank() == 0) result = std::move(mine);
  });
  return result;
}

std::vector<RenderOptions> variants(RenderOptions options) {
  std::vector<RenderOptions> result;
  options.strategy = "sort-middle";
  for (const Groups groups : {Groups::one, Groups::two}) {
    for (const Redistribution redistribution :
         {Redistribution::immediate, Redistribution::at_end, Redistribution::broadcast}) {
      options.groups = groups;
      options.redistribution = redistribution;
      result.push_back(options);
    }
  }
  return result;
}

std::string described_ranks(const RenderOptions& options) {
  return std::string(options.groups == Groups::one ? "one group" : "two groups") +
         (options.redistribution == Redistribution::at_end      ? ", at end"
          : options.redistribution == Redistribution::broadcast ? ", broadcast"
                                                                : ", immediate");
}

RenderOptions small_sort_middle() {
  RenderOptions options;
  options.width = 75;
  options.height = 70;
  return options;
}

void expect_one_picture(const scenes::Scene& scene, const scenes::Camera& camera,
                        const RenderOptions& base, std::span<const int> rank_counts) {
  const Picture expected = rendered_by_ranks(scene, camera, base).picture;
  for (const RenderOptions& options : variants(base)) {
    for (const int ranks : rank_counts) {
      const int threads = 1 + (ranks + static_cast<int>(options.groups)) % 3;
      EXPECT_TRUE(same_picture_bytes(
          rendered_by_ranks(scene, camera, options, ranks, threads).picture, expected))
          << described_ranks(options) << ", " << ranks << " ranks x " << threads;
    }
  }
}

constexpr int kAllRankCounts[] = {1, 2, 3, 4, 5, 6, 7, 8, 9};

TEST(SortMiddle, OnePictureWithEveryKindOfShading) {
  for (const Lighting lighting : {Lighting::phong, Lighting::gouraud}) {
    for (const bool transparent : {false, true}) {
      for (const int samples : {1, 2}) {
        SCOPED_TRACE(::testing::Message()
                     << "gouraud " << (lighting == Lighting::gouraud) << " transparent "
                     << transparent << " samples " << samples);
        RenderOptions options = small_sort_middle();
        options.width /= samples;
        options.height /= samples;
        options.supersampling = samples;
        options.lighting = lighting;
        options.float_pixels = samples == 1;
        options.cull_single_sided = !transparent;
        const unsigned seed = 20 + static_cast<unsigned>(samples);
        expect_one_picture(transparent ? transparent_scene(seed) : random_scene(seed),
                           random_scene_camera(), options, kAllRankCounts);
        options.shade = Shade::immediate;
        expect_one_picture(transparent ? transparent_scene(seed) : random_scene(seed),
                           random_scene_camera(), options, std::array{4});
      }
    }
  }
}

// Primitives are broadcast once over a bus, however many renderers' fine regions they touch;
// messages to each of them carry them several times.
TEST(SortMiddle, ABroadcastCarriesPrimitivesOnce) {
  constexpr int kRanks = 6;
  const scenes::Scene scene = random_scene(7);
  RenderOptions options = small_sort_middle();
  options.strategy = "sort-middle";
  options.partition = "infinite-reality";
  const auto carried = [&](Redistribution redistribution, bool once) {
    options.redistribution = redistribution;
    std::vector<std::vector<comm::Event>> events(kRanks);
    comm::run_threads(kRanks, 1, [&](comm::Communicator& communicator) {
      comm::Recording recording(communicator,
                                events[static_cast<std::size_t>(communicator.rank())]);
      render(recording, scene, random_scene_camera(), options);
    });
    constexpr comm::Tag kTagTriangles = 81;
    std::uint64_t bytes = 0;
    for (const auto& of_rank : events) {
      for (const comm::Event& event : of_rank) {
        if (event.kind == comm::Event::Kind::send && event.tag == kTagTriangles &&
            !(once && event.is_repeated))
          bytes += event.amount;
      }
    }
    return bytes;
  };
  const std::uint64_t each = carried(Redistribution::at_end, false);
  const std::uint64_t broadcast = carried(Redistribution::broadcast, true);
  EXPECT_GT(broadcast, 0U);
  EXPECT_LT(broadcast, each);
  EXPECT_EQ(carried(Redistribution::broadcast, false), broadcast * (kRanks - 1));
}

// Vertices without normals are lit for every triangle, so that a cluster has three for each of its
// triangles, more than a byte numbers.
TEST(SortMiddle, ClustersWithMoreLitVerticesThanABytesNumbersAreCutInTwo) {
  scenes::Scene scene = scenes::generate("gen:terrain:3000");
  for (scenes::Mesh& mesh : scene.meshes) mesh.normals.clear();
  RenderOptions options = small_sort_middle();
  options.lighting = Lighting::gouraud;
  expect_one_picture(scene, scene.cameras[0], options, std::array{2, 5});

  const DrawList list =
      make_draw_list({{&scene.meshes[0], &scene.instances[0].transform, 0, 128, 0}});
  ASSERT_EQ(list.clusters.size(), 1U);
  const Screen screen = make_screen(scenes::make_view(scene.cameras[0], 75, 70));
  const shading::Shader shader = shading::make_shader(scene);
  const std::vector<PreparedDraw> draws = prepare_draws(screen, list, shader, false);
  const FrameShading frame = make_frame_shading(screen, shader, list, Lighting::gouraud, false);
  std::vector<std::uint8_t> places;
  for (std::uint8_t place = 0; place < list.clusters[0].end; ++place) places.push_back(place);
  ASSERT_GT(places.size(), 86U);
  ClusterPacker packer;
  packer.set(frame, draws[0], 0, places);
  PackedClusters packed;
  packer.pack(places, packed);
  EXPECT_EQ(packed.triangles, places.size());
  std::deque<ArrivedMesh> meshes;
  DrawList arrived;
  arrived.clusters.resize(2);
  std::vector<std::uint32_t> numbers;
  unpack_clusters(packed.bytes, meshes, arrived, numbers);
  EXPECT_EQ(numbers, (std::vector<std::uint32_t>{0, 1}));
  ASSERT_EQ(meshes.size(), 1U);
  EXPECT_EQ(meshes[0].transform, scene.instances[0].transform);
  // In the order in which they were, at the very same places.
  for (std::uint32_t i = 0; i < places.size(); ++i) {
    const glm::uvec3& was = scene.meshes[0].triangles[i];
    const glm::uvec3& is = meshes[0].mesh.triangles[i];
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(meshes[0].mesh.positions[is[k]], scene.meshes[0].positions[was[k]]);
    }
  }
  EXPECT_EQ(meshes[0].radiances.size(), 3 * places.size());
  EXPECT_EQ(arrived.clusters[0].end + arrived.clusters[1].end, static_cast<int>(places.size()));
}

TEST(SortMiddle, CamerasAmidTheSceneAndAtItsEdges) {
  const scenes::Scene scene = random_scene(31, 150);
  for (const glm::vec3 eye : {glm::vec3(0, 0, 0.2F), glm::vec3(0.3F, -0.2F, 0.9F)}) {
    for (const Lighting lighting : {Lighting::phong, Lighting::gouraud}) {
      scenes::Camera camera = random_scene_camera();
      camera.eye = eye;
      camera.vertical_fov = 110;
      RenderOptions options = small_sort_middle();
      options.lighting = lighting;
      expect_one_picture(scene, camera, options, std::array{3, 6});
    }
  }
}

// Two meshes of the same triangles: of those at one place the first is seen, whatever comes first.
TEST(SortMiddle, EqualDepthsGoToTheLowestPrimitiveWhateverArrivesFirst) {
  scenes::Scene scene = random_scene(32, 200);
  scene.meshes.push_back(scene.meshes[0]);
  scene.meshes.back().material = 1;
  scene.instances = {{4, glm::mat4x3(1.0F)},
                     {0, glm::mat4x3(1.0F)},
                     {3, glm::mat4x3(1.0F)},
                     {4, glm::mat4x3(1.0F)}};
  const RenderOptions base = small_sort_middle();
  const Picture expected = rendered_by_ranks(scene, random_scene_camera(), base).picture;
  for (const RenderOptions& options : variants(base)) {
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
      comm::run_simulated(3 + static_cast<int>(seed), comm::any_order(), seed,
                          [&](comm::Communicator& communicator) {
                            const Result result =
                                render(communicator, scene, random_scene_camera(), options);
                            if (communicator.rank() != 0) return;
                            EXPECT_TRUE(same_picture_bytes(result.picture, expected))
                                << described_ranks(options) << ", seed " << seed;
                          });
    }
  }
}

TEST(SortMiddle, FewerTrianglesThanRanks) {
  scenes::Scene scene = random_scene(33, 1);
  scene.instances.resize(2);
  RenderOptions options = small_sort_middle();
  expect_one_picture(scene, random_scene_camera(), options, std::array{5, 9});
  options.width = options.height = 1;
  expect_one_picture(scene, random_scene_camera(), options, std::array{5});
}

TEST(SortMiddle, CountsWhatTravels) {
  const scenes::Scene scene = scenes::generate("gen:terrain:20000");
  RenderOptions base = small_sort_middle();
  base.lighting = Lighting::gouraud;
  base.partition = "interlaced";  // the same regions whatever pixels cost
  struct Sent {
    Statistics statistics;
    std::uint64_t bytes = 0, messages = 0;  // of triangles
  };
  const auto sent = [&](const RenderOptions& options, int ranks) {
    Sent result;
    comm::Ledger ledger;
    ledger.ranks.resize(static_cast<std::size_t>(ranks));
    comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
      comm::Recording recording(communicator, ledger.ranks[communicator.rank()]);
      Result mine = render(recording, scene, scene.cameras[0], options);
      if (communicator.rank() == 0) result.statistics = std::move(mine.statistics);
    });
    std::uint64_t received = 0;
    for (const auto& events : ledger.ranks) {
      for (const comm::Event& event : events) {
        if (event.phase != comm::Phase::redistribute || event.tag >= comm::kReservedTags) continue;
        if (event.kind == comm::Event::Kind::receive) received += event.amount;
        if (event.kind != comm::Event::Kind::send) continue;
        result.bytes += event.amount;
        ++result.messages;
      }
    }
    EXPECT_EQ(result.bytes, received);
    return result;
  };
  std::uint64_t messages_at_end = 0, messages_at_once = 0;
  for (RenderOptions options : variants(base)) {
    SCOPED_TRACE(described_ranks(options));
    const Sent alone = sent(options, 1);
    EXPECT_EQ(alone.statistics.triangles_travelled, 0U);
    EXPECT_EQ(alone.messages, 0U);
    EXPECT_EQ(alone.statistics.triangles_in, 20000U);
    const Sent gouraud = sent(options, 4);
    const std::uint64_t travelled = gouraud.statistics.triangles_travelled;
    EXPECT_GT(travelled, 1000U);
    EXPECT_LT(travelled, 2 * 20000U);
    // At least half a vertex for each triangle, and three at most.
    EXPECT_GT(gouraud.bytes, travelled * (3 + 24 / 2));
    EXPECT_LT(gouraud.bytes, travelled * (3 + 3 * 24 + 16));
    EXPECT_LE(gouraud.messages, 12U);
    (options.redistribution == Redistribution::at_end ? messages_at_end : messages_at_once) +=
        gouraud.messages;
    options.lighting = Lighting::phong;
    const Sent phong = sent(options, 4);
    EXPECT_EQ(phong.statistics.triangles_travelled, travelled);
    EXPECT_GT(phong.bytes, gouraud.bytes);
    EXPECT_EQ(phong.statistics.fragments, gouraud.statistics.fragments);
    EXPECT_GE(phong.statistics.triangles_in, 20000U);
  }
  EXPECT_GE(messages_at_once, messages_at_end);
}

// A wall whose triangles are numbered from one side to the other: seen from either side of it, each
// half of the screen shows what one rank has.
TEST(SortMiddle, RanksDrawWhatTheyHaveMostOf) {
  constexpr std::uint32_t kSide = 65;  // vertices
  scenes::Scene scene = scenes::generate("gen:terrain:2000");
  scenes::Mesh& mesh = scene.meshes[0];
  mesh = {};
  for (std::uint32_t x = 0; x < kSide; ++x) {
    for (std::uint32_t y = 0; y < kSide; ++y)
      mesh.positions.emplace_back(static_cast<float>(x) / 32 - 1, static_cast<float>(y) / 64, 0);
  }
  for (std::uint32_t x = 0; x + 1 < kSide; ++x) {
    for (std::uint32_t y = 0; y + 1 < kSide; ++y) {
      const std::uint32_t i = x * kSide + y;
      mesh.triangles.emplace_back(i, i + 1, i + kSide);
      mesh.triangles.emplace_back(i + 1, i + kSide + 1, i + kSide);
    }
  }
  scene.instances = {{0, glm::mat4x3(1.0F)}};
  scenes::Camera camera = scene.cameras[0];
  camera.at = {0, 0.5F, 0};
  camera.up = {0, 1, 0};
  camera.vertical_fov = 40;
  camera.near = 0.01F;
  RenderOptions options = small_picture();
  options.width = 300;
  options.height = 150;
  options.report_partition = true;
  for (const float side : {2.0F, -2.0F}) {
    camera.eye = {0, 0.5F, side};
    options.strategy = "sort-first";
    const Result expected = rendered_by_ranks(scene, camera, options, 1);
    options.strategy = "sort-middle";
    const Result result = rendered_by_ranks(scene, camera, options, 2);
    EXPECT_TRUE(same_bytes(result.picture, expected.picture));
    EXPECT_GT(result.statistics.fragments, 10000U);
    EXPECT_LT(result.statistics.triangles_travelled, 8192U / 10) << side;
    // Rank 0 has what lies at negative x: to the left as seen from positive z.
    ASSERT_TRUE(result.statistics.partition);
    for (const loadbalance::Region& region : result.statistics.partition->partition.regions)
      EXPECT_EQ(region.owner == 0, (region.rect.x0 == 0) == (side > 0)) << side;
  }
}

TEST(SortMiddle, TheSecondGroupHasNoPrimitivesAndTheFirstNoPixels) {
  const scenes::Scene scene = scenes::generate("gen:terrain:20000");
  RenderOptions options = small_sort_middle();
  options.strategy = "sort-middle";
  options.groups = Groups::two;
  const Picture expected = rendered_by_ranks(scene, scene.cameras[0], small_sort_middle()).picture;
  for (const int geometry_ranks : {0, 1, 4}) {
    options.geometry_ranks = geometry_ranks;
    const Result result = rendered_by_ranks(scene, scene.cameras[0], options, 5);
    EXPECT_TRUE(same_picture_bytes(result.picture, expected));
    for (const RankStatistics& rank : result.statistics.ranks) {
      const bool first = rank.rank < (geometry_ranks == 0 ? 2 : geometry_ranks);
      EXPECT_EQ(rank.tasks == 0, first) << rank.rank;
    }
  }
  options.geometry_ranks = 5;
  comm::run_threads(5, 1, [&](comm::Communicator& communicator) {
    EXPECT_THROW(render(communicator, scene, scene.cameras[0], options), std::invalid_argument);
  });
}

// Those that draw get triangles in several rounds, before geometry is all done elsewhere.
TEST(SortMiddle, ImmediateBatchesAreDrawnAsTheyCome) {
  const scenes::Scene scene = scenes::generate("gen:terrain:100000");
  for (RenderOptions options : variants(small_sort_middle())) {
    if (options.groups == Groups::one) continue;
    SCOPED_TRACE(described_ranks(options));
    std::set<std::int32_t> rounds;
    std::size_t messages = 0;
    constexpr int kOrders = 4;  // of what happens when
    for (std::uint64_t seed = 0; seed < kOrders; ++seed) {
      std::vector<std::vector<comm::Event>> events(3);
      comm::run_simulated(3, comm::any_order(), seed, [&](comm::Communicator& communicator) {
        comm::Recording recording(communicator, events[communicator.rank()]);
        render(recording, scene, scene.cameras[0], options);
      });
      for (const int receiver : {1, 2}) {
        for (const comm::Event& event : events[receiver]) {
          if (event.kind != comm::Event::Kind::receive || event.tag >= comm::kReservedTags)
            continue;
          ++messages;
          rounds.insert(event.round);
        }
      }
    }
    const bool immediate = options.redistribution == Redistribution::immediate;
    EXPECT_EQ(messages > 4 * kOrders, immediate);
    EXPECT_EQ(rounds.size() > 1, immediate);
  }
}

TEST(SortMiddle, RenderersMayChangeHowTheyRenderFromFrameToFrame) {
  const scenes::Scene scene = random_scene(34);
  std::vector<RenderOptions> frames;
  for (RenderOptions options : variants(small_sort_middle())) {
    options.costs = CostSource::measured;
    options.lighting = frames.size() % 2 == 0 ? Lighting::gouraud : Lighting::phong;
    options.regions_per_rank = 1 + static_cast<int>(frames.size()) % 3;
    frames.insert(frames.end(), 2, options);
    options.strategy = "sort-first";
    frames.push_back(options);
  }
  std::vector<Picture> expected;
  for (RenderOptions options : frames) {
    options.strategy = "sort-last";
    expected.push_back(rendered_by_ranks(scene, random_scene_camera(), options).picture);
  }
  comm::run_threads(5, 1, [&](comm::Communicator& communicator) {
    Renderer renderer(scene);
    for (std::size_t i = 0; i < frames.size(); ++i) {
      Result result = renderer.render(communicator, random_scene_camera(), frames[i]);
      if (communicator.rank() != 0) continue;
      EXPECT_TRUE(same_picture_bytes(result.picture, expected[i])) << i;
      renderer.recycle(std::move(result.picture));
    }
  });
}

}  // namespace
}  // namespace delray::raster
