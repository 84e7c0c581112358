// Sets of boxes as scenes make them, for tests of partitions.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "loadbalance/costs.h"

namespace delray::loadbalance::testing {

// Where boxes lie and how large they are: alike everywhere; of heavy-tailed size (Pareto); a plain
// seen in perspective, with ever more and ever smaller boxes towards the horizon; clusters.
enum class Scenery { uniform, heavy_tailed, horizon, clusters };
inline constexpr Scenery kSceneries[] = {Scenery::uniform, Scenery::heavy_tailed, Scenery::horizon,
                                         Scenery::clusters};

// Each box a triangle: it costs a setup of 0.5 and half the pixels of the box.
inline std::vector<WeightedBox> boxes(Scenery scenery, const geometry::Rect& frame, int count,
                                      unsigned seed) {
  std::mt19937 random(seed);
  const auto number = [&] { return std::uniform_real_distribution<double>(0, 1)(random); };
  const double width = frame.width(), height = frame.height();
  std::vector<WeightedBox> result;
  for (int k = 0; k < count; ++k) {
    double x = width * number(), y = height * number(), side = 2;
    if (scenery == Scenery::heavy_tailed)
      side = std::min(height / 2, 1.5 * std::pow(number(), -0.7));
    if (scenery == Scenery::horizon) {
      const double distance = 1 / (0.02 + 0.98 * number());
      y = height * (0.4 + 0.6 / distance);
      side = std::max(1.0, 20 / distance);
    }
    if (scenery == Scenery::clusters) {
      const int cluster = static_cast<int>(6 * number());
      const double radius = height * (0.05 + 0.02 * cluster);
      const auto bell = [&] { return number() + number() + number() - 1.5; };
      x = width * (0.15 + 0.12 * cluster) + radius * bell();
      y = height * (0.2 + 0.6 * (cluster % 3) / 2) + radius * bell();
      side = 1 + 8 * number() * number();
    }
    const int w = std::max(1, static_cast<int>(side * (0.5 + number())));
    const int h = std::max(1, static_cast<int>(side * (0.5 + number())));
    const int x0 = frame.x0 + static_cast<int>(x), y0 = frame.y0 + static_cast<int>(y);
    result.push_back({{x0, y0, x0 + w, y0 + h}, 0.5 + 0.5 * w * h, 0.5});
  }
  return result;
}

// Costs with cells of so many pixels.
inline Costs costs_of(const geometry::Rect& frame, int side, std::span<const WeightedBox> boxes) {
  return make_costs(frame, (frame.width() + side - 1) / side, (frame.height() + side - 1) / side,
                    {boxes.begin(), boxes.end()});
}

}  // namespace delray::loadbalance::testing
