// The raster cost model (Mueller 1995) fitted to measurements, and costs corrected by the times of
// the last frame.
//
// The fit solves the two normal equations of linear least squares. The correction scales each cell
// and box by the mean, over its pixels, of measured over predicted time of the owners in the last
// partition. The fit is O(samples); the correction looks at the regions near each cell and box.
//
// Degenerate: samples in one proportion leave the normal equations singular, and then the default
// ratio of prices is kept; a price that would be negative becomes 0; owners without time or cost
// are scaled as the average.
#include "loadbalance/cost_model.h"

#include <algorithm>
#include <stdexcept>

#include "loadbalance/region_index.h"

namespace delray::loadbalance {

bool has_seconds(std::span<const RasterSample> samples) {
  return std::any_of(samples.begin(), samples.end(),
                     [](const RasterSample& sample) { return sample.seconds > 0; });
}

RasterCostModel fit(std::span<const RasterSample> samples) {
  const RasterCostModel model;
  double tt = 0, tp = 0, pp = 0, ts = 0, ps = 0, seconds = 0, modelled = 0;
  for (const RasterSample& s : samples) {
    tt += s.triangles * s.triangles;
    tp += s.triangles * s.pixels;
    pp += s.pixels * s.pixels;
    ts += s.triangles * s.seconds;
    ps += s.pixels * s.seconds;
    seconds += s.seconds;
    modelled += model(s.triangles, s.pixels);
  }
  if (!(seconds > 0) || !(modelled > 0)) return model;
  // Below this the samples lie on a line through the origin, up to rounding.
  constexpr double kLeastAngle = 1e-9;
  const double determinant = tt * pp - tp * tp;
  if (!(determinant > kLeastAngle * tt * pp)) {
    const double scale = seconds / modelled;
    return {model.per_triangle * scale, model.per_pixel * scale};
  }
  const double per_triangle = (ts * pp - ps * tp) / determinant;
  const double per_pixel = (ps * tt - ts * tp) / determinant;
  if (per_triangle < 0) return {0, ps / pp};
  if (per_pixel < 0) return {ts / tt, 0};
  return {per_triangle, per_pixel};
}

void scale_to_measured(Costs& costs, const Partition& last, std::span<const double> seconds) {
  if (!(last.frame == costs.frame))
    throw std::invalid_argument("the last partition is of another frame than the costs");
  const std::vector<double> predicted = loads(costs, last, static_cast<int>(seconds.size()));
  double all_seconds = 0, all_predicted = 0;
  for (std::size_t k = 0; k < seconds.size(); ++k) {
    if (!(seconds[k] > 0) || !(predicted[k] > 0)) continue;
    all_seconds += seconds[k];
    all_predicted += predicted[k];
  }
  if (!(all_predicted > 0)) return;
  std::vector<double> scale(seconds.size(), all_seconds / all_predicted);
  for (std::size_t k = 0; k < seconds.size(); ++k) {
    if (seconds[k] > 0 && predicted[k] > 0) scale[k] = seconds[k] / predicted[k];
  }

  const RegionIndex index(last);
  // The mean over the pixels of a rectangle, which is what loads() goes by.
  const auto scale_of = [&](const geometry::Rect& rect) {
    double sum = 0;
    std::int64_t pixels = 0;
    index.for_each_region(rect, [&](const Region& region, const geometry::Rect& common) {
      sum += scale[region.owner] * static_cast<double>(common.area());
      pixels += common.area();
    });
    return pixels > 0 ? sum / static_cast<double>(pixels) : 1;
  };
  std::size_t k = 0;
  for (int j = 0; j < costs.rows; ++j) {
    for (int i = 0; i < costs.columns; ++i, ++k) {
      const double factor = scale_of(costs.cell(i, j));
      costs.cells[k] *= factor;
      costs.cross_right[k] *= factor;
      costs.cross_down[k] *= factor;
    }
  }
  for (WeightedBox& box : costs.boxes) {
    const double factor = scale_of(box.box);
    box.cost *= factor;
    box.setup *= factor;
  }
}

}  // namespace delray::loadbalance
