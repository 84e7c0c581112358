// Cost models are found again from samples, and costs follow measurements.
#include "loadbalance/cost_model.h"

#include <gtest/gtest.h>

#include <random>

namespace delray::loadbalance {
namespace {

TEST(RasterCostModel, IsFoundAgainFromExactSamples) {
  const RasterCostModel truth{50e-9, 2e-9};
  std::vector<RasterSample> samples;
  std::mt19937 random(3);
  for (int k = 0; k < 20; ++k) {
    const double triangles = random() % 100000, pixels = random() % 1000000;
    samples.push_back({triangles, pixels, truth(triangles, pixels)});
  }
  const RasterCostModel model = fit(samples);
  EXPECT_NEAR(model.per_triangle / truth.per_triangle, 1, 1e-9);
  EXPECT_NEAR(model.per_pixel / truth.per_pixel, 1, 1e-9);
}

TEST(RasterCostModel, IsNeverNegative) {
  const RasterSample falling[] = {{1, 1, 2}, {2, 1, 1}};  // more triangles take less
  EXPECT_EQ(fit(falling).per_triangle, 0);
  EXPECT_GT(fit(falling).per_pixel, 0);
  const RasterSample shrinking[] = {{1, 1, 2}, {1, 2, 1}};
  EXPECT_EQ(fit(shrinking).per_pixel, 0);
  EXPECT_GT(fit(shrinking).per_triangle, 0);
}

TEST(RasterCostModel, KeepsTheRatioWhereSamplesDoNotTell) {
  const RasterCostModel standard;
  for (const std::vector<RasterSample>& samples :
       {std::vector<RasterSample>{{10, 100, 3}}, std::vector<RasterSample>{{1, 2, 3}, {2, 4, 6}},
        std::vector<RasterSample>{{0, 7, 3}, {0, 9, 1}}}) {
    const RasterCostModel model = fit(samples);
    EXPECT_DOUBLE_EQ(model.per_triangle / model.per_pixel,
                     standard.per_triangle / standard.per_pixel);
    double modelled = 0, seconds = 0;
    for (const RasterSample& s : samples) {
      modelled += model(s.triangles, s.pixels);
      seconds += s.seconds;
    }
    EXPECT_DOUBLE_EQ(modelled, seconds);
  }
  for (const std::vector<RasterSample>& samples :
       {std::vector<RasterSample>{}, std::vector<RasterSample>{{5, 5, 0}},
        std::vector<RasterSample>{{0, 0, 3}}}) {
    EXPECT_EQ(fit(samples).per_triangle, standard.per_triangle);
  }
}

TEST(ScaleToMeasured, MakesThePredictionAgree) {
  const std::vector<WeightedBox> boxes = {
      {{0, 0, 2, 2}, 8, 2}, {{2, 0, 4, 2}, 8, 2}, {{5, 0, 6, 1}, 4}};
  Costs costs = make_costs({0, 0, 8, 2}, 8, 2, boxes);
  const Partition last{
      costs.frame, {{{0, 0, 2, 2}, 0}, {{2, 0, 4, 2}, 1}, {{4, 0, 6, 2}, 0}, {{6, 0, 8, 2}, 2}}};
  const std::vector<double> seconds{3, 1, 0.5};
  scale_to_measured(costs, last, seconds);
  const std::vector<double> now = loads(costs, last, 3);
  EXPECT_NEAR(now[0], 3, 1e-12);
  EXPECT_NEAR(now[1], 1, 1e-12);
  EXPECT_EQ(now[2], 0);  // nothing there that could have taken half a second
  EXPECT_NEAR(costs.boxes[0].cost, 2, 1e-12);
  EXPECT_NEAR(costs.boxes[0].setup, 0.5, 1e-12);
  EXPECT_NEAR(costs.boxes[1].cost, 1, 1e-12);
  EXPECT_NEAR(costs.boxes[2].cost, 1, 1e-12);
}

TEST(ScaleToMeasured, LeavesCostsAloneWithoutMeasurements) {
  Costs costs = make_costs({0, 0, 2, 1}, 2, 1, {});
  costs.cells = {3, 5};
  const Partition last{costs.frame, {{{0, 0, 1, 1}, 0}, {{1, 0, 2, 1}, 1}}};
  scale_to_measured(costs, last, std::vector<double>{0, 0});
  EXPECT_EQ(costs.cells, (std::vector<double>{3, 5}));
  scale_to_measured(costs, last, std::vector<double>{6, 0});  // the second as the average
  EXPECT_EQ(costs.cells, (std::vector<double>{6, 10}));
}

}  // namespace
}  // namespace delray::loadbalance
