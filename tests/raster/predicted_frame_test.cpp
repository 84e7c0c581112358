// Predictions of frames: ranks that only count do what ranks that draw do, parts of a rank's time
// add up, and prices are found again.
#include "raster/predicted_frame.h"

#include <gtest/gtest.h>

#include <cstring>
#include <numeric>
#include <tuple>

#include "comm/collectives.h"
#include "comm/threads.h"
#include "raster/simulated_frames.h"
#include "raster/strategies.h"
#include "scenes/camera_path.h"
#include "tests/raster/allow_threads.h"
#include "tests/raster/random_scene.h"

namespace delray::raster {
namespace {

// All that is counted of a rank, hidden triangles' order aside.
auto counts_of(const RankStatistics& rank) {
  return std::tuple(rank.rank, rank.tasks, rank.triangles_in, rank.triangles, rank.shaded,
                    rank.bytes_sent, rank.bytes_received, rank.messages);
}

std::vector<scenes::Camera> cameras() {
  const std::vector<scenes::Camera> around = scenes::turntable(random_scene_camera(), 30);
  return {around[0], around[0], around[0], around[1], around[2]};
}

RenderOptions options_of(const Strategy& strategy) {
  RenderOptions options;
  options.width = 150;
  options.height = 110;
  options.strategy = strategy.name;
  options.codec = "active";
  options.redistribution = Redistribution::at_end;
  return options;
}

// The frames by threads, as they are drawn every day.
std::vector<Statistics> drawn(const scenes::Scene& scene, const RenderOptions& options, int ranks) {
  std::vector<Statistics> result;
  comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
    Renderer renderer(scene);
    for (const scenes::Camera& camera : cameras()) {
      Result frame = renderer.render(communicator, camera, options);
      if (communicator.rank() == 0) result.push_back(std::move(frame.statistics));
      renderer.recycle(std::move(frame.picture));
    }
  });
  return result;
}

SimulatedFrames simulated(const scenes::Scene& scene, const RenderOptions& options, int ranks) {
  const std::vector<scenes::Camera> all = cameras();
  return simulate_frames({scene, nullptr, all, all.size() - 1}, options, ranks, nullptr);
}

class PredictedFrames : public testing::TestWithParam<const Strategy*> {};

TEST_P(PredictedFrames, CountWhatRanksThatDrawCount) {
  RenderOptions options = options_of(*GetParam());
  for (const unsigned seed : {11U}) {
    const scenes::Scene scene = random_scene(seed, 200);
    for (const int ranks : {1, 2, 3, 7, 16}) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", ranks " + std::to_string(ranks));
      options.count_only.reset();
      const std::vector<Statistics> expected = drawn(scene, options, ranks);
      options.count_only = composite::LayerCosts{};
      const SimulatedFrames counted = simulated(scene, options, ranks);
      ASSERT_EQ(counted.frames.size(), expected.size());
      for (std::size_t i = 0; i < expected.size(); ++i) {
        const Statistics& statistics = counted.frames[i].statistics;
        ASSERT_EQ(statistics.ranks.size(), static_cast<std::size_t>(ranks));
        for (std::size_t k = 0; k < statistics.ranks.size(); ++k)
          EXPECT_EQ(counts_of(statistics.ranks[k]), counts_of(expected[i].ranks[k]))
              << "frame " << i;
        EXPECT_EQ(statistics.triangles_travelled, expected[i].triangles_travelled);
        EXPECT_EQ(statistics.fragments_travelled, expected[i].fragments_travelled);
      }
    }
  }
}

TEST_P(PredictedFrames, HavePartsThatAddUp) {
  const scenes::Scene scene = random_scene(5, 200);
  for (const int ranks : {1, 6}) {
    const SimulatedFrames frames = simulated(scene, options_of(*GetParam()), ranks);
    for (const SimulatedFrame& frame : frames.frames) {
      for (const comm::NamedNetwork& named : comm::default_networks()) {
        const PredictedFrame predicted = predict(frame, named.network);
        EXPECT_GT(predicted.seconds, 0);
        EXPECT_NEAR(std::accumulate(predicted.parts.begin(), predicted.parts.end(), 0.0),
                    predicted.seconds, 1e-9);
        for (const double part : predicted.parts) EXPECT_GE(part, -1e-12);
        EXPECT_GT(predicted[Part::rasterize] + predicted[Part::shade], 0);
        if (ranks == 1) {
          EXPECT_NEAR(predicted[Part::waiting], 0, 1e-12);
        } else {
          EXPECT_GT(predicted[Part::gather], 0);
        }
      }
    }
  }
}

TEST_P(PredictedFrames, ShowThePictureThatWasAskedFor) {
  const scenes::Scene scene = random_scene(8);
  const RenderOptions options = options_of(*GetParam());
  const std::vector<scenes::Camera> all = cameras();
  comm::run_threads(1, 1, [&](comm::Communicator& communicator) {
    const Result last = render(communicator, scene, all.back(), options);
    const auto& expected = std::get<image::Image8>(last.picture);
    const SimulatedFrames frames = simulated(scene, options, 3);
    const auto& shown = std::get<image::Image8>(frames.picture);
    ASSERT_EQ(shown.pixels(), expected.pixels());
    EXPECT_EQ(std::memcmp(shown.colour.data(), expected.colour.data(),
                          expected.colour.span().size_bytes()),
              0);
  });
}

INSTANTIATE_TEST_SUITE_P(OfAll, PredictedFrames, testing::ValuesIn([] {
                           std::vector<const Strategy*> all;
                           for (const Strategy& strategy : strategies()) all.push_back(&strategy);
                           return all;
                         }()),
                         [](const auto& tested) {
                           std::string name = tested.param->name;
                           std::erase(name, '-');
                           return name;
                         });

// Frames of ranks with these counts, that take what the prices say.
std::vector<SimulatedFrame> priced_frames(const DrawingPrices& prices, std::uint64_t primitives) {
  std::mt19937 random(7);
  std::vector<SimulatedFrame> frames;
  for (const int ranks : {4, 8, 16}) {
    SimulatedFrame& frame = frames.emplace_back();
    for (int k = 0; k < ranks; ++k) {
      RankStatistics& rank = frame.statistics.ranks.emplace_back();
      rank.rank = k;
      rank.triangles_in = random() % 100'000;
      rank.triangles = random() % 50'000;
      rank.shaded = random() % 200'000;
      rank.busy = drawing_seconds(prices, rank, ranks, primitives);
      rank.phases.shade = rank.busy;
      frame.drawing.push_back(rank.busy);
    }
  }
  return frames;
}

TEST(DrawingPrices, AreFoundAgain) {
  constexpr std::uint64_t kPrimitives = 1'000'000;
  const DrawingPrices prices{{1e-4, 3e-9, 5e-9, 2e-8, 1e-8}};
  const std::vector<SimulatedFrame> frames = priced_frames(prices, kPrimitives);
  const DrawingPrices fitted = fit_prices(frames, kPrimitives);
  for (const SimulatedFrame& frame : frames) {
    const int ranks = static_cast<int>(frame.statistics.ranks.size());
    for (const RankStatistics& rank : frame.statistics.ranks)
      EXPECT_NEAR(drawing_seconds(fitted, rank, ranks, kPrimitives) / rank.busy, 1, 1e-2);
  }
  for (const double price : fitted.seconds) EXPECT_GE(price, 0);
  EXPECT_EQ(fit_prices({}, kPrimitives).seconds, DrawingPrices{}.seconds);
}

TEST(DrawingPrices, TakeThePlaceOfWhatWasMeasuredInDrawingAlone) {
  SimulatedFrame frame;
  RankStatistics& rank = frame.statistics.ranks.emplace_back();
  rank.shaded = 1000;
  rank.busy = rank.phases.shade = 0.003;
  frame.drawing = {0.004};
  const auto work = [](comm::Phase phase, std::uint64_t amount) {
    comm::Event event;
    event.kind = comm::Event::Kind::work;
    event.phase = phase;
    event.amount = amount;
    return event;
  };
  frame.ledger.ranks = {{work(comm::Phase::rasterize, 4'000'000),
                         work(comm::Phase::redistribute, 3'000'000),
                         work(comm::Phase::gather, 2'000'000)}};
  DrawingPrices prices;
  prices.seconds = {0, 0, 0, 0, 1e-6};
  apply_prices(prices, 10, frame);
  const std::vector<comm::Event>& events = frame.ledger.ranks[0];
  EXPECT_EQ(events[0].amount, 1'000'000U);
  EXPECT_EQ(events[1].amount, 3'000'000U);
  EXPECT_EQ(events[2].amount, 2'000'000U);
  prices.seconds = {1, 0, 0, 0, 0};  // more than it took
  apply_prices(prices, 10, frame);
  EXPECT_EQ(events[0].amount, 1'000'000U);
  const PredictedFrame predicted = predict(frame, {});
  EXPECT_DOUBLE_EQ(predicted.seconds, 0.006);
  EXPECT_DOUBLE_EQ(predicted[Part::shade], 0.00075);
  EXPECT_DOUBLE_EQ(predicted[Part::prepare], 0.00025);
  EXPECT_DOUBLE_EQ(predicted[Part::redistribute], 0.003);
  EXPECT_DOUBLE_EQ(predicted[Part::gather], 0.002);
}

}  // namespace
}  // namespace delray::raster
