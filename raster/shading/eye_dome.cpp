// Eye-dome lighting (Boucheny, Visualisation scientifique de grandes volumes de donnees, 2009):
// each pixel is obscured by its neighbours at distances of one and two pixels, by the slope up to
// those that are nearer. Slopes are in pixels of the neighbourhood per pixel, so that neither
// distance nor size of the scene matter. Blends no pixels: what is drawn stays sharp.
//
// Degenerate: neighbours outside of the picture and empty ones obscure nothing.
#include "raster/shading/eye_dome.h"

#include <algorithm>
#include <array>
#include <cstdlib>

#include "composite/fragment.h"
#include "image/srgb.h"
#include "parallel/parallel_for.h"
#include "shading/arithmetic.h"

namespace delray::raster {
namespace {

// What is left of light is 2^-kStrength for a mean slope of 1.
constexpr float kStrength = 0.3F;
// One step at the border of an object is as dark as it gets.
constexpr float kSteepest = 12;

struct Neighbour {
  int x, y;
  float per_distance;  // one over how far it is, in pixels
};
constexpr float kDiagonal = 0.70710678F;
constexpr std::array kNeighbours = {
    Neighbour{1, 0, 1},          Neighbour{-1, 0, 1},          Neighbour{0, 1, 1},
    Neighbour{0, -1, 1},         Neighbour{1, 1, kDiagonal},   Neighbour{-1, 1, kDiagonal},
    Neighbour{1, -1, kDiagonal}, Neighbour{-1, -1, kDiagonal}, Neighbour{2, 0, 0.5F},
    Neighbour{-2, 0, 0.5F},      Neighbour{0, 2, 0.5F},        Neighbour{0, -2, 0.5F}};

float light_at(const scenes::View& view, const image::Plane<float>& depths, int x, int y) {
  const auto at = [&](int i, int j) {
    return depths[static_cast<std::size_t>(j) * static_cast<std::size_t>(view.width) +
                  static_cast<std::size_t>(i)];
  };
  const float depth = at(x, y);
  const float pixels = view.orthographic ? view.scale : view.scale / depth;
  float sum = 0;
  for (const Neighbour& n : kNeighbours) {
    const int i = x + n.x, j = y + n.y;
    if (i < 0 || j < 0 || i >= view.width || j >= view.height) continue;
    const float slope = (depth - at(i, j)) * pixels * n.per_distance;
    if (slope > 0) sum += std::min(slope, kSteepest);
  }
  return shading::exp2(-kStrength / kNeighbours.size() * sum);
}

void darken(float light, image::RgbaF& c) { c.r *= light, c.g *= light, c.b *= light; }
void darken(float light, image::Rgba8& c) {
  image::RgbaF lit = image::to_float(c);
  darken(light, lit);
  const std::uint8_t alpha = c.a;
  composite::store(lit, c);
  c.a = alpha;
}

}  // namespace

template <class Colour>
void light_by_eye_dome(const scenes::View& view, image::BasicImage<Colour>& image) {
  constexpr std::size_t kGrain = 4;  // rows
  parallel::parallel_for(0, static_cast<std::size_t>(image.height), kGrain, [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < image.width; ++x) {
      const std::size_t i =
          row * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x);
      if (image.depth[i] < image::kEmptyDepth)
        darken(light_at(view, image.depth, x, y), image.colour[i]);
    }
  });
}

template void light_by_eye_dome(const scenes::View&, image::Image8&);
template void light_by_eye_dome(const scenes::View&, image::ImageF&);

}  // namespace delray::raster
