// The same as combinations_test.cpp for more and for measured points; takes hours. Runs where
// DELRAY_FULL_TESTS is set (`./test --full`).
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

#include "delaunay/generate.h"
#include "delaunay/methods.h"
#include "delaunay/read_points.h"
#include "tests/delaunay/same_simplices.h"

namespace delray::delaunay {
namespace {

constexpr std::array<int, 4> kThreads = {1, 2, 3, 8};

struct Share {
  int dim;
  std::string method;
  friend void PrintTo(const Share& share, std::ostream* out) {
    *out << share.dim << "D " << share.method;
  }
};

std::vector<Share> shares() {
  std::vector<Share> result;
  for (const Method& method : methods()) {
    for (const int dim : method.dims) result.push_back({dim, std::string(method.name)});
  }
  return result;
}

// One test for each method, so that several may run at a time.
class FullCombinations : public testing::TestWithParam<Share> {
 protected:
  void SetUp() override {
    if (std::getenv("DELRAY_FULL_TESTS") == nullptr) {
      GTEST_SKIP() << "set DELRAY_FULL_TESTS for all combinations on all points";
    }
  }

  // All combinations of the method with all numbers of threads.
  template <class Points>
  void expect_same_of_all(const Points& points, const std::string& name, std::uint64_t seed) {
    const Triangulation expected = expected_of(points, GetParam().dim);
    for (Options options : combinations(GetParam().dim)) {
      if (options.method != GetParam().method) continue;
      options.seed = seed;
      for (const int threads : kThreads) {
        options.threads = threads;
        ASSERT_NO_FATAL_FAILURE(expect_same(points, expected, options, name));
      }
    }
  }

  template <int D>
  void expect_same_of_hard_points() {
    for (const std::size_t n : {4, 20, 150, 500, 2000}) {
      std::uint64_t seed = 2000 + n;
      for (const auto& kind : hard_points_of<D>()) {
        ++seed;
        ASSERT_NO_FATAL_FAILURE(expect_same_of_all(kind.make(n, seed), kind.name, seed));
      }
    }
  }
};

TEST_P(FullCombinations, OfHardPoints) {
  GetParam().dim == 2 ? expect_same_of_hard_points<2>() : expect_same_of_hard_points<3>();
}

TEST_P(FullCombinations, OfEveryDistribution) {
  const std::size_t n = GetParam().dim == 2 ? 20'000 : 6'000;
  for (const auto& generator : point_generators()) {
    const auto cloud = generator.generate(n, GetParam().dim, 5);
    ASSERT_NO_FATAL_FAILURE(expect_same_of_all(cloud.positions, std::string(generator.name), 5));
  }
}

TEST_P(FullCombinations, OfEveryFile) {
  const std::filesystem::path folder = DELRAY_SHARED_DATA;
  if (!exists(folder)) GTEST_SKIP() << "no real data in " << folder;
  for (const char* file :
       {"issue13.json", "robustness1.json", "robustness2.json", "ukraine.json", "LakeSuperior.txt",
        "spot.obj", "teapot.obj", "autzen_trim.las", "CSite1-lidar.ply"}) {
    const PointCloud cloud = read_points(folder / file);
    ASSERT_NO_FATAL_FAILURE(expect_same_of_all(cloud.positions, file, 1));
  }
}

INSTANTIATE_TEST_SUITE_P(OfAllMethods, FullCombinations, testing::ValuesIn(shares()),
                         [](const auto& instance) {
                           std::string name =
                               instance.param.method + std::to_string(instance.param.dim) + "D";
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace delray::delaunay
