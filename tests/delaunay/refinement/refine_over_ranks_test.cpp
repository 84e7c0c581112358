// Ranks refine as one does: the same promises, for any number of ranks, and the same bytes however
// messages arrive.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>

#include "comm/simulated.h"
#include "comm/threads.h"
#include "delaunay/generate.h"
#include "tests/delaunay/hard_points.h"
#include "tests/delaunay/refinement/expect_refined.h"

namespace delray::delaunay {
namespace {

constexpr int kRanks[] = {1, 2, 3, 4, 8};

// By so many ranks, of which rank 0 alone has the outline, in an order of arrival of the seed.
Refined refine_simulated(int ranks, const Outline& outline, const RefineOptions& options,
                         std::uint64_t seed = 1) {
  Refined result;
  comm::run_simulated(ranks, comm::any_order(), seed, [&](comm::Communicator& communicator) {
    const bool is_first = communicator.rank() == 0;
    Refined refined = refine(communicator, is_first ? outline : Outline{}, options);
    if (is_first) {
      result = std::move(refined);
    } else {
      EXPECT_TRUE(refined.points.empty() && refined.triangulation.vertices.empty());
    }
  });
  return result;
}

Outline outline_of(const std::vector<glm::dvec3>& points) {
  Outline outline;
  outline.points.positions = points;
  return outline;
}

void expect_same(const Refined& a, const Refined& b) {
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.triangulation.vertices, b.triangulation.vertices);
  EXPECT_EQ(a.inside, b.inside);
  EXPECT_EQ(a.segments, b.segments);
  EXPECT_EQ(a.counts.rounds, b.counts.rounds);
  EXPECT_EQ(a.counts.denied, b.counts.denied);
}

std::uint64_t sum_of(const Refined& refined, std::uint64_t RefineRank::*count) {
  std::uint64_t sum = 0;
  for (const RefineRank& rank : refined.ranks) sum += rank.*count;
  return sum;
}

// What is counted fits together.
void expect_counts(const Refined& refined, int ranks) {
  ASSERT_EQ(refined.ranks.size(), static_cast<std::size_t>(ranks));
  // Others were added before, to make segments edges.
  EXPECT_LE(sum_of(refined, &RefineRank::points),
            refined.counts.on_segments + refined.counts.inside);
  EXPECT_GE(sum_of(refined, &RefineRank::requests), sum_of(refined, &RefineRank::denials));
  EXPECT_GE(sum_of(refined, &RefineRank::fetched), sum_of(refined, &RefineRank::returned));
  EXPECT_GT(refined.counts.rounds, 0U);
  if (ranks > 1) return;
  EXPECT_EQ(sum_of(refined, &RefineRank::messages) + sum_of(refined, &RefineRank::fetched), 0U);
}

Refined checked(int ranks, const Outline& outline, const RefineOptions& options) {
  Refined refined = refine_simulated(ranks, outline, options);
  expect_refined(outline, options, refined);
  expect_counts(refined, ranks);
  return refined;
}

// Added points beside those of one thread.
double ratio(const Refined& refined, const Refined& alone, const Outline& outline) {
  const auto given = static_cast<double>(outline.points.size());
  return (static_cast<double>(refined.points.size()) - given) /
         (static_cast<double>(alone.points.size()) - given);
}

TEST(RefineOverRanks, ReachesTheAngleOnOutlinesAndKeepsThem) {
  for (const OutlineGenerator& kind : outline_generators()) {
    for (const std::uint64_t seed : {1, 2}) {
      const Outline outline = generate_outline(kind.name, 300, seed);
      const double length = length_of(outline.points.positions, outline.segments);
      for (const double max_area : {0.0, 1e-4}) {
        const RefineOptions options{.min_angle = 25, .max_area = max_area};
        const Refined alone = refine(outline, options);
        for (const int ranks : kRanks) {
          SCOPED_TRACE(std::string(kind.name) + ", seed " + std::to_string(seed) + ", area " +
                       std::to_string(max_area) + ", " + std::to_string(ranks) + " ranks");
          const Refined refined = checked(ranks, outline, options);
          EXPECT_NEAR(length_of(refined.points, refined.segments), length, 1e-11 * length);
          EXPECT_NEAR(area_of(refined), area_of(alone), 1e-12);
          EXPECT_LT(ratio(refined, alone, outline), 1.1);
          if (ranks > 1 && max_area > 0) {
            EXPECT_GT(sum_of(refined, &RefineRank::fetched), 0U);
          }
        }
      }
    }
  }
}

TEST(RefineOverRanks, ReachesTheAngleOnPoints) {
  for (const char* kind : {"uniform", "cluster", "grid"}) {
    const Outline outline = outline_of(generate_points(kind, 1500, 2, 7).positions);
    const Refined alone = refine(outline, {.min_angle = 25});
    for (const int ranks : kRanks) {
      SCOPED_TRACE(std::string(kind) + ", " + std::to_string(ranks) + " ranks");
      const Refined refined = checked(ranks, outline, {.min_angle = 25});
      EXPECT_LT(ratio(refined, alone, outline), 1.1);
    }
  }
}

// The result and the rounds depend on the number of ranks and not on the order of arrival, nor on
// what kind of ranks they are.
TEST(RefineOverRanks, IsTheSameHoweverMessagesArrive) {
  const Outline outline = generate_outline("country", 300, 4);
  const RefineOptions options{.min_angle = 25, .max_area = 2e-4};
  for (const int ranks : kRanks) {
    SCOPED_TRACE(std::to_string(ranks) + " ranks");
    const Refined first = refine_simulated(ranks, outline, options);
    for (const std::uint64_t seed : {2, 3}) {
      expect_same(refine_simulated(ranks, outline, options, seed), first);
    }
    comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
      const Refined refined = refine(communicator, outline, options);
      if (communicator.rank() == 0) expect_same(refined, first);
    });
  }
}

// No rank has room for the whole mesh.
TEST(RefineOverRanks, RanksHaveParts) {
  const RefineOptions options{.max_area = 2e-5};
  const Refined refined = checked(4, square(), options);
  const std::uint64_t all = refined.triangulation.size();
  for (const RefineRank& rank : refined.ranks) {
    EXPECT_LT(rank.most_triangles, all / 2);
    EXPECT_GT(rank.points, 0U);
  }
  EXPECT_EQ(sum_of(refined, &RefineRank::points), refined.points.size() - 4);
  EXPECT_GT(sum_of(refined, &RefineRank::denials), 0U);
}

TEST(RefineOverRanks, MoreRanksThanTriangles) {
  for (const int ranks : {2, 8, 13}) {
    SCOPED_TRACE(std::to_string(ranks) + " ranks");
    EXPECT_EQ(checked(ranks, square(), {.min_angle = 20}).points.size(), 4U);
    checked(ranks, polygon({{0, 0}, {1, 0}, {0.5, 0.01}}), {.min_angle = 30});
    checked(ranks, square(), {.min_angle = 30, .max_area = 0.01});
  }
}

TEST(RefineOverRanks, NothingToRefine) {
  for (const int ranks : {1, 3}) {
    const Outline line = outline_of(generate_points("collinear", 50, 2, 1).positions);
    EXPECT_EQ(refine_simulated(ranks, line, {}).triangulation.size(), 0U);
    EXPECT_EQ(refine_simulated(ranks, {}, {}).points.size(), 0U);
    const Refined refined = checked(ranks, square(), {.min_angle = 0});
    EXPECT_EQ(refined.points.size(), 4U);
    EXPECT_EQ(refined.counts.rounds, 1U);
  }
}

TEST(RefineOverRanks, NarrowCornersTakeFewPoints) {
  for (const double second : {1.25, 1.001}) {
    for (const double degrees : {50.0, 10.0, 1.0, 1e-4}) {
      const double radians = degrees * std::numbers::pi / 180;
      const glm::dvec2 end = {second * std::cos(radians), second * std::sin(radians)};
      for (const int ranks : kRanks) {
        SCOPED_TRACE(std::to_string(second) + ", " + std::to_string(degrees) + " degrees, " +
                     std::to_string(ranks) + " ranks");
        const Refined refined =
            checked(ranks, polygon({{0, 0}, {1, 0}, end}), {.min_angle = 25, .max_points = 10'000});
        EXPECT_LT(refined.points.size(), 200U);
      }
    }
  }
}

// Triangles are right-angled, so that rounding decides what encroaches, and segments meet at any
// angle.
TEST(RefineOverRanks, AnySegmentsOnALatticeAreKept) {
  for (std::uint32_t seed = 0; seed < 60; ++seed) {
    std::mt19937 random(seed);
    const auto side = 3 + random() % 6;
    Outline outline = polygon({{0, 0}, {side, 0}, {side, side}, {0, side}});
    for (auto more = random() % 20; more > 0; --more) {
      outline.points.positions.emplace_back(random() % (side + 1), random() % (side + 1), 0);
    }
    const std::size_t points = outline.points.size();
    for (auto more = random() % 12; more > 0; --more) {
      outline.segments.push_back({static_cast<std::uint32_t>(random() % points),
                                  static_cast<std::uint32_t>(random() % points)});
    }
    const int ranks = kRanks[random() % std::size(kRanks)];
    SCOPED_TRACE("seed " + std::to_string(seed) + ", " + std::to_string(ranks) + " ranks");
    checked(ranks, outline,
            {.min_angle = static_cast<double>(random() % 31),
             .max_area = random() % 2 == 0 ? 0 : 0.125,
             .max_points = 100'000});
  }
}

TEST(RefineOverRanks, ReachesTheAngleOnHardPoints) {
  expect_refined_hard_points([](const Outline& outline) {
    return refine_simulated(3, outline, {.min_angle = kHardPointsAngle, .max_points = 1'000'000});
  });
}

TEST(RefineOverRanks, HeightsAreThoseOfTheGivenTriangulation) {
  Outline outline = generate_outline("lake", 100, 3);
  outline.points.has_z = true;
  const auto height = [](const glm::dvec3& p) { return 3 * p.x - 2 * p.y + 7; };
  for (glm::dvec3& p : outline.points.positions) p.z = height(p);
  const Refined refined = refine_simulated(3, outline, {.min_angle = 25});
  EXPECT_GT(refined.points.size(), outline.points.size());
  for (const glm::dvec3& p : refined.points) EXPECT_NEAR(p.z, height(p), 1e-9);
}

// All ranks throw; those that go on would wait for ever, which the simulated machine finds.
template <class Exception>
void expect_all_throw(int ranks, const Outline& outline, const RefineOptions& options) {
  int thrown = 0;
  comm::run_simulated(ranks, comm::any_order(), 1, [&](comm::Communicator& communicator) {
    try {
      refine(communicator, communicator.rank() == 0 ? outline : Outline{}, options);
    } catch (const Exception&) {
      ++thrown;
    }
  });
  EXPECT_EQ(thrown, ranks);
}

TEST(RefineOverRanks, AllRanksThrow) {
  for (const int ranks : {1, 2, 4}) {
    expect_all_throw<std::invalid_argument>(ranks, square(), {.min_angle = 31});
    expect_all_throw<std::invalid_argument>(ranks, square(), {.method = "ruppert"});
    expect_all_throw<std::length_error>(ranks, square(), {.max_area = 1e-9, .max_points = 1000});
    Outline open = square();
    open.segments.pop_back();
    expect_all_throw<std::invalid_argument>(ranks, open, {});
    parallel::Progress progress;
    progress.request_stop();
    expect_all_throw<parallel::Interrupted>(ranks, square(),
                                            {.max_area = 1e-4, .progress = &progress});
  }
}

// Not beyond the bound, though ranks add points at the same time.
TEST(RefineOverRanks, MostPointsAreAsManyAsAllowed) {
  for (const int ranks : kRanks) {
    SCOPED_TRACE(std::to_string(ranks) + " ranks");
    RefineOptions options{.max_area = 0.01};
    const std::size_t needed = refine_simulated(ranks, square(), options).points.size();
    options.max_points = needed / 2;
    expect_all_throw<std::length_error>(ranks, square(), options);
    options.max_points = 2 * needed;
    EXPECT_LE(refine_simulated(ranks, square(), options).points.size(), options.max_points);
  }
}

}  // namespace
}  // namespace delray::delaunay
