// How often the squares of a screen are covered: more often than is seen where surfaces lie behind
// each other.
#pragma once

#include <span>
#include <vector>

#include "comm/communicator.h"
#include "loadbalance/costs.h"
#include "raster/pipeline/screen_triangle.h"

namespace delray::raster {

class Coverage {
 public:
  // Pixels are pixels of the frame, which has n x n samples in each.
  Coverage(const Screen& screen, int n);

  // What covers: how much of what lies behind a sample of it is hidden, on average, in [0, 1].
  struct Surface {
    bool blended = false;
    double opacity = 1;
  };
  // A square of the screen.
  struct Square {
    double opaque = 0, blended = 0;              // samples, weighted with their opacity
    double large_opaque = 0, large_blended = 0;  // samples of large triangles
    bool operator==(const Square&) const = default;
  };
  const std::vector<Square>& squares() const { return squares_; }

  // So many samples, anywhere in a box of pixels.
  void add(const geometry::Rect& box, double samples, const Surface& surface);
  // A triangle, square by square. Returns its samples. O(squares in its box).
  double add_large(const ScreenTriangle& triangle, const Surface& surface);
  // Large triangles for rank 0 only.
  void sum_over_ranks(comm::Communicator& communicator);

  // The part of the samples that opaque, or blended, surfaces cover in a box that is shaded, if all
  // lie at random: opaque ones hide both kinds, blended ones the blended behind them.
  double seen(const geometry::Rect& box, bool blended) const;
  // What is seen and drawn of large triangles at these prices for a sample, square by square.
  std::vector<loadbalance::WeightedBox> costs_of_large(double seen_price, double drawn_price) const;

 private:
  static constexpr int kSide = 16;  // pixels

  static geometry::Rect squares_of(const geometry::Rect& box);
  template <class F>
  void for_each_square(const geometry::Rect& box, F&& f) const;
  double layers(const Square& square, bool blended) const;

  const Screen& screen_;
  int n_, columns_, rows_;
  geometry::Rect frame_;
  std::vector<Square> squares_;
};

}  // namespace delray::raster
