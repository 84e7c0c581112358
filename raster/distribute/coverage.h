// How many layers of triangles cover each square of the screen, to estimate how much of a group is
// seen before anything is drawn.
#pragma once

#include <span>
#include <vector>

#include "comm/communicator.h"
#include "loadbalance/costs.h"
#include "raster/pipeline/screen_triangle.h"

namespace delray::raster {

// The samples that ranks' triangles cover, summed up by squares of the screen.
class Coverage {
 public:
  // For a screen of samples, n x n to a pixel of the frame. Boxes are in pixels.
  Coverage(const Screen& screen, int n);

  // How a group's samples cover others. Opacity: the part of what lies behind that a sample hides,
  // on average, in [0, 1].
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

  // Adds so many samples, spread evenly over the squares that the box touches.
  void add(const geometry::Rect& box, double samples, const Surface& surface);
  // Adds a large triangle, square by square. Returns its samples. O(squares in its box).
  double add_large(const ScreenTriangle& triangle, const Surface& surface);
  // Collective. Rank 0 alone gets the sums of large triangles.
  void sum_over_ranks(comm::Communicator& communicator);

  // Of a square, how many layers of samples it has, and of how many of them the samples are
  // expected to be seen if all lie behind each other at random.
  struct Layers {
    double all, seen;
  };
  // Of all squares, for opaque or for blended surfaces: opaque samples hide both kinds, blended
  // ones the blended behind them.
  std::vector<Layers> layers(bool blended) const;
  // The part of a surface's samples in the box that is expected to be seen, in [0, 1].
  double seen(const geometry::Rect& box, std::span<const Layers> layers) const;
  // The costs of large triangles, square by square, at a price for a sample that is expected to be
  // seen and one for each that is drawn.
  std::vector<loadbalance::WeightedBox> costs_of_large(double seen_price, double drawn_price) const;

 private:
  static constexpr int kSide = 16;  // pixels

  static geometry::Rect squares_of(const geometry::Rect& box);
  template <class F>
  void for_each_square(const geometry::Rect& box, F&& f) const;
  Layers layers(const Square& square, bool blended) const;

  const Screen& screen_;
  int n_, columns_, rows_;
  geometry::Rect frame_;
  std::vector<Square> squares_;
};

}  // namespace delray::raster
