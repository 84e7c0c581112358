// Estimates how much of what surfaces cover is seen, on a grid of squares.
//
// Samples that lie at random in a square form layers; of n layers (1 - exp(-n)) / n of the first is
// seen on average. Small triangles are spread evenly over the squares that their group's box
// touches; large ones are tested at some points of each square. O(squares touched); one reduction
// over ranks, in single precision.
//
// Degenerate: an empty box adds nothing, and nothing covered counts as all seen.
#include "raster/distribute/coverage.h"

#include <cmath>

#include "comm/collectives.h"
#include "raster/pipeline/samples.h"

namespace delray::raster {
namespace {

// Of so many layers at random, how much of the first is seen on average: (1 - exp(-layers)) /
// layers.
double seen_of(double layers) {
  constexpr double kFew = 1e-6;
  return layers > kFew ? (1 - std::exp(-layers)) / layers : 1;
}

// The part of a square, of `side` subpixels, that a triangle covers, by a few points of it.
double part_inside(const ScreenTriangle& triangle, std::int64_t x, std::int64_t y,
                   std::int64_t side) {
  constexpr int kPoints = 4;  // in either direction
  int inside = 0;
  for (int j = 0; j < kPoints; ++j) {
    for (int i = 0; i < kPoints; ++i) {
      const std::int64_t px = x + side * (2 * i + 1) / (2 * kPoints);
      const std::int64_t py = y + side * (2 * j + 1) / (2 * kPoints);
      bool in = true;
      for (int k = 0; k < 3; ++k) {
        const ScreenVertex& p = triangle.vertex[k];
        const ScreenVertex& q = triangle.vertex[(k + 1) % 3];
        in &= std::int64_t{q.x - p.x} * (py - p.y) - std::int64_t{q.y - p.y} * (px - p.x) >= 0;
      }
      inside += in;
    }
  }
  return static_cast<double>(inside) / (kPoints * kPoints);
}

}  // namespace

Coverage::Coverage(const Screen& screen, int n)
    : screen_(screen), n_(n), frame_{0, 0, screen.width / n, screen.height / n} {
  columns_ = (frame_.width() + kSide - 1) / kSide;
  rows_ = (frame_.height() + kSide - 1) / kSide;
  squares_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
}

geometry::Rect Coverage::squares_of(const geometry::Rect& box) {
  return {box.x0 / kSide, box.y0 / kSide, (box.x1 - 1) / kSide + 1, (box.y1 - 1) / kSide + 1};
}

template <class F>
void Coverage::for_each_square(const geometry::Rect& box, F&& f) const {
  const geometry::Rect squares = squares_of(box);
  for (int y = squares.y0; y < squares.y1; ++y) {
    for (int x = squares.x0; x < squares.x1; ++x) {
      f(static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) +
        static_cast<std::size_t>(x));
    }
  }
}

Coverage::Layers Coverage::layers(const Square& square, bool blended) const {
  const double all = (square.opaque + (blended ? square.blended : 0)) /
                     (kSide * kSide * static_cast<double>(n_) * n_);
  return {all, all * seen_of(all)};
}

std::vector<Coverage::Layers> Coverage::layers(bool blended) const {
  std::vector<Layers> result;
  result.reserve(squares_.size());
  for (const Square& square : squares_) result.push_back(layers(square, blended));
  return result;
}

void Coverage::add(const geometry::Rect& box, double samples, const Surface& surface) {
  if (box.empty()) return;
  const double each = surface.opacity * samples / static_cast<double>(squares_of(box).area());
  double Square::*const hides = surface.blended ? &Square::blended : &Square::opaque;
  for_each_square(box, [&](std::size_t i) { squares_[i].*hides += each; });
}

double Coverage::add_large(const ScreenTriangle& triangle, const Surface& surface) {
  const ScreenVertex* v = triangle.vertex;
  const geometry::Rect squares =
      squares_of(pixels_of(centres_in_box(v[0], v[1], v[2], screen_), n_));
  const std::int64_t side = std::int64_t{kSide} * n_ * kSubpixels;
  const double most = static_cast<double>(kSide * kSide) * n_ * n_;
  double all = 0;
  for (int j = squares.y0; j < squares.y1; ++j) {
    for (int i = squares.x0; i < squares.x1; ++i) {
      const double samples =
          most * part_inside(triangle, i * side - std::int64_t{screen_.centre_x} * kSubpixels,
                             j * side - std::int64_t{screen_.centre_y} * kSubpixels, side);
      Square& square = squares_[static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_) +
                                static_cast<std::size_t>(i)];
      (surface.blended ? square.blended : square.opaque) += surface.opacity * samples;
      (surface.blended ? square.large_blended : square.large_opaque) += samples;
      all += samples;
    }
  }
  return all;
}

// In single precision: these are estimates.
void Coverage::sum_over_ranks(comm::Communicator& communicator) {
  std::vector<float> all, large;
  bool any_large = false;
  for (const Square& s : squares_) {
    all.insert(all.end(), {static_cast<float>(s.opaque), static_cast<float>(s.blended)});
    large.insert(large.end(),
                 {static_cast<float>(s.large_opaque), static_cast<float>(s.large_blended)});
    any_large |= s.large_opaque + s.large_blended > 0;
  }
  all.push_back(any_large ? 1.0F : 0.0F);
  comm::all_reduce(communicator, std::span<float>(all), std::plus<>());
  if (all.back() > 0) comm::reduce(communicator, 0, std::span<float>(large), std::plus<>());
  for (std::size_t i = 0; i < squares_.size(); ++i)
    squares_[i] = {all[2 * i], all[2 * i + 1], large[2 * i], large[2 * i + 1]};
}

double Coverage::seen(const geometry::Rect& box, std::span<const Layers> layers) const {
  double all = 0, seen = 0;
  for_each_square(box, [&](std::size_t i) {
    all += layers[i].all;
    seen += layers[i].seen;
  });
  return all > 0 ? seen / all : 1;
}

std::vector<loadbalance::WeightedBox> Coverage::costs_of_large(double seen_price,
                                                               double drawn_price) const {
  std::vector<loadbalance::WeightedBox> boxes;
  for (int j = 0; j < rows_; ++j) {
    for (int i = 0; i < columns_; ++i) {
      const Square& square =
          squares_[static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_) +
                   static_cast<std::size_t>(i)];
      const double drawn = square.large_opaque + square.large_blended;
      if (!(drawn > 0)) continue;
      const double seen = square.large_opaque * seen_of(layers(square, false).all) +
                          square.large_blended * seen_of(layers(square, true).all);
      const geometry::Rect pixels{i * kSide, j * kSide, (i + 1) * kSide, (j + 1) * kSide};
      boxes.push_back(
          {geometry::intersection(pixels, frame_), seen_price * seen + drawn_price * drawn, 0, 0});
    }
  }
  return boxes;
}

}  // namespace delray::raster
