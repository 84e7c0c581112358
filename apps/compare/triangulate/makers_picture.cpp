// Rasterizes triangles, or the cut of a plane through tetrahedra, into samples that hold numbers of
// simplices, and averages the makers' colours over the samples of a pixel.
//
// A tetrahedron is cut where its edges pass the plane: three or four points, filled as a convex
// polygon. Several samples a pixel smooth the borders. Degenerate: polygons that are not finite are
// left out; edges are not drawn where they would cover much of the picture.
#include "apps/compare/triangulate/makers_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "geometry/box.h"
#include "image/srgb.h"

namespace delray::apps {
namespace {

// The hues of a page's series, between what they are on white and on black.
constexpr std::array<std::array<std::uint8_t, 3>, 8> kColours = {{{31, 127, 196},
                                                                  {224, 105, 26},
                                                                  {18, 163, 132},
                                                                  {200, 106, 157},
                                                                  {106, 184, 226},
                                                                  {199, 154, 30},
                                                                  {118, 118, 200},
                                                                  {128, 136, 144}}};
constexpr int kSamples = 3;  // across a pixel
constexpr std::uint32_t kNobody = 0xffffffffU;
constexpr float kEdge = 0.35F;  // of the light that edges keep
// Edges are drawn if no more than this share of the picture would be edges.
constexpr double kMostEdges = 0.25;

// Which simplex each sample shows.
class Canvas {
 public:
  Canvas(int width, int height)
      : width_(width * kSamples),
        height_(height * kSamples),
        shown_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), kNobody) {}

  // A convex polygon in samples, y down.
  void fill(std::span<const glm::dvec2> corners, std::uint32_t number) {
    double top = corners[0].y, bottom = top;
    for (const glm::dvec2& p : corners) {
      if (!std::isfinite(p.x) || !std::isfinite(p.y)) return;
      top = std::min(top, p.y);
      bottom = std::max(bottom, p.y);
    }
    const int last = std::min(height_ - 1, static_cast<int>(std::floor(bottom - 0.5)));
    for (int y = std::max(0, static_cast<int>(std::ceil(top - 0.5))); y <= last; ++y) {
      const double centre = y + 0.5;
      double left = width_, right = 0;
      for (std::size_t i = 0; i < corners.size(); ++i) {
        const glm::dvec2 &a = corners[i], &b = corners[(i + 1) % corners.size()];
        if ((a.y <= centre) == (b.y <= centre)) continue;
        const double x = a.x + (centre - a.y) / (b.y - a.y) * (b.x - a.x);
        left = std::min(left, x);
        right = std::max(right, x);
      }
      const int from = std::max(0, static_cast<int>(std::ceil(left - 0.5)));
      const int to = std::min(width_, static_cast<int>(std::ceil(right - 0.5)));
      for (int x = from; x < to; ++x) at(x, y) = number;
    }
  }

  image::Image8 picture(std::span<const std::uint16_t> makers) const {
    const bool draws_edges = edges() < kMostEdges * static_cast<double>(shown_.size());
    image::Image8 result(width_ / kSamples, height_ / kSamples);
    for (int y = 0; y < result.height; ++y) {
      for (int x = 0; x < result.width; ++x) {
        std::array<float, 3> light{};
        int covered = 0;
        for (int j = 0; j < kSamples; ++j) {
          for (int i = 0; i < kSamples; ++i) {
            const std::uint32_t number = at(kSamples * x + i, kSamples * y + j);
            if (number == kNobody) continue;
            ++covered;
            const bool edge = draws_edges && is_edge(kSamples * x + i, kSamples * y + j);
            const auto& colour = kColours[makers[number] % kColours.size()];
            for (std::size_t k = 0; k < 3; ++k)
              light[k] += image::decode_srgb(colour[k]) * (edge ? kEdge : 1.0F);
          }
        }
        constexpr float kAll = kSamples * kSamples;
        const auto encoded = [&](std::size_t k) { return image::encode_srgb(light[k] / kAll); };
        result.colour[static_cast<std::size_t>(y) * static_cast<std::size_t>(result.width) +
                      static_cast<std::size_t>(x)] = {
            encoded(0), encoded(1), encoded(2),
            static_cast<std::uint8_t>(std::lround(255.0F * static_cast<float>(covered) / kAll))};
      }
    }
    return result;
  }

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }
  std::uint32_t& at(int x, int y) { return shown_[index(x, y)]; }
  std::uint32_t at(int x, int y) const { return shown_[index(x, y)]; }
  // Whether another simplex is to the right or below.
  bool is_edge(int x, int y) const {
    const std::uint32_t own = at(x, y);
    return (x + 1 < width_ && at(x + 1, y) != own) || (y + 1 < height_ && at(x, y + 1) != own);
  }
  double edges() const {
    double count = 0;
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x) count += at(x, y) != kNobody && is_edge(x, y) ? 1 : 0;
    return count;
  }

  int width_, height_;
  std::vector<std::uint32_t> shown_;
};

// Where the plane that `height` is 0 on cuts a tetrahedron, in order around the cut: 3 or 4 points,
// none if it does not.
struct Cut {
  std::array<glm::dvec3, 4> points;
  std::size_t size = 0;
};
Cut cut(const std::array<glm::dvec3, 4>& corners, const std::array<double, 4>& heights) {
  std::array<std::size_t, 4> above{}, below{};
  std::size_t n_above = 0, n_below = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    if (heights[k] > 0)
      above[n_above++] = k;
    else
      below[n_below++] = k;
  }
  Cut result;
  const auto add = [&](std::size_t i, std::size_t j) {
    const double t = heights[i] / (heights[i] - heights[j]);
    result.points[result.size++] = corners[i] + t * (corners[j] - corners[i]);
  };
  if (n_above == 2) {
    add(above[0], below[0]), add(above[0], below[1]);
    add(above[1], below[1]), add(above[1], below[0]);
  } else if (n_above == 1 || n_above == 3) {
    const bool tip_above = n_above == 1;
    const std::size_t tip = tip_above ? above[0] : below[0];
    for (std::size_t k = 0; k < 3; ++k) add(tip, tip_above ? below[k] : above[k]);
  }
  return result;
}

}  // namespace

image::Image8 makers_picture(const delaunay::PointCloud& points,
                             const delaunay::Triangulation& triangulation,
                             std::span<const std::uint16_t> makers, int side) {
  geometry::Box3d box;
  for (const glm::dvec3& p : points.positions) box.include(p);
  const glm::dvec3 size = box.size();
  // Across and up the picture, and what it is seen along.
  std::array<int, 3> axes = {0, 1, 2};
  if (triangulation.dim == 3) {
    const int shortest = size.z <= size.x && size.z <= size.y ? 2 : size.y <= size.x ? 1 : 0;
    axes = shortest == 2   ? std::array{0, 1, 2}
           : shortest == 1 ? std::array{0, 2, 1}
                           : std::array{1, 2, 0};
  }
  const double longest = std::max({size[axes[0]], size[axes[1]], 1e-300});
  // Extents that overflow, or of no points at all, give an empty square.
  if (!std::isfinite(longest) || points.size() == 0) return Canvas(side, side).picture(makers);
  const auto pixels = [&](int axis) {
    return std::max(1, static_cast<int>(std::lround(size[axes[static_cast<std::size_t>(axis)]] /
                                                    longest * side)));
  };
  const int width = pixels(0), height = pixels(1);
  Canvas canvas(width, height);
  const glm::dvec2 scale(kSamples * width / std::max(size[axes[0]], 1e-300),
                         kSamples * height / std::max(size[axes[1]], 1e-300));
  const auto at = [&](const glm::dvec3& p) {
    return glm::dvec2((p[axes[0]] - box.low[axes[0]]) * scale.x,
                      (box.high[axes[1]] - p[axes[1]]) * scale.y);
  };
  const double plane = box.centre()[axes[2]];
  const auto corners = static_cast<std::size_t>(triangulation.dim) + 1;
  std::array<glm::dvec2, 4> polygon;
  for (std::size_t i = 0; i < triangulation.size(); ++i) {
    const std::uint32_t* vertices = triangulation.vertices.data() + corners * i;
    std::size_t n = 3;
    if (corners == 3) {
      for (std::size_t k = 0; k < 3; ++k) polygon[k] = at(points.positions[vertices[k]]);
    } else {
      std::array<glm::dvec3, 4> tetrahedron;
      std::array<double, 4> heights{};
      for (std::size_t k = 0; k < 4; ++k) {
        tetrahedron[k] = points.positions[vertices[k]];
        heights[k] = tetrahedron[k][axes[2]] - plane;
      }
      const Cut section = cut(tetrahedron, heights);
      n = section.size;
      for (std::size_t k = 0; k < n; ++k) polygon[k] = at(section.points[k]);
    }
    if (n > 0) canvas.fill({polygon.data(), n}, static_cast<std::uint32_t>(i));
  }
  return canvas.picture(makers);
}

}  // namespace delray::apps
