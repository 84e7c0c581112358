#include "composite/layer_costs.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <span>
#include <vector>

#include "image/image.h"
#include "parallel/arena.h"

namespace delray::composite {
namespace {

constexpr int kRepeats = 7;

// A disc in the middle of a square that covers this share of it; everything from 1 on.
image::Image8 picture(int side, double share) {
  image::Image8 image(side, side);
  clear(image);
  const double radius2 = share * side * side / 3.14159265358979;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const double dx = x - side / 2.0, dy = y - side / 2.0;
      if (share < 1 && dx * dx + dy * dy >= radius2) continue;
      const auto i = static_cast<std::size_t>(y) * static_cast<std::size_t>(side) +
                     static_cast<std::size_t>(x);
      image.colour[i] = {static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y), 2, 255};
      image.depth[i] = static_cast<float>((x * 7 + y * 13) % 64);
    }
  }
  return image;
}

template <class F>
double median_seconds(F&& f) {
  std::array<double, kRepeats> seconds{};
  for (double& one : seconds) {
    const auto begin = std::chrono::steady_clock::now();
    f();
    one = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  }
  std::nth_element(seconds.begin(), seconds.begin() + kRepeats / 2, seconds.end());
  return seconds[kRepeats / 2];
}

// `seconds` that a call took for so much of each of three things.
struct Line {
  std::array<double, 3> amounts;
  double seconds;
};

// The prices >= 0 of three things that tell the seconds of all lines best: relative least squares,
// by coordinate descent.
std::array<double, 3> fit(std::span<const Line> lines) {
  constexpr int kSweeps = 2000;
  std::array<double, 3> prices{};
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (std::size_t k = 0; k < prices.size(); ++k) {
      double up = 0, down = 0;
      for (const Line& line : lines) {
        double rest = 1;
        for (std::size_t j = 0; j < prices.size(); ++j) {
          if (j != k) rest -= prices[j] * line.amounts[j] / line.seconds;
        }
        const double amount = line.amounts[k] / line.seconds;
        up += amount * rest;
        down += amount * amount;
      }
      if (down > 0) prices[k] = std::max(0.0, up / down);
    }
  }
  return prices;
}

}  // namespace

LayerCosts measure_layer_costs(const Codec& codec, std::uint64_t pixels) {
  std::vector<Line> cuts, merges;
  parallel::Arena(1).execute([&] {
    for (const std::uint64_t size : {pixels, pixels / 16, pixels / 1024}) {
      int side = 1;
      while (static_cast<std::uint64_t>(side) * static_cast<std::uint64_t>(side) < size) ++side;
      for (const double share : {0.0, 0.3, 0.7, 1.0}) {
        const auto sender = codec.make(picture(side, share));
        const auto receiver = codec.make(picture(side, 0.5));
        const PixelRange all{0, sender->pixels()};
        comm::Buffer message;
        std::uint64_t composited = 0;
        const double cut = median_seconds([&] {
          message = {};
          message = sender->cut(all);
        });
        const double merge =
            median_seconds([&] { composited = receiver->merge(all, message, Side::higher); });
        const auto range = static_cast<double>(all.size());
        cuts.push_back({{1, range, static_cast<double>(message.size())}, cut});
        merges.push_back({{1, range, static_cast<double>(composited)}, merge});
      }
    }
  });
  const auto cut = fit(cuts), merge = fit(merges);
  return {cut[0], cut[1], cut[2], merge[0], merge[1], merge[2]};
}

}  // namespace delray::composite
