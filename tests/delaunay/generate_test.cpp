// Generated points: reproducible bits, and properties that each kind promises.
#include "delaunay/generate.h"

#include <gtest/gtest.h>
#include <xxhash.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <tuple>

#include "delaunay/mesh/random.h"
#include "delaunay/predicates.h"
#include "parallel/arena.h"

namespace delray::delaunay {
namespace {

glm::dvec2 flat(const glm::dvec3& p) { return {p.x, p.y}; }

std::uint64_t bits_of(const PointCloud& cloud) {
  return XXH3_64bits(cloud.positions.data(), cloud.size() * sizeof(glm::dvec3));
}

std::size_t count_distinct(const PointCloud& cloud) {
  std::set<std::tuple<double, double, double>> distinct;
  for (const glm::dvec3& p : cloud.positions) distinct.emplace(p.x, p.y, p.z);
  return distinct.size();
}

TEST(Generate, MakesFinitePointsOfTheDimensionAndNumberAskedFor) {
  for (const PointGenerator& generator : point_generators()) {
    for (const int dim : {2, 3}) {
      for (const std::size_t n : {0, 1, 2, 7, 1000}) {
        const PointCloud cloud = generate_points(generator.name, n, dim, 5);
        ASSERT_EQ(cloud.size(), n) << generator.name;
        EXPECT_EQ(cloud.has_z, dim == 3);
        for (const glm::dvec3& p : cloud.positions) {
          ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
          if (dim == 2) {
            ASSERT_EQ(p.z, 0);
          }
        }
      }
    }
  }
}

TEST(Generate, DependsOnTheSeedAndNotOnTheThreads) {
  for (const PointGenerator& generator : point_generators()) {
    for (const int dim : {2, 3}) {
      const std::uint64_t bits = bits_of(generator.generate(20000, dim, 1));
      parallel::Arena alone(1), several(2);
      EXPECT_EQ(bits, alone.execute([&] { return bits_of(generator.generate(20000, dim, 1)); }));
      EXPECT_EQ(bits, several.execute([&] { return bits_of(generator.generate(20000, dim, 1)); }));
      const std::set<std::string_view> without_seed = {"grid", "spiral"};
      EXPECT_EQ(bits == bits_of(generator.generate(20000, dim, 2)),
                without_seed.contains(generator.name))
          << generator.name;
    }
  }
}

// The same bits on every machine: whoever changes a generator changes these.
TEST(Generate, MakesTheSameBitsEverywhere) {
  const std::map<std::string_view, std::uint64_t> expected = {
      {"uniform", 7160551330421976085U},  {"gauss", 5932171125628372380U},
      {"cluster", 15473838488162438543U}, {"grid", 17914495169649000579U},
      {"arc", 15684439675547040512U},     {"sphere", 9531178345953666371U},
  };
  for (const auto& [name, bits] : expected) {
    EXPECT_EQ(bits_of(generate_points(name, 1000, 3, 1)), bits) << name;
  }
}

TEST(Generate, StaysInTheUnitCube) {
  for (const char* name :
       {"uniform", "gauss", "cluster", "grid", "arc", "sphere", "duplicates", "two-lines"}) {
    for (const glm::dvec3& p : generate_points(name, 20000, 3, 8).positions) {
      for (int k = 0; k < 3; ++k) ASSERT_TRUE(p[k] >= 0 && p[k] <= 1) << name;
    }
  }
}

TEST(Generate, GridHasNoHolesAndSquareCells) {
  const PointCloud square = generate_points("grid", 1000 * 1000, 2, 1);
  EXPECT_EQ(square.positions[1000].y, square.positions[1].x);
  EXPECT_EQ(square.positions[999'999], glm::dvec3(999.0 / 1024, 999.0 / 1024, 0));
  EXPECT_EQ(count_distinct(generate_points("grid", 1001, 3, 1)), 1001U);
  const auto cube = generate_points("grid", 27, 3, 1).positions;
  EXPECT_EQ(cube.back(), glm::dvec3(0.5));
}

TEST(Generate, GaussHasItsMeanAndDeviation) {
  constexpr std::size_t kCount = 100000;
  double sum = 0, squares = 0;
  for (std::size_t i = 0; i < kCount; ++i) {
    RowRandom random(3, i);
    const double value = random.normal();
    sum += value;
    squares += value * value;
  }
  EXPECT_NEAR(sum / kCount, 0, 0.02);
  EXPECT_NEAR(squares / kCount, 1, 0.03);
}

TEST(Generate, PortableLogarithmIsALogarithm) {
  for (std::size_t i = 0; i < 10000; ++i) {
    RowRandom random(4, i);
    const double x = std::ldexp(random.uniform(0.5, 1), static_cast<int>(random.below(100)) - 90);
    EXPECT_NEAR(portable_log(x), std::log(x), 4e-16 * std::max(1.0, std::abs(std::log(x))));
  }
  EXPECT_EQ(portable_log(1), 0);
}

TEST(Generate, DegenerateSetsAreExactlySo) {
  const auto line = generate_points("collinear", 300, 2, 6).positions;
  const auto circle = generate_points("cocircular", 300, 2, 6).positions;
  const auto plane = generate_points("coplanar", 300, 3, 6).positions;
  const auto ball = generate_points("cocircular", 300, 3, 6).positions;
  EXPECT_GT(count_distinct(generate_points("cocircular", 3000, 2, 6)), 200U);
  EXPECT_GT(count_distinct(generate_points("cocircular", 3000, 3, 6)), 200U);
  for (std::size_t i = 0; i + 4 < 300; ++i) {
    EXPECT_EQ(orient2d(flat(line[i]), flat(line[i + 1]), flat(line[i + 2])), 0);
    EXPECT_EQ(
        incircle(flat(circle[i]), flat(circle[i + 1]), flat(circle[i + 2]), flat(circle[i + 3])),
        0);
    EXPECT_EQ(orient3d(plane[i], plane[i + 1], plane[i + 2], plane[i + 3]), 0);
    EXPECT_EQ(insphere(ball[i], ball[i + 1], ball[i + 2], ball[i + 3], ball[i + 4]), 0);
  }
  EXPECT_EQ(count_distinct(generate_points("equal", 100, 3, 6)), 1U);
  const std::size_t distinct = count_distinct(generate_points("duplicates", 8000, 3, 6));
  EXPECT_GT(distinct, 500U);
  EXPECT_LT(distinct, 1002U);
}

TEST(Generate, RefusesUnknownKindsAndNamesTheLegalOnes) {
  try {
    generate_points("donut", 3, 2, 1);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("uniform gauss cluster grid arc sphere"),
              std::string::npos);
  }
}

}  // namespace
}  // namespace delray::delaunay
