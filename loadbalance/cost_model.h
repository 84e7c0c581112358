// The cost of rasterization, from what is known before it: triangles and pixels.
#pragma once

#include <span>

#include "loadbalance/partition.h"

namespace delray::loadbalance {

// Each triangle is set up and each pixel that it covers is filled, at a fixed price (Mueller 1995).
// In any unit: only ratios matter to partitions. The default prices are for comparisons of
// partitions by themselves; the rasterizer takes those of raster::cost_model(), by its lighting.
struct RasterCostModel {
  double per_triangle = 0.5;
  double per_pixel = 1;

  bool operator==(const RasterCostModel&) const = default;
  double setup(double triangles) const { return per_triangle * triangles; }
  double operator()(double triangles, double pixels) const {
    return setup(triangles) + per_pixel * pixels;
  }
};

// The work of one owner and how long it took.
struct RasterSample {
  double triangles = 0, pixels = 0, seconds = 0;
};

// Whether anybody took any time.
bool has_seconds(std::span<const RasterSample> samples);

// The model that comes nearest to the samples by least squares, neither price below 0. Where the
// samples do not tell the two prices apart (one sample, or all in one proportion) the ratio of the
// default model is kept; without any seconds, the default.
RasterCostModel fit(std::span<const RasterSample> samples);

// Makes costs agree with the last frame: `seconds[i]` is what owner i of `last` took for its
// regions, and cells and boxes are scaled by the mean of what their pixels took, such that
// regions of whole cells that did not change cost just that. Owners that took no time or had no
// cost keep their costs, scaled as the average. REQUIRES: seconds are finite and >= 0; last.frame
// == costs.frame.
void scale_to_measured(Costs& costs, const Partition& last, std::span<const double> seconds);

}  // namespace delray::loadbalance
