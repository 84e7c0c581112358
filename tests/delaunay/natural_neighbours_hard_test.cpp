// Natural neighbours where points are almost on circles, spheres, lines and planes, very close to
// each other, or numbers very large or small.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "delaunay/interpolate.h"
#include "delaunay/triangulate.h"

namespace delray::delaunay {
namespace {

using SpacePoints = std::vector<glm::dvec3>;

struct Set {
  std::string name;
  int dim;
  SpacePoints points;
};

SpacePoints lattice(int dim, int side, double spacing, double offset) {
  SpacePoints points;
  for (int i = 0; i < side * side * (dim == 3 ? side : 1); ++i) {
    points.emplace_back(offset + spacing * (i % side), offset + spacing * (i / side % side),
                        dim == 3 ? offset + spacing * (i / side / side) : 0);
  }
  return points;
}

// Moved by up to `far` in every coordinate.
SpacePoints shaken(SpacePoints points, int dim, double far, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<> unit(-far, far);
  for (glm::dvec3& p : points) {
    for (int k = 0; k < dim; ++k) p[k] += unit(random);
  }
  return points;
}

// On a circle or sphere but for rounding, with its middle.
SpacePoints on_ball(int dim, int n, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<> normal;
  SpacePoints points = {glm::dvec3(0)};
  for (int i = 0; i < n; ++i) {
    const glm::dvec3 p(normal(random), normal(random), dim == 3 ? normal(random) : 0);
    points.push_back(p / glm::length(p));
  }
  return points;
}

// Two layers that are close to each other: tetrahedra are long or flat.
SpacePoints layers(int dim, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<> unit(0, 1);
  SpacePoints points;
  for (int i = 0; i < 60; ++i) {
    const double x = unit(random), y = unit(random);
    if (dim == 2) points.emplace_back(x, i % 2 * 1e-7 + y * 1e-12, 0);
    if (dim == 3) points.emplace_back(x, y, i % 2 * 1e-7 + unit(random) * 1e-12);
  }
  return points;
}

std::vector<Set> sets(int dim, std::uint64_t seed) {
  const int side = dim == 3 ? 5 : 9;
  std::vector<Set> result = {
      {"lattice of 0.1", dim, lattice(dim, side, 0.1, 0)},
      {"lattice of 0.1 far away", dim, lattice(dim, side, 0.1, 1e6)},
      {"lattice, an ulp off", dim, shaken(lattice(dim, side, 1, 1), dim, 4e-16, seed)},
      {"lattice, 1e-9 off", dim, shaken(lattice(dim, side, 1, 1), dim, 1e-9, seed)},
      {"ball", dim, on_ball(dim, 80, seed)},
      {"layers", dim, layers(dim, seed)},
      {"general", dim, shaken(lattice(dim, side, 1, 0), dim, 0.4, seed)},
  };
  for (std::size_t i = 0, n = result.size(); i < n; ++i) {
    for (const double scale : {1e-9, 1e155, 1e-160, 1e300}) {
      Set scaled = result[i];
      scaled.name += " times " + std::to_string(std::log10(scale));
      for (glm::dvec3& p : scaled.points) p *= scale;
      result.push_back(std::move(scaled));
    }
  }
  return result;
}

glm::dvec3 query_of(const Set& set, int round, std::mt19937_64& random) {
  std::uniform_real_distribution<> unit(0, 1);
  const auto& points = set.points;
  glm::dvec3 q(0);
  double sum = 0;
  const int count = round % 3 == 0 ? 2 : set.dim + 1;
  std::vector<double> shares;
  for (int i = 0; i < count; ++i) {
    // Middles of lattices' cells and edges, places close to a point or a facet, any.
    shares.push_back(round % 4 == 0 ? 1 : round % 4 == 1 && i > 0 ? 1e-9 : unit(random));
    sum += shares.back();
  }
  for (const double share : shares) q += share / sum * points[random() % points.size()];
  return q;
}

void expect_shares(const Query& query, const Set& set, const glm::dvec3& q) {
  const auto neighbours = natural_neighbours(query, q);
  if (neighbours.empty()) {
    ASSERT_EQ(query.locate(q), Query::kNone);
    return;
  }
  double sum = 0;
  for (const NaturalNeighbour& neighbour : neighbours) {
    ASSERT_GE(neighbour.weight, 0);
    ASSERT_LE(neighbour.weight, 1);
    sum += neighbour.weight;
  }
  ASSERT_NEAR(sum, 1, 1e-12);
  for (int k = 0; k < set.dim; ++k) {
    double low = q[k], high = q[k], largest = std::abs(q[k]);
    for (const NaturalNeighbour& neighbour : neighbours) {
      const double x = query.position(neighbour.row)[k];
      low = std::min(low, x);
      high = std::max(high, x);
      largest = std::max(largest, std::abs(x));
    }
    if (low == high) continue;
    double off = 0;
    for (const NaturalNeighbour& neighbour : neighbours) {
      off += neighbour.weight * ((query.position(neighbour.row)[k] - q[k]) / (high - low));
    }
    ASSERT_LE(std::abs(off), 1e-9) << "coordinate " << k << ", " << neighbours.size();
  }
}

TEST(NaturalNeighbours, AreExactForLinearFunctionsOfHardSets) {
  for (const int dim : {2, 3}) {
    for (const std::uint64_t seed : {1, 2}) {
      for (const Set& set : sets(dim, seed)) {
        SCOPED_TRACE(set.name + ", dim " + std::to_string(dim) + ", seed " + std::to_string(seed));
        Options options;
        options.dim = dim;
        const Triangulation triangulation = triangulate(view(set.points), options).triangulation;
        const Query query(view(set.points), triangulation);
        std::mt19937_64 random(seed);
        for (int round = 0; round < 24; ++round) {
          const glm::dvec3 q = query_of(set, round, random);
          SCOPED_TRACE(round);
          expect_shares(query, set, q);
          if (HasFatalFailure()) return;
        }
      }
    }
  }
}

// The shares of a grid that rounding has bent are those of one that is not.
TEST(NaturalNeighbours, OfABentGridAreThoseOfTheGrid) {
  Options options;
  options.dim = 3;
  const SpacePoints bent = lattice(3, 5, 0.1, 0), even = lattice(3, 5, 1, 0);
  const Triangulation bent_cells = triangulate(view(bent), options).triangulation;
  const Triangulation even_cells = triangulate(view(even), options).triangulation;
  const Query bent_query(view(bent), bent_cells), even_query(view(even), even_cells);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<> unit(0.5, 3.5);
  for (int round = 0; round < 40; ++round) {
    const glm::dvec3 q(unit(random), unit(random), unit(random));
    std::vector<double> weights(bent.size());
    for (const NaturalNeighbour& n : natural_neighbours(bent_query, 0.1 * q)) {
      weights[n.row] += n.weight;
    }
    for (const NaturalNeighbour& n : natural_neighbours(even_query, q)) weights[n.row] -= n.weight;
    for (const double difference : weights) ASSERT_NEAR(difference, 0, 1e-9);
  }
}

}  // namespace
}  // namespace delray::delaunay
