// Values at scattered points on a grid of pixels, by natural neighbours (Sibson 1981), as a
// picture: interpolates a function known at 500 points, and is transparent outside of their hull.
//
//   example_natural_neighbours [PICTURE.png]
#include <delaunay/generate.h>
#include <delaunay/interpolate.h>
#include <delaunay/query.h>
#include <delaunay/triangulate.h>
#include <image/io.h>
#include <image/srgb.h>
#include <parallel/parallel_for.h>
#include <scenes/colour_map.h>

#include <cmath>
#include <cstdio>
#include <exception>
#include <numeric>
#include <optional>
#include <vector>

using namespace delray;

namespace {

constexpr int kSide = 200;

// What is measured at the points: between -1 and 1.
double height(const glm::dvec3& p) { return std::sin(9 * p.x) * std::cos(7 * p.y); }

}  // namespace

int main(int argc, char** argv) try {
  const auto points = delaunay::generate_points("uniform", 500, 2, 1).positions;
  std::vector<double> values;
  for (const glm::dvec3& p : points) values.push_back(height(p));

  const delaunay::Triangulation mesh = delaunay::triangulate(delaunay::view(points)).triangulation;
  const delaunay::Query query(delaunay::view(points), mesh);  // any number of threads may ask
  const scenes::ColourMap& colours = scenes::colour_map("viridis");

  image::ImageF picture(kSide, kSide);
  image::clear(picture);
  std::vector<double> errors(kSide, 0.0);  // sums of squares, row by row
  parallel::parallel_for(0, kSide, 1, [&](std::size_t y) {
    for (std::size_t x = 0; x < kSide; ++x) {
      const glm::dvec3 q((x + 0.5) / kSide, 1.0 - (y + 0.5) / kSide, 0.0);
      const std::optional<double> value = delaunay::interpolate_natural_neighbour(query, values, q);
      if (!value) continue;  // outside of the hull
      const glm::vec3 colour = colours.colour(static_cast<float>(0.5 + 0.5 * *value));
      picture.colour[y * kSide + x] = {colour.r, colour.g, colour.b, 1.0F};
      errors[y] += (*value - height(q)) * (*value - height(q));
    }
  });

  const double error = std::sqrt(std::reduce(errors.begin(), errors.end()) / kSide / kSide);
  std::printf("root mean square of the error: %.4f\n", error);
  if (argc > 1) image::write_image(argv[1], picture);
  return error < 0.05 ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
