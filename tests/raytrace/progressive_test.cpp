#include "raytrace/progressive.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "comm/threads.h"
#include "loadbalance/wall.h"
#include "raytrace/shared_scene.h"
#include "tests/raytrace/small_scenes.h"

namespace delray::raytrace {
namespace {

// A glass ball and a matt one over a floor, under an area light.
scenes::Scene balls() {
  scenes::Scene scene;
  add(scene, quad({-4, -1, 4}, {8, 0, 0}, {0, 0, -8})).base_colour = {0.7F, 0.6F, 0.5F, 1.0F};
  scenes::Material& glass = add(scene, sphere(12), placed(1.0F, {-0.8F, 0, 0}));
  glass.transmission = 1.0F;
  glass.roughness = 0.0F;
  add(scene, sphere(12), placed(0.7F, {1, -0.3F, 0.8F})).base_colour = {0.2F, 0.4F, 0.8F, 1.0F};
  scenes::Light light;
  light.kind = scenes::Light::Kind::area;
  light.colour = glm::vec3(6.0F);
  light.position = {-1, 3, -1};
  light.edge_u = {2, 0, 0};
  light.edge_v = {0, 0, 2};
  scene.lights.push_back(light);
  scene.environment.zenith = scene.environment.horizon = glm::vec3(0.2F);
  return scene;
}

scenes::Camera before_balls() {
  scenes::Camera camera;
  camera.eye = {0, 1.5F, 6};
  return camera;
}

ProgressiveOptions balls_of(int samples) {
  ProgressiveOptions options;
  options.frame.width = 70;
  options.frame.height = 50;
  options.frame.samples = samples;
  return options;
}

const Tracer& tracer() {
  static const scenes::Scene scene = balls();
  static const Tracer made = make_tracer(scene);
  return made;
}

ProgressiveResult render_by(int ranks, const ProgressiveOptions& options) {
  ProgressiveResult result;
  comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
    Renderer renderer(tracer());
    ProgressiveResult mine = render_progressively(communicator, renderer, before_balls(), options);
    if (communicator.rank() == 0) result = std::move(mine);
  });
  return result;
}

void expect_same(const image::ImageF& a, const image::ImageF& b) {
  ASSERT_EQ(a.width, b.width);
  ASSERT_EQ(a.height, b.height);
  for (std::size_t i = 0; i < a.pixels(); ++i) {
    ASSERT_EQ(a.colour[i], b.colour[i]) << "pixel " << i;
    ASSERT_EQ(a.depth[i], b.depth[i]) << "pixel " << i;
  }
}

// All that ranks count of a scene that is shared out, as far as the same is counted every time.
std::vector<std::uint64_t> counts_of(const ProgressiveOptions& options, const char* data) {
  std::vector<std::uint64_t> counts(6, 0);
  comm::run_threads(3, 1, [&](comm::Communicator& communicator) {
    ShareOptions share;
    share.cache_bytes = 1;
    SharedScene shared = SharedScene::make(communicator, balls(), share);
    Renderer renderer(shared, *find_distribution(data));
    const ProgressiveResult result =
        render_progressively(communicator, renderer, before_balls(), options);
    for (const RankStatistics& rank : result.statistics.ranks) {
      counts[0] += rank.rays_sent;
      counts[1] += rank.answers_sent;
      counts[2] += rank.tests;
      counts[3] += rank.clusters_fetched;
      counts[4] += rank.clusters_fetched_bytes;
      counts[5] += rank.clusters_dropped;
    }
  });
  return counts;
}

TEST(Progressive, CountsOfAllPassesAreAddedUp) {
  for (const char* data : {"ray", "object"}) {
    ProgressiveOptions options = balls_of(4);
    const std::vector<std::uint64_t> one = counts_of(options, data);
    options.frame.samples = 16;
    const std::vector<std::uint64_t> four = counts_of(options, data);
    for (std::size_t i = 0; i < one.size(); ++i) {
      EXPECT_GE(four[i], 2 * one[i]) << data << " " << i;
      EXPECT_LE(four[i], 8 * one[i]) << data << " " << i;
    }
    EXPECT_GT(one[2], 0U);
  }
}

TEST(Progressive, IsThePictureOfOneCall) {
  const ProgressiveOptions options = balls_of(16);
  const ProgressiveResult result = render_by(1, options);
  EXPECT_EQ(result.passes, 4);
  EXPECT_FALSE(result.out_of_time);
  image::ImageF whole;
  comm::run_threads(1, 1, [&](comm::Communicator& communicator) {
    whole = render(communicator, tracer(), before_balls(), options.frame).image;
  });
  for (std::size_t i = 0; i < whole.pixels(); ++i) {
    ASSERT_NEAR(whole.colour[i].g, result.image.colour[i].g, 1e-5F);
    ASSERT_EQ(whole.depth[i], result.image.depth[i]);
  }
  EXPECT_EQ(result.film.total_samples(), 70U * 50U * 16U);
}

TEST(Progressive, IsTheSamePictureWithoutAFilm) {
  for (const int samples : {1, 2, 3, 4, 5}) {
    ProgressiveOptions options = balls_of(samples);
    options.window = {3, 5, 41, 50};
    const ProgressiveResult with = render_by(2, options);
    options.film = false;
    const ProgressiveResult without = render_by(3, options);
    expect_same(with.image, without.image);
    EXPECT_EQ(with.statistics.rays, without.statistics.rays);
    EXPECT_EQ(with.passes, without.passes);
  }
}

TEST(Progressive, RanksGiveTheSameBytes) {
  ProgressiveOptions options = balls_of(12);
  options.features = true;
  const ProgressiveResult one = render_by(1, options), three = render_by(3, options);
  expect_same(one.image, three.image);
  EXPECT_EQ(one.features.albedo, three.features.albedo);
  EXPECT_EQ(one.features.normal, three.features.normal);
  EXPECT_EQ(one.features.instance, three.features.instance);
  EXPECT_EQ(one.statistics.rays, three.statistics.rays);
  EXPECT_EQ(three.statistics.ranks.size(), 3U);
}

TEST(Progressive, GoesOnFromAFilmAsIfNothingHadHappened) {
  ProgressiveOptions options = balls_of(24);
  options.noise = 0.004F;
  std::vector<Film> films;
  options.after_pass = [&](const Film& film) { films.push_back(film); };
  const ProgressiveResult whole = render_by(2, options);
  ASSERT_GE(films.size(), 5U);
  for (const std::size_t from : {std::size_t{0}, std::size_t{3}, films.size() - 1}) {
    ProgressiveOptions later = balls_of(24);
    later.noise = options.noise;
    const Film saved = films[from];
    later.resume = &saved;
    const ProgressiveResult resumed = render_by(1, later);
    expect_same(whole.image, resumed.image);
    EXPECT_EQ(whole.film.total_samples(), resumed.film.total_samples());
    EXPECT_EQ(resumed.passes, static_cast<int>(films.size() - 1 - from));
  }
}

TEST(Progressive, AnInterruptionHandsOverTheFilm) {
  ProgressiveOptions options = balls_of(64);
  parallel::Progress progress;
  options.frame.progress = &progress;
  int passes = 0;
  std::uint64_t saved = 0;
  options.after_pass = [&](const Film&) {
    if (++passes == 3) progress.request_stop();
  };
  options.on_interruption = [&](const Film& film) { saved = film.total_samples(); };
  EXPECT_THROW(render_by(1, options), parallel::Interrupted);
  EXPECT_EQ(passes, 3);
  EXPECT_EQ(saved, 70U * 50U * 12U);
}

// A bar that shows done over total estimates the time that is left by it.
TEST(Progressive, ProgressCountsTheSamplesThatAreExpected) {
  parallel::Progress progress;
  ProgressiveOptions options = balls_of(256);
  options.noise = 0.004F;
  options.frame.progress = &progress;
  std::vector<std::uint64_t> expected;
  options.after_pass = [&](const Film&) { expected.push_back(progress.total()); };
  const ProgressiveResult result = render_by(1, options);
  EXPECT_EQ(expected.front(), 70U * 50U * 256U);  // nothing is known of the noise
  EXPECT_EQ(progress.done(), result.film.total_samples());
  EXPECT_EQ(progress.total(), progress.done());
  ASSERT_GE(expected.size(), 6U);
  EXPECT_LT(expected[5], expected[0]);
  EXPECT_NEAR(static_cast<double>(expected[5]) / static_cast<double>(progress.done()), 1.0, 0.3);
}

TEST(Progressive, ProgressExpectsNoMoreThanTimeAllows) {
  parallel::Progress progress;
  ProgressiveOptions options = balls_of(60000);
  options.seconds = 0.2;
  options.frame.progress = &progress;
  const ProgressiveResult result = render_by(1, options);
  EXPECT_TRUE(result.out_of_time);
  EXPECT_LT(progress.total(), 70U * 50U * 60000U);
  EXPECT_EQ(progress.done(), result.film.total_samples());
}

TEST(Progressive, AWindowShowsWhatTheWholePictureShowsThere) {
  ProgressiveOptions options = balls_of(8);
  options.features = true;
  const ProgressiveResult whole = render_by(1, options);
  for (const geometry::Rect window : {geometry::Rect{20, 10, 53, 41}, geometry::Rect{0, 0, 1, 1},
                                      geometry::Rect{69, 20, 70, 50}}) {
    options.window = window;
    const ProgressiveResult part = render_by(2, options);
    expect_same(cut(mean(whole.film), {0, 0, 70, 50}, window), part.image);
    EXPECT_EQ(part.features.albedo.size(), static_cast<std::size_t>(window.area()));
    EXPECT_LT(part.statistics.rays.primary, whole.statistics.rays.primary);
  }
}

TEST(Progressive, NoiseDecidesWhoGetsMoreSamples) {
  ProgressiveOptions options = balls_of(64);
  options.noise = 0.01F;
  const ProgressiveResult result = render_by(1, options);
  std::uint32_t least = 1000, most = 0;
  const std::vector<float> left = noise(result.film);
  for (std::size_t c = 0; c < left.size(); ++c) {
    least = std::min(least, result.film.samples()[c]);
    most = std::max(most, result.film.samples()[c]);
    if (result.film.samples()[c] < 64) {
      EXPECT_TRUE(std::isfinite(left[c]));
    }
  }
  EXPECT_GE(least, 16U);  // enough to tell
  EXPECT_LT(least, most);
}

TEST(Progressive, TimeRunsOutAfterTheFirstPassAtTheEarliest) {
  ProgressiveOptions options = balls_of(4096);
  options.seconds = 0.0;
  const ProgressiveResult result = render_by(2, options);
  EXPECT_TRUE(result.out_of_time);
  EXPECT_EQ(result.passes, 1);
  EXPECT_EQ(result.film.total_samples(), 70U * 50U * 4U);
}

TEST(Progressive, FeaturesSayWhatIsSeen) {
  ProgressiveOptions options = balls_of(4);
  options.features = true;
  const ProgressiveResult result = render_by(1, options);
  const std::size_t sky = 35, floor = 49 * 70 + 35;
  EXPECT_EQ(result.features.instance[sky], kMiss);
  EXPECT_EQ(result.features.normal[sky], glm::vec3(0.0F));
  EXPECT_EQ(result.features.instance[floor], 0U);
  EXPECT_EQ(result.features.material[floor], 0U);
  EXPECT_NEAR(result.features.normal[floor].y, 1.0F, 1e-4F);
  EXPECT_NEAR(result.features.albedo[floor].x, 0.7F, 1e-5F);
  float rays = 0.0F;
  for (std::size_t c = 0; c < result.film.costs().size(); ++c) {
    rays += result.film.costs()[c].rays * static_cast<float>(result.film.cell(c).area());
  }
  EXPECT_GT(rays, 4.0F * 70 * 50);
}

// Tiles straddle displays and what is hidden between them; of three samples there is a film.
TEST(Progressive, AWallShowsThePicture) {
  for (const char* data : {"replicated", "object", "ring"}) {
    for (const int samples : {1, 3}) {
      ProgressiveOptions options = balls_of(samples);
      options.film = false;
      const image::ImageF whole = render_by(1, options).image;
      const loadbalance::Wall wall{3, 2, 21, 23, 3, 4};
      for (const int ranks : {1, 2, 5, 7}) {
        options.frame.displays = loadbalance::displays_of(wall, ranks);
        comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
          const bool is_shared = std::string(data) != "replicated";
          std::optional<SharedScene> shared;
          if (is_shared) shared.emplace(SharedScene::make(communicator, balls(), {}));
          Renderer renderer =
              is_shared ? Renderer(*shared, *find_distribution(data)) : Renderer(tracer());
          const ProgressiveResult result =
              render_progressively(communicator, renderer, before_balls(), options);
          EXPECT_EQ(result.image.pixels(), 0U);
          std::size_t k = 0;
          for (const loadbalance::Region& display : options.frame.displays) {
            if (display.owner != communicator.rank()) continue;
            ASSERT_LT(k, result.shown.size());
            const image::ImageF& shown = result.shown[k++];
            const geometry::Rect& rect = display.rect;
            for (int y = rect.y0; y < rect.y1; ++y) {
              for (int x = rect.x0; x < rect.x1; ++x) {
                const auto i = static_cast<std::size_t>((y - rect.y0) * shown.width + x - rect.x0);
                const auto j = static_cast<std::size_t>(y * whole.width + x);
                ASSERT_EQ(shown.colour[i], whole.colour[j]) << data << " " << x << " " << y;
                ASSERT_EQ(shown.depth[i], whole.depth[j]) << data << " " << x << " " << y;
              }
            }
          }
          EXPECT_EQ(k, result.shown.size());
        });
      }
      options.frame.displays = {{{0, 0, 71, 10}, 0}};
      EXPECT_THROW(render_by(1, options), std::invalid_argument);
    }
  }
}

// Left between any two parts of passes and gone on from, a picture is the one that was never left.
TEST(Progressive, GoesOnFromWhereItWasLeft) {
  for (const float noise : {0.0F, 0.02F}) {
    ProgressiveOptions whole = balls_of(24);
    whole.noise = noise;
    const ProgressiveResult expected = render_by(1, whole);
    for (const int ranks : {1, 3}) {
      Film film;
      std::vector<std::uint8_t> cells_left;
      int calls = 0, passes = 0;
      ProgressiveResult result;
      do {
        ProgressiveOptions part = whole;
        part.part_seconds = 1e-9;  // a cell at a time
        int parts = 0;
        part.goes_on = [&] { return ++parts <= 7; };
        part.after_pass = [&](const Film&) { ++passes; };
        if (calls > 0) part.resume = &film;
        part.resume_cells = cells_left;
        result = render_by(ranks, part);
        film = result.film;
        cells_left = result.cells_left;
        ++calls;
      } while (result.stopped);
      EXPECT_GT(calls, 3);
      EXPECT_EQ(passes, expected.passes);
      EXPECT_FALSE(result.out_of_time);
      expect_same(result.image, expected.image);
    }
  }
}

}  // namespace
}  // namespace delray::raytrace
