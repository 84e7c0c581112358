// Predicates against rational arithmetic, and the stages that decide them.
#include "delaunay/predicates.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <random>
#include <set>
#include <string>
#include <vector>

namespace delray::delaunay {
namespace {

using Rational = mpq_class;
using Random = std::mt19937_64;

template <int D>
using Point = glm::vec<D, double, glm::defaultp>;

// The textbook determinants in rational arithmetic: rows are points relative to the last one, with
// the lifted coordinate appended for the sphere tests. Expanded by minors.
Rational determinant(const std::vector<std::vector<Rational>>& rows) {
  if (rows.size() == 1) return rows[0][0];
  Rational sum = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::vector<std::vector<Rational>> minor;
    for (std::size_t j = 0; j < rows.size(); ++j) {
      if (j != i) minor.emplace_back(rows[j].begin() + 1, rows[j].end());
    }
    const Rational term = rows[i][0] * determinant(minor);
    sum += i % 2 == 0 ? term : Rational(-term);
  }
  return sum;
}

template <int D>
int exact_sign(const std::vector<Point<D>>& points) {
  const bool sphere = points.size() == D + 2;
  std::vector<std::vector<Rational>> rows;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    std::vector<Rational> row;
    Rational lift = 0;
    for (int k = 0; k < D; ++k) {
      row.emplace_back(Rational(points[i][k]) - Rational(points.back()[k]));
      lift += row.back() * row.back();
    }
    if (sphere) row.push_back(lift);
    rows.push_back(row);
  }
  // In 3D "relative to the last" reverses the frame, and the lift is the last column in both.
  const int sign = sgn(determinant(rows));
  return D == 3 ? -sign : sign;
}

Decision decide(const std::vector<Point<2>>& p) {
  return p.size() == 3 ? decide_orient2d(p[0], p[1], p[2])
                       : decide_incircle(p[0], p[1], p[2], p[3]);
}
Decision decide(const std::vector<Point<3>>& p) {
  return p.size() == 4 ? decide_orient3d(p[0], p[1], p[2], p[3])
                       : decide_insphere(p[0], p[1], p[2], p[3], p[4]);
}
int sign(const std::vector<Point<2>>& p) {
  return p.size() == 3 ? orient2d(p[0], p[1], p[2]) : incircle(p[0], p[1], p[2], p[3]);
}
int sign(const std::vector<Point<3>>& p) {
  return p.size() == 4 ? orient3d(p[0], p[1], p[2], p[3]) : insphere(p[0], p[1], p[2], p[3], p[4]);
}

// How to make one coordinate of a point.
using Coordinate = std::function<double(Random&)>;

double uniform(Random& random) { return std::uniform_real_distribution<double>(-1, 1)(random); }
Coordinate scaled(double scale) {
  return [scale](Random& random) { return uniform(random) * scale; };
}
Coordinate lattice(int size, double scale, double origin = 0) {
  return [=](Random& random) {
    return origin + std::uniform_int_distribution<int>(-size, size)(random) * scale;
  };
}
double nearly_half(Random& random) {
  double x = 0.5;
  for (int steps = std::uniform_int_distribution<int>(0, 3)(random); steps > 0; --steps) {
    x = std::nextafter(x, random() % 2 == 0 ? 1.0 : 0.0);
  }
  return x;
}
double off_lattice(Random& random) {
  const double x = 0.1 * std::uniform_int_distribution<int>(-2, 2)(random);
  return random() % 4 == 0 ? std::nextafter(x, 9.0) : x;
}
double any_finite(Random& random) {
  for (;;) {
    const std::uint64_t bits = random();
    const double x = std::bit_cast<double>(bits);
    if (std::isfinite(x)) return x;
  }
}
double denormal(Random& random) {
  return std::uniform_int_distribution<int>(-9, 9)(random) *
         std::numeric_limits<double>::denorm_min();
}
double of_any_size(Random& random) {
  const std::array<double, 5> scales = {1e300, 1.0, 1e-150, 1e-300, 1e-310};
  return uniform(random) * scales[random() % scales.size()];
}

template <int D>
std::vector<Point<D>> points_of(const Coordinate& coordinate, std::size_t count, Random& random) {
  std::vector<Point<D>> points(count);
  for (auto& p : points) {
    for (int k = 0; k < D; ++k) p[k] = coordinate(random);
  }
  return points;
}

// Checks both predicates of a dimension on points of one kind; returns the stages that decided.
template <int D>
std::set<Stage> check(const std::string& name, const Coordinate& coordinate, int rounds) {
  std::set<Stage> stages;
  for (int seed = 0; seed < rounds; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    for (const std::size_t count : {std::size_t{D + 1}, std::size_t{D + 2}}) {
      const auto points = points_of<D>(coordinate, count, random);
      const Decision decision = decide(points);
      EXPECT_EQ(decision.sign, exact_sign<D>(points))
          << name << ", seed " << seed << ", " << count << " points in " << D << "D";
      EXPECT_EQ(sign(points), decision.sign);
      stages.insert(decision.stage);
    }
  }
  return stages;
}

struct Kind {
  std::string name;
  Coordinate coordinate;
};

std::vector<Kind> kinds() {
  return {{"uniform", scaled(1)},
          {"1e300", scaled(1e300)},
          {"1e-300", scaled(1e-300)},
          {"1e150", scaled(1e150)},
          {"1e-150", scaled(1e-150)},
          {"1e60", scaled(1e60)},
          {"1e-60", scaled(1e-60)},
          {"lattice", lattice(3, 1)},
          {"lattice, far from the origin", lattice(3, 0.5, 5e6)},
          {"lattice of 0.1", lattice(2, 0.1)},
          {"lattice of 1e-300", lattice(2, 1e-300)},
          {"one ulp off", nearly_half},
          {"lattice of 0.1, one ulp off", off_lattice},
          {"any finite", any_finite},
          {"denormal", denormal},
          {"of any size", of_any_size}};
}

TEST(Predicates, HaveTheSignOfRationalArithmeticIn2D) {
  for (const Kind& kind : kinds()) check<2>(kind.name, kind.coordinate, 1500);
}

TEST(Predicates, HaveTheSignOfRationalArithmeticIn3D) {
  for (const Kind& kind : kinds()) check<3>(kind.name, kind.coordinate, 400);
}

TEST(Predicates, FollowTheirConventions) {
  EXPECT_EQ(orient2d({0, 0}, {1, 0}, {0, 1}), 1);
  EXPECT_EQ(incircle({0, 0}, {1, 0}, {0, 1}, {0.5, 0.5}), 1);
  EXPECT_EQ(incircle({0, 0}, {1, 0}, {0, 1}, {2, 2}), -1);
  EXPECT_EQ(incircle({0, 0}, {1, 0}, {0, 1}, {1, 1}), 0);
  EXPECT_EQ(orient3d({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}), 1);
  EXPECT_EQ(insphere({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.5, 0.5, 0.5}), 1);
  EXPECT_EQ(insphere({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {2, 2, 2}), -1);
  EXPECT_EQ(insphere({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}), 0);
}

TEST(Predicates, AreAntisymmetric) {
  for (int seed = 0; seed < 500; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    const auto p = points_of<2>(lattice(2, 0.1), 4, random);
    const auto q = points_of<3>(lattice(2, 0.1), 5, random);
    EXPECT_EQ(orient2d(p[0], p[1], p[2]), -orient2d(p[1], p[0], p[2])) << seed;
    EXPECT_EQ(incircle(p[0], p[1], p[2], p[3]), -incircle(p[0], p[2], p[1], p[3])) << seed;
    EXPECT_EQ(orient3d(q[0], q[1], q[2], q[3]), -orient3d(q[1], q[0], q[2], q[3])) << seed;
    EXPECT_EQ(insphere(q[0], q[1], q[2], q[3], q[4]), -insphere(q[0], q[1], q[3], q[2], q[4]))
        << seed;
  }
}

TEST(Predicates, AreDecidedByTheStageMeantForTheInput) {
  using enum Stage;
  const auto stage2 = [](const std::vector<Point<2>>& p) { return decide(p).stage; };
  const auto stage3 = [](const std::vector<Point<3>>& p) { return decide(p).stage; };

  EXPECT_EQ(stage2({{0, 0}, {1, 0}, {0, 1}}), kFilter);
  EXPECT_EQ(stage2({{0, 0}, {1, 1}, {2, 2}}), kInteger);
  EXPECT_EQ(stage2({{0.1, 0.1}, {0.2, 0.2}, {0.3, 0.3}}), kExpansion);
  EXPECT_EQ(stage2({{0.1, 0.1}, {0.3, 0.3}, {12, std::nextafter(12.0, 13.0)}}), kDoubleDouble);
  EXPECT_EQ(stage2({{0, 0}, {1e300, 1e300}, {-1e300, -1e300}}), kBigInteger);
  EXPECT_EQ(stage2({{0, 0}, {1e-300, 1e-300}, {3e-300, 3e-300}}), kBigInteger);

  EXPECT_EQ(stage2({{0, 0}, {1, 0}, {0, 1}, {9, 9}}), kFilter);
  EXPECT_EQ(stage2({{0, 0}, {1, 0}, {0, 1}, {1, 1}}), kInteger);
  EXPECT_EQ(stage2({{0.1, 0.3}, {0.1, -0.3}, {-0.1, 0.3}, {-0.1, -0.3}}), kExpansion);
  EXPECT_EQ(stage2({{0, 0}, {1, 0}, {0, 1}, {1, std::nextafter(1.0, 2.0)}}), kDoubleDouble);
  EXPECT_EQ(stage2({{0, 0}, {1e99, 0}, {0, 1e99}, {1e99, 1e99}}), kBigInteger);

  EXPECT_EQ(stage3({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}), kFilter);
  EXPECT_EQ(stage3({{0, 0, 7}, {1, 0, 7}, {0, 1, 7}, {5, 5, 7}}), kInteger);
  EXPECT_EQ(stage3({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}}), kInteger);
  EXPECT_EQ(stage3({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {3, 3, 3}}), kFilter);
}

TEST(Predicates, EveryStageDecidesSomething) {
  std::set<Stage> in2d, in3d;
  for (const Kind& kind : kinds()) {
    in2d.merge(check<2>(kind.name, kind.coordinate, 100));
    in3d.merge(check<3>(kind.name, kind.coordinate, 100));
  }
  EXPECT_EQ(in2d.size(), 5U);
  EXPECT_EQ(in3d.size(), 5U);
}

}  // namespace
}  // namespace delray::delaunay
