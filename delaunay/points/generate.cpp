// The table of point sets, one function for each: it computes point i from the row's own random
// numbers and nothing else, so rows are generated in parallel. Sets that are meant to be exactly
// degenerate use coordinates of few bits, so that nothing is rounded.
#include "delaunay/generate.h"

#include <array>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <string>

#include "delaunay/mesh/arguments.h"
#include "delaunay/mesh/random.h"
#include "parallel/parallel_for.h"

namespace delray::delaunay {
namespace {

// All that a point may depend on; `random` is the row's own.
struct Row {
  std::size_t i, n;
  int dim;
  std::uint64_t seed;
  RowRandom random;
};

using PointOf = glm::dvec3 (*)(Row& row);

template <PointOf kPoint>
PointCloud generate(std::size_t n, int dim, std::uint64_t seed) {
  PointCloud cloud;
  cloud.has_z = dim == 3;
  cloud.positions.resize(n);
  constexpr std::size_t kGrain = 4096;  // about 0.2 ms
  parallel::parallel_for(0, n, kGrain, [&](std::size_t i) {
    Row row{i, n, dim, seed, RowRandom(seed, i)};
    cloud.positions[i] = kPoint(row);
    if (dim == 2) cloud.positions[i].z = 0;
  });
  return cloud;
}

bool in_unit_cube(const glm::dvec3& p, int dim) {
  for (int k = 0; k < dim; ++k) {
    if (!(p[k] >= 0 && p[k] <= 1)) return false;
  }
  return true;
}

// A direction, uniform on the unit circle or sphere, rounded: a point of the ball divided by its
// length.
glm::dvec3 direction(Row& row) {
  while (true) {
    glm::dvec3 p(0);
    double square = 0;
    for (int k = 0; k < row.dim; ++k) {
      p[k] = row.random.uniform(-1, 1);
      square += p[k] * p[k];
    }
    if (square > 1e-4 && square <= 1) return p / std::sqrt(square);
  }
}

glm::dvec3 uniform(Row& row) {
  glm::dvec3 p(0);
  for (int k = 0; k < row.dim; ++k) p[k] = row.random.uniform();
  return p;
}

glm::dvec3 gauss(Row& row) {
  constexpr double kDeviation = 0.15;
  while (true) {
    glm::dvec3 p(0);
    for (int k = 0; k < row.dim; ++k) p[k] = 0.5 + kDeviation * row.random.normal();
    if (in_unit_cube(p, row.dim)) return p;
  }
}

glm::dvec3 cluster(Row& row) {
  constexpr std::uint64_t kClusters = 16;
  constexpr double kDeviation = 0.01;
  // Rows beyond any real one give the centres.
  const std::uint64_t number = row.random.below(kClusters);
  RowRandom of_cluster(row.seed, ~number);
  glm::dvec3 centre(0);
  for (int k = 0; k < row.dim; ++k) centre[k] = of_cluster.uniform(0.05, 0.95);
  while (true) {
    glm::dvec3 p(0);
    for (int k = 0; k < row.dim; ++k) p[k] = centre[k] + kDeviation * row.random.normal();
    if (in_unit_cube(p, row.dim)) return p;
  }
}

// The smallest s with s^dim >= n.
std::size_t side_of_lattice(std::size_t n, int dim) {
  std::size_t side = 1;
  const auto holds = [&](std::size_t s) { return dim == 2 ? s * s >= n : s * s * s >= n; };
  while (!holds(side)) side *= 2;
  for (std::size_t step = side / 2; step > 0; step /= 2) {
    if (side > step && holds(side - step)) side -= step;
  }
  return side;
}

std::array<std::size_t, 3> lattice_place(const Row& row) {
  const std::size_t side = side_of_lattice(row.n, row.dim);
  return {row.i % side, row.i / side % side, row.i / side / side};
}

// The spacing is a power of two, so that the lattice is exact: its cells are squares.
double lattice_spacing(const Row& row) {
  const std::size_t side = side_of_lattice(row.n, row.dim);
  return 1.0 / static_cast<double>(std::bit_ceil(side));
}

glm::dvec3 grid(Row& row) {
  const auto place = lattice_place(row);
  const double spacing = lattice_spacing(row);
  glm::dvec3 p(0);
  for (int k = 0; k < row.dim; ++k) p[k] = static_cast<double>(place[k]) * spacing;
  return p;
}

glm::dvec3 arc(Row& row) {
  glm::dvec3 p = direction(row);
  p[row.dim - 1] = std::abs(p[row.dim - 1]);
  // Points converge to the arc: half of them are closer to it than 0.0002, a tenth than 1e-9.
  const double u = row.random.uniform(), u2 = u * u, u4 = u2 * u2, u8 = u4 * u4;
  return glm::dvec3(0.5) + p * (0.5 * (1 - 0.1 * u8));
}

glm::dvec3 sphere(Row& row) { return glm::dvec3(0.5) + 0.5 * direction(row); }

glm::dvec3 jitter(Row& row) {
  glm::dvec3 p = grid(row);
  const double spacing = lattice_spacing(row);
  for (int k = 0; k < row.dim; ++k) p[k] += spacing * row.random.uniform(-0.25, 0.25);
  return p;
}

glm::dvec3 ulp(Row& row) {
  glm::dvec3 p = grid(row) + glm::dvec3(1);
  for (int k = 0; k < row.dim; ++k) {
    const std::uint64_t choice = row.random.below(3);
    if (choice != 0) p[k] = std::nextafter(p[k], choice == 1 ? 0.0 : 3.0);
  }
  return p;
}

glm::dvec3 duplicates(Row& row) {
  // About eight rows to a point, negative zeros among them.
  RowRandom of_point(row.seed, ~row.random.below(row.n / 8 + 1));
  glm::dvec3 p(0);
  for (int k = 0; k < row.dim; ++k) {
    p[k] = static_cast<double>(of_point.below(1024)) / 1024;
    if (p[k] == 0 && row.random.below(2) == 1) p[k] = -0.0;
  }
  return p;
}

glm::dvec3 equal(Row& row) {
  RowRandom of_point(row.seed, ~std::uint64_t{0});
  glm::dvec3 p(0);
  for (int k = 0; k < row.dim; ++k) p[k] = of_point.uniform();
  return p;
}

glm::dvec3 collinear(Row& row) {
  // A step and a start of few bits keep multiples exact.
  RowRandom of_line(row.seed, ~std::uint64_t{0});
  const auto multiple = static_cast<double>(row.random.below(std::uint64_t{1} << 24));
  glm::dvec3 p(0);
  for (int k = 0; k < row.dim; ++k) {
    const double start = static_cast<double>(of_line.below(1024)) / 1024;
    const auto step = static_cast<double>(1 + of_line.below(1023));
    p[k] = start + multiple * step * 0x1p-34;
  }
  return p;
}

glm::dvec3 coplanar(Row& row) {
  // z = a x + b y with few bits; in the plane this is the uniform distribution on a lattice.
  RowRandom of_plane(row.seed, ~std::uint64_t{0});
  const double a = static_cast<double>(of_plane.below(64)) / 64;
  const double b = static_cast<double>(of_plane.below(64)) / 64;
  const double x = static_cast<double>(row.random.below(1 << 20)) * 0x1p-20;
  const double y = static_cast<double>(row.random.below(1 << 20)) * 0x1p-20;
  return {x, y, a * x + b * y};
}

// Points with whole coordinates at exactly the same distance from a centre, scaled by a power of
// two. There are a few hundred of them.
glm::dvec3 cocircular(Row& row) {
  if (row.dim == 3) {
    // A quaternion of norm N turns a unit vector into a whole vector of length N (Lebesgue), and
    // 159 is a sum of four squares in these ways, in any order and with any signs.
    constexpr std::array<std::array<int, 4>, 5> kSquares = {
        {{1, 1, 6, 11}, {1, 3, 7, 10}, {2, 3, 5, 11}, {2, 5, 7, 9}, {3, 5, 5, 10}}};
    std::array<int, 4> s = kSquares[row.random.below(kSquares.size())];
    for (std::size_t k = 3; k > 0; --k) std::swap(s[k], s[row.random.below(k + 1)]);
    for (int& value : s) value = row.random.below(2) == 1 ? -value : value;
    const auto [m, k, p, q] = s;
    const glm::dvec3 point(m * m + k * k - p * p - q * q, 2 * (m * q + k * p), 2 * (k * q - m * p));
    return glm::dvec3(0.5) + point / 512.0;
  }
  // A square of a Gaussian integer a + bi has length a^2 + b^2, conjugated or not; so has their
  // product, whichever factors are conjugated.
  constexpr std::array<std::array<std::int64_t, 2>, 6> kFactors = {
      {{2, 1}, {3, 2}, {4, 1}, {5, 2}, {6, 1}, {5, 4}}};
  std::int64_t x = 1, y = 0;
  for (const auto& [a, b] : kFactors) {
    const std::int64_t c = a * a - b * b;
    const std::int64_t d = row.random.below(2) == 1 ? -2 * a * b : 2 * a * b;
    const std::int64_t turned = x * c - y * d;
    y = x * d + y * c;
    x = turned;
  }
  if (row.random.below(2) == 1) std::swap(x, y);
  if (row.random.below(2) == 1) x = -x;
  if (row.random.below(2) == 1) y = -y;
  constexpr double kScale = 0x1p-27;  // the radius is 5 * 13 * 17 * 29 * 37 * 41 = 48612265
  return {0.5 + static_cast<double>(x) * kScale, 0.5 + static_cast<double>(y) * kScale, 0};
}

glm::dvec3 parabola(Row& row) {
  const double x = row.random.uniform(-1, 1);
  const double y = row.dim == 3 ? row.random.uniform(-1, 1) : x * x;
  return {x, y, x * x + y * y};
}

glm::dvec3 spiral(Row& row) {
  // A logarithmic spiral by powers of a rotation: (0.6, 0.8) is exact enough and has no period.
  const double turn = static_cast<double>(row.i + 1) / static_cast<double>(row.n + 1);
  glm::dvec3 p(turn, 0, turn);
  double c = 0.6, s = 0.8;
  for (std::size_t power = row.i; power > 0; power /= 2) {
    if (power % 2 == 1) p = {p.x * c - p.y * s, p.x * s + p.y * c, p.z};
    const double squared = c * c - s * s;
    s = 2 * c * s;
    c = squared;
  }
  return p;
}

glm::dvec3 two_lines(Row& row) {
  const double t = row.random.uniform();
  const bool second = row.i % 2 == 1;
  return row.dim == 2 ? glm::dvec3(t, second ? 1 : 0, 0)
         : second     ? glm::dvec3(0.5, t, 1)
                      : glm::dvec3(t, 0.5, 0);
}

// Octaves of noise that interpolates random heights of a lattice, each half as wide and high as the
// one before (Fournier, Fussell and Carpenter 1982), over places all alike.
glm::dvec3 terrain(Row& row) {
  glm::dvec3 p(row.random.uniform(), row.random.uniform(), 0);
  if (row.dim == 2) return p;
  constexpr int kOctaves = 9;
  double height = 0.16;
  for (int octave = 0; octave < kOctaves; ++octave, height /= 2) {
    const double cells = static_cast<double>(2 << octave);
    const glm::dvec2 place = glm::dvec2(p) * cells;
    const glm::dvec2 cell = glm::floor(place);
    const glm::dvec2 t = place - cell, smooth = t * t * (3.0 - 2.0 * t);
    const auto corner = [&](int i, int j) {
      const auto x = static_cast<std::uint64_t>(cell.x) + static_cast<std::uint64_t>(i);
      const auto y = static_cast<std::uint64_t>(cell.y) + static_cast<std::uint64_t>(j);
      const auto which = static_cast<std::uint64_t>(octave) << 40 | x << 20 | y;
      return RowRandom(row.seed, ~which).uniform(-1, 1);
    };
    p.z += height * glm::mix(glm::mix(corner(0, 0), corner(1, 0), smooth.x),
                             glm::mix(corner(0, 1), corner(1, 1), smooth.x), smooth.y);
  }
  return p;
}

glm::dvec3 far(Row& row) { return uniform(row) + glm::dvec3(1e9); }
glm::dvec3 large(Row& row) { return uniform(row) * 1e9; }
glm::dvec3 small(Row& row) { return uniform(row) * 1e-9; }

constexpr std::array kGenerators = {
    PointGenerator{"uniform", "uniformly distributed", &generate<uniform>},
    PointGenerator{"gauss", "normally distributed about the centre", &generate<gauss>},
    PointGenerator{"cluster", "sixteen dense groups, each normally distributed",
                   &generate<cluster>},
    PointGenerator{"grid", "exact lattice, row by row", &generate<grid>},
    PointGenerator{"arc", "converging to a half circle or hemisphere", &generate<arc>},
    PointGenerator{"sphere", "on a circle or sphere, rounded", &generate<sphere>},
    PointGenerator{"jitter", "lattice whose points are moved by up to a quarter of its spacing",
                   &generate<jitter>},
    PointGenerator{"ulp", "lattice whose points are moved by at most one unit in the last place",
                   &generate<ulp>},
    PointGenerator{"duplicates", "about eight equal points at each place, with 0 and -0",
                   &generate<duplicates>},
    PointGenerator{"equal", "the same point n times", &generate<equal>},
    PointGenerator{"collinear", "exactly on a line", &generate<collinear>},
    PointGenerator{"coplanar", "exactly in a plane", &generate<coplanar>},
    PointGenerator{"cocircular", "exactly on a circle or sphere, many equal",
                   &generate<cocircular>},
    PointGenerator{"parabola", "on a parabola or paraboloid, in [-1, 1]", &generate<parabola>},
    PointGenerator{"spiral", "one spiral from the origin", &generate<spiral>},
    PointGenerator{"two-lines", "on two parallel lines, skew in space", &generate<two_lines>},
    PointGenerator{"terrain", "fractal heights over the unit square (dimension 3)",
                   &generate<terrain>},
    PointGenerator{"far", "uniform, 1e9 away from the origin", &generate<far>},
    PointGenerator{"large", "uniform, scaled by 1e9", &generate<large>},
    PointGenerator{"small", "uniform, scaled by 1e-9", &generate<small>},
};

}  // namespace

std::span<const PointGenerator> point_generators() { return kGenerators; }

PointCloud generate_points(std::string_view kind, std::size_t n, int dim, std::uint64_t seed) {
  internal::check_dim(dim);
  std::string names;
  for (const PointGenerator& generator : kGenerators) {
    if (generator.name == kind) return generator.generate(n, dim, seed);
    names += " " + std::string(generator.name);
  }
  throw std::invalid_argument("no kind of points is called \"" + std::string(kind) +
                              "\"; legal are" + names);
}

}  // namespace delray::delaunay
