// What sort-last's ranks do in which order.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "comm/forwarding.h"
#include "comm/ledger.h"
#include "comm/recording.h"
#include "comm/threads.h"
#include "raster/render.h"
#include "scenes/generate.h"
#include "tests/raster/kinds_of_picture.h"

namespace delray::raster {
namespace {

struct Recorded {
  Picture picture;
  std::vector<std::vector<comm::Event>> events;  // by rank
};

Recorded recorded(const scenes::Scene& scene, const RenderOptions& options, int ranks) {
  Recorded result;
  result.events.resize(static_cast<std::size_t>(ranks));
  comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
    comm::Recording recording(communicator,
                              result.events[static_cast<std::size_t>(communicator.rank())]);
    Result mine = render(recording, scene, random_scene_camera(), options);
    if (communicator.rank() == 0) result.picture = std::move(mine.picture);
  });
  return result;
}

bool is_tile(const comm::Event& event) {
  return event.kind == comm::Event::Kind::send && event.phase == comm::Phase::compose;
}

RenderOptions tiles_of(int width, int height) {
  RenderOptions options;
  options.width = width;
  options.height = height;
  options.scheme = "tiles";
  return options;
}

TEST(SortLast, HandsTilesOverWhileOthersAreShaded) {
  const scenes::Scene scene = random_scene(7);
  for (const int samples : {1, 2}) {
    SCOPED_TRACE(samples);
    RenderOptions options = tiles_of(300 / samples, 500 / samples);
    options.supersampling = samples;
    const Recorded with_tiles = recorded(scene, options, 3);
    for (const std::vector<comm::Event>& events : with_tiles.events) {
      const auto first_tile = std::find_if(events.begin(), events.end(), is_tile);
      const auto last_fragments =
          std::find_if(events.rbegin(), events.rend(), [](const comm::Event& event) {
            return event.kind == comm::Event::Kind::work && event.work == comm::Work::fragments &&
                   event.amount > 0;
          }).base();
      EXPECT_LT(first_tile - events.begin(), last_fragments - events.begin());
    }
    options.scheme = "tree";
    EXPECT_TRUE(same_bytes(with_tiles.picture, recorded(scene, options, 3).picture));
  }
}

TEST(SortLast, SendsNoPixelsOfTilesWithNothing) {
  scenes::Scene scene = random_scene(8, 1);
  scene.instances.resize(1);
  scene.meshes[0].triangles.resize(1);
  const Recorded result = recorded(scene, tiles_of(300, 200), 4);
  for (std::size_t rank = 1; rank < result.events.size(); ++rank) {
    for (const comm::Event& event : result.events[rank]) {
      if (is_tile(event)) {
        EXPECT_EQ(event.amount, sizeof(int)) << "rank " << rank;
      }
    }
  }
}

Picture by_cell(const scenes::Scene& scene, RenderOptions options, int ranks, int threads = 1) {
  options.blend = Blend::by_cell;
  Picture picture;
  comm::run_threads(ranks, threads, [&](comm::Communicator& communicator) {
    Result mine = render(communicator, scene, random_scene_camera(), options);
    if (communicator.rank() == 0) picture = std::move(mine.picture);
  });
  return picture;
}

struct Difference {
  float colour = 0;        // the largest of a channel
  std::size_t depths = 0;  // pixels that differ
};

template <class Colour>
Difference difference(const Picture& a, const Picture& b) {
  const auto& first = std::get<image::BasicImage<Colour>>(a);
  const auto& second = std::get<image::BasicImage<Colour>>(b);
  Difference result;
  for (std::size_t i = 0; i < first.pixels(); ++i) {
    const Colour &c = first.colour[i], &d = second.colour[i];
    for (const auto channel : {&Colour::r, &Colour::g, &Colour::b, &Colour::a}) {
      const auto off = static_cast<float>(c.*channel) - static_cast<float>(d.*channel);
      result.colour = std::max(result.colour, std::abs(off));
    }
    result.depths += first.depth[i] != second.depth[i];
  }
  return result;
}

RenderOptions small_picture() {
  RenderOptions options;
  options.width = 123;
  options.height = 87;
  return options;
}

// As exact blending but for rounding: of a float at each of up to 9 merges, or to the next code.
TEST(SortLast, BlendsByCellWhatItBlendsByOwner) {
  for (const unsigned seed : {20U, 21U, 22U}) {
    const scenes::Scene scene = transparent_scene(seed);
    RenderOptions options = small_picture();
    options.supersampling = seed == 22 ? 2 : 1;
    for (const bool float_pixels : {true, false}) {
      options.float_pixels = float_pixels;
      const Picture expected = by_cell(scene, options, 1);
      for (const int ranks : {2, 3, 5, 9}) {
        SCOPED_TRACE("seed " + std::to_string(seed) + ", ranks " + std::to_string(ranks));
        for (const char* scheme : {"binary-swap", "direct-send"}) {
          options.scheme = scheme;
          const Picture picture = by_cell(scene, options, ranks);
          const Difference off = float_pixels ? difference<image::RgbaF>(picture, expected)
                                              : difference<image::Rgba8>(picture, expected);
          EXPECT_LE(off.colour, float_pixels ? 3e-6F : 1.0F) << scheme;
          EXPECT_EQ(off.depths, 0U) << scheme;
        }
      }
    }
  }
}

// Where nothing is seen through there is nothing to round.
TEST(SortLast, DrawsOpaqueScenesByCellExactly) {
  const scenes::Scene scene = random_scene(23);
  const RenderOptions options = small_picture();
  const Picture expected = by_cell(scene, options, 1);
  for (const int ranks : {2, 7}) {
    EXPECT_TRUE(same_bytes(by_cell(scene, options, ranks), expected)) << ranks;
  }
}

TEST(SortLast, BlendsByCellTheSameForEveryCodecAndThreadCount) {
  const scenes::Scene scene = transparent_scene(24);
  RenderOptions options = small_picture();
  for (const char* scheme : {"radix-k", "tiles", "bus"}) {
    options.scheme = scheme;
    options.codec = "dense";
    const Picture expected = by_cell(scene, options, 4);
    for (const char* codec : {"active", "bounds", "lz4"}) {
      options.codec = codec;
      EXPECT_TRUE(same_bytes(by_cell(scene, options, 4, 2), expected)) << scheme << codec;
    }
  }
}

TEST(SortLast, BlendsByCellMoreRanksThanTriangles) {
  scenes::Scene scene = transparent_scene(25, 1);
  scene.instances.resize(2);
  const RenderOptions options = small_picture();
  EXPECT_LE(difference<image::Rgba8>(by_cell(scene, options, 7), by_cell(scene, options, 1)).colour,
            1);
}

// A square wall from (-1, -1, 0) to (1, 1, 0), once, looked at from z = 3.
scenes::Scene wall() {
  constexpr std::uint32_t kSide = 65;  // vertices
  scenes::Scene scene = scenes::generate("gen:terrain:2000");
  scenes::Mesh& mesh = scene.meshes[0];
  mesh = {};
  for (std::uint32_t y = 0; y < kSide; ++y) {
    for (std::uint32_t x = 0; x < kSide; ++x) {
      mesh.positions.emplace_back(static_cast<float>(x) / 32 - 1, static_cast<float>(y) / 32 - 1,
                                  0);
    }
  }
  for (std::uint32_t y = 0; y + 1 < kSide; ++y) {
    for (std::uint32_t x = 0; x + 1 < kSide; ++x) {
      const std::uint32_t i = y * kSide + x;
      mesh.triangles.emplace_back(i, i + 1, i + kSide);
      mesh.triangles.emplace_back(i + 1, i + kSide + 1, i + kSide);
    }
  }
  return scene;
}

scenes::Camera camera_before_wall() {
  scenes::Camera camera = scenes::generate("gen:terrain:2000").cameras[0];
  camera.eye = {0, 0, 3};
  camera.at = {0, 0, 0};
  camera.up = {0, 1, 0};
  camera.vertical_fov = 40;
  camera.near = 0.01F;
  return camera;
}

scenes::Scene scene_with_all_in_one_half() {
  scenes::Scene scene = wall();
  glm::mat4x3 behind_the_camera(1.0F);
  behind_the_camera[3].z = 10;
  scene.instances = {{0, glm::mat4x3(1.0F)}, {0, behind_the_camera}};
  return scene;
}

// Two walls, one for each rank: the farther one is hidden, and next to nothing of it is shaded.
TEST(SortLast, ShadesLittleOfWhatAnotherRankHides) {
  scenes::Scene scene = wall();
  glm::mat4x3 behind(1.0F);
  behind[3].z = -0.1F;
  const scenes::Camera camera = camera_before_wall();
  RenderOptions options;
  options.width = options.height = 256;
  for (const bool front_first : {true, false}) {
    scene.instances = {{0, front_first ? glm::mat4x3(1.0F) : behind},
                       {0, front_first ? behind : glm::mat4x3(1.0F)}};
    Statistics statistics[2];
    Picture pictures[2];
    for (const int ranks : {1, 2}) {
      comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
        Result result = render(communicator, scene, camera, options);
        if (communicator.rank() != 0) return;
        statistics[ranks - 1] = std::move(result.statistics);
        pictures[ranks - 1] = std::move(result.picture);
      });
    }
    EXPECT_TRUE(same_bytes(pictures[0], pictures[1]));
    EXPECT_GT(statistics[0].shaded, 30000U);
    EXPECT_LE(statistics[1].shaded, statistics[0].shaded * 101 / 100) << front_first;
  }
}

// More than half of the tiles, but of the last row, which is cut, and so less than half of the
// pixels; and a rank that draws little of that, or nothing.
TEST(SortLast, RanksAgreeOnThePartOfTheFrameThatShows) {
  scenes::Scene scene = wall();
  glm::mat4x3 low(1.0F), little(0.2F), behind_the_camera(1.0F);
  low[0].x = 1.7F, low[1].y = 0.575F, low[3] = {-0.2F, -0.475F, 0};
  little[3] = {-0.2F, -0.475F, 0.1F};
  behind_the_camera[3].z = 10;
  RenderOptions options;
  options.width = 1280;
  options.height = 720;
  for (const glm::mat4x3& other : {little, behind_the_camera}) {
    scene.instances = {{0, low}, {0, other}};
    Picture pictures[2];
    for (const int ranks : {1, 2}) {
      comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
        Renderer renderer(scene);
        for (int frame = 0; frame < 3; ++frame) {
          Result result = renderer.render(communicator, camera_before_wall(), options);
          if (communicator.rank() == 0) pictures[ranks - 1] = std::move(result.picture);
        }
      });
    }
    EXPECT_TRUE(same_bytes(pictures[0], pictures[1]));
  }
}

// Tells a rank that polls for a message nothing until it waits, or waits at once.
class Telling final : public comm::ForwardingCommunicator {
 public:
  Telling(comm::Communicator& inner, bool at_once)
      : ForwardingCommunicator(inner), at_once_(at_once) {}
  std::optional<comm::Envelope> probe(int from, comm::Tag tag, comm::Deadline deadline) override {
    if (deadline.wait != comm::Deadline::now().wait) return inner().probe(from, tag, deadline);
    if (!at_once_) return std::nullopt;
    return inner().probe(from, tag, comm::Deadline::never());
  }

 private:
  const bool at_once_;
};

// A rank that is done before others goes on without knowing what they hide: that changes neither
// pictures nor counts nor messages, though a small wall moves before a large one.
TEST(SortLast, FramesAreTheSameWhenOthersAreLate) {
  scenes::Scene scene = wall();
  glm::mat4x3 small(0.25F);
  small[3].z = 1.5F;
  scene.instances = {{0, glm::mat4x3(1.0F)}, {0, small}};
  for (const int ranks : {2, 3}) {
    std::vector<Picture> pictures[2];
    std::vector<std::uint64_t> counts[2];
    for (const bool at_once : {false, true}) {
      std::vector<std::vector<comm::Event>> events(static_cast<std::size_t>(ranks));
      comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
        Telling telling(communicator, at_once);
        comm::Recording recording(telling, events[static_cast<std::size_t>(communicator.rank())]);
        Renderer renderer(scene);
        for (int frame = 0; frame < 5; ++frame) {
          scenes::Camera camera = camera_before_wall();
          camera.eye.x += 0.3F * static_cast<float>(frame);
          RenderOptions options;
          options.width = 640;
          options.height = 500;
          Result result = renderer.render(recording, camera, options);
          if (communicator.rank() != 0) continue;
          pictures[at_once].push_back(std::move(result.picture));
          for (const RankStatistics& rank : result.statistics.ranks)
            counts[at_once].insert(counts[at_once].end(), {rank.shaded, rank.bytes_sent});
        }
      });
      for (const std::vector<comm::Event>& of_rank : events) {
        for (const comm::Event& event : of_rank) {
          if (event.kind != comm::Event::Kind::send) continue;
          counts[at_once].push_back(event.amount);
          counts[at_once].push_back(static_cast<std::uint64_t>(event.phase));
        }
      }
    }
    EXPECT_EQ(counts[0], counts[1]) << ranks;
    for (std::size_t frame = 0; frame < pictures[0].size(); ++frame)
      EXPECT_TRUE(same_bytes(pictures[0][frame], pictures[1][frame])) << ranks << ' ' << frame;
  }
}

// Of a scene with a wall of many triangles before the camera and as many behind its back the first
// rank has all to shade in the first frame, and half in later ones.
TEST(SortLast, SharesOutWorkByTheFramesBefore) {
  const scenes::Scene scene = scene_with_all_in_one_half();
  const scenes::Camera camera = camera_before_wall();
  RenderOptions options;
  options.width = options.height = 256;
  Picture expected;
  comm::run_threads(1, 1, [&](comm::Communicator& communicator) {
    expected = render(communicator, scene, camera, options).picture;
  });
  for (const char* scheme : {"tiles", "binary-swap", "radix-k"}) {
    options.scheme = scheme;
    // Times vary; the picture does not.
    const bool is_measured = options.scheme == "radix-k";
    options.costs = is_measured ? CostSource::measured : CostSource::model;
    for (const int ranks : {2, 3}) {
      comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
        Renderer renderer(scene);
        for (int frame = 0; frame < 5; ++frame) {
          Result result = renderer.render(communicator, camera, options);
          if (communicator.rank() != 0) continue;
          EXPECT_TRUE(same_bytes(result.picture, expected)) << scheme << ranks;
          if (is_measured) continue;
          std::uint64_t most = 0, all = 0;
          for (const RankStatistics& rank : result.statistics.ranks) {
            most = std::max(most, rank.shaded);
            all += rank.shaded;
          }
          const auto share = static_cast<double>(most) * ranks / static_cast<double>(all);
          if (frame == 0) {
            EXPECT_GT(share, 1.4) << scheme << ranks;
          } else {
            EXPECT_LT(share, 1.25) << scheme << ranks;
          }
          renderer.recycle(std::move(result.picture));
        }
      });
    }
  }
}

// What was drawn before, here or by others, is gone where nothing is drawn now, also in memory that
// ranks know and do not clear.
TEST(SortLast, LeavesNothingOfFramesBefore) {
  // Side by side, one for each rank; they fill more than half of the picture from most places.
  scenes::Scene scene = wall();
  scene.instances.clear();
  for (const float x : {-0.5F, 0.0F, 0.5F}) {
    glm::mat4x3 narrow(1.0F);
    narrow[0].x = 0.4F;
    narrow[3].x = x;
    scene.instances.push_back({0, narrow});
  }
  std::vector<scenes::Camera> cameras(6, camera_before_wall());
  for (std::size_t i = 1; i < 5; ++i) {
    const float moved = 0.25F * static_cast<float>(i) - 0.7F;
    cameras[i].eye.x += moved;
    cameras[i].at.x += moved;
  }
  cameras[5].at = cameras[5].eye * 2.0F;  // nothing is seen
  RenderOptions options;
  options.width = 251;
  options.height = 390;
  std::vector<Picture> expected;
  comm::run_threads(1, 1, [&](comm::Communicator& alone) {
    for (const scenes::Camera& camera : cameras)
      expected.push_back(render(alone, scene, camera, options).picture);
  });
  for (const char* scheme : {"binary-swap", "direct-send", "centralized", "tiles", "pipeline"}) {
    for (const char* codec : {"active", "dense"}) {
      options.scheme = scheme;
      options.codec = codec;
      comm::run_threads(3, 1, [&](comm::Communicator& communicator) {
        Renderer renderer(scene);
        std::mt19937 random(7);  // the same on all ranks
        for (int frame = 0; frame < 16; ++frame) {
          const std::size_t camera = random() % cameras.size();
          RenderOptions now = options;
          const char* const others[] = {"sort-first", "hybrid", "sort-middle"};
          now.strategy = random() % 4 == 0 ? others[random() % 3] : "sort-last";
          Result result = renderer.render(communicator, cameras[camera], now);
          if (communicator.rank() != 0) continue;
          ASSERT_TRUE(same_bytes(result.picture, expected[camera]))
              << scheme << ", " << codec << ", frame " << frame << ", camera " << camera;
          if (frame % 5 != 4) renderer.recycle(std::move(result.picture));
        }
      });
    }
  }
}

}  // namespace
}  // namespace delray::raster
