#include "delaunay/tiles/point_sample.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "comm/threads.h"
#include "delaunay/mesh/random.h"

namespace delray::delaunay {
namespace {

std::vector<double> numbers(const std::vector<glm::dvec3>& places) {
  std::vector<double> result;
  for (const glm::dvec3& place : places) result.push_back(place.x);
  std::ranges::sort(result);
  return result;
}

// The sample of n points by some ranks, each of several parts, dealt out at random.
std::vector<double> sampled(std::size_t most, std::uint64_t n, int ranks, std::uint64_t seed) {
  std::vector<double> result;
  comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
    const auto rank = static_cast<std::uint64_t>(communicator.rank());
    std::vector<PointSample> parts(3, PointSample(most));
    for (std::uint64_t i = 0; i < n; ++i) {
      RowRandom random(seed, i);
      if (random.below(static_cast<std::uint64_t>(ranks)) != rank) continue;
      parts[random.below(3)].add(i, glm::dvec3(static_cast<double>(i)));
    }
    for (const std::size_t other : {1, 2}) parts[0].add(parts[other]);
    EXPECT_LE(parts[0].size(), most);
    auto places = std::move(parts[0]).gather(communicator);
    if (communicator.rank() == 0) {
      result = numbers(places);
    } else {
      EXPECT_TRUE(places.empty());
    }
  });
  return result;
}

TEST(PointSample, KeepsAllWhereTheyAreFew) {
  for (const int ranks : {1, 3}) {
    const auto kept = sampled(100, 100, ranks, 1);
    ASSERT_EQ(kept.size(), 100U);
    for (std::size_t i = 0; i < 100; ++i) EXPECT_EQ(kept[i], static_cast<double>(i));
    EXPECT_TRUE(sampled(100, 0, ranks, 1).empty());
  }
}

TEST(PointSample, DependsOnTheNumbersAlone) {
  for (const std::uint64_t n : {101U, 1000U, 20000U}) {
    const auto kept = sampled(100, n, 1, 1);
    EXPECT_LE(kept.size(), 100U);
    EXPECT_GE(kept.size(), 20U);
    for (const int ranks : {2, 5, 8}) {
      for (const std::uint64_t seed : {1, 2})
        EXPECT_EQ(sampled(100, n, ranks, seed), kept) << ranks;
    }
  }
}

// A tenth of the numbers makes up about a tenth of the sample.
TEST(PointSample, IsEven) {
  const auto kept = sampled(10000, 200000, 2, 1);
  for (int tenth = 0; tenth < 10; ++tenth) {
    const auto count = std::ranges::count_if(
        kept, [&](double number) { return static_cast<int>(number / 20000) == tenth; });
    EXPECT_NEAR(static_cast<double>(count), static_cast<double>(kept.size()) / 10,
                5 * std::sqrt(static_cast<double>(kept.size()) / 10));
  }
}

}  // namespace
}  // namespace delray::delaunay
