// Refinements keep their promises: the result is the Delaunay triangulation of its points, segments
// are chains of its edges, and triangles of the domain are as they should be but for small corners.
#include "delaunay/refine.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>

#include "delaunay/generate.h"
#include "delaunay/quality.h"
#include "delaunay/verify.h"
#include "parallel/arena.h"
#include "tests/delaunay/hard_points.h"
#include "tests/delaunay/refinement/expect_refined.h"

namespace delray::delaunay {
namespace {

Refined checked(const Outline& outline, const RefineOptions& options) {
  Refined refined = refine(outline, options);
  expect_refined(outline, options, refined);
  return refined;
}

TEST(Refine, ReachesTheAngleOnOutlinesAndKeepsThem) {
  for (const OutlineGenerator& kind : outline_generators()) {
    for (const std::uint64_t seed : {1, 2, 3}) {
      for (const double angle : {20.0, 25.0, 30.0}) {
        SCOPED_TRACE(std::string(kind.name) + ", seed " + std::to_string(seed) + ", angle " +
                     std::to_string(angle));
        const Outline outline = generate_outline(kind.name, 150, seed);
        const Refined refined = checked(outline, {.min_angle = angle});
        const double length = length_of(outline.points.positions, outline.segments);
        EXPECT_NEAR(length_of(refined.points, refined.segments), length, 1e-11 * length);
        for (const auto& piece : refined.segments) {
          double nearest = std::numeric_limits<double>::infinity();
          const glm::dvec2 p = refined.points[piece[0]], q = refined.points[piece[1]];
          for (const auto& [a, b] : outline.segments) {
            const glm::dvec2 start = outline.points.positions[a], end = outline.points.positions[b];
            nearest =
                std::min(nearest, std::max(distance_to(p, start, end), distance_to(q, start, end)));
          }
          EXPECT_LT(nearest, 1e-14);
        }
      }
    }
  }
}

TEST(Refine, EveryMethodReachesTheAngleWithAnyThreads) {
  for (const RefinementMethod& method : refinement_methods()) {
    for (const int threads : {1, 2, 3, 8}) {
      const parallel::AllowThreads allowed(threads);
      parallel::Arena arena(threads);
      for (const char* kind : {"country", "star"}) {
        SCOPED_TRACE(std::string(method.name) + ", " + std::to_string(threads) + " threads, " +
                     kind);
        const Outline outline = generate_outline(kind, 150, 6);
        arena.execute([&] {
          checked(outline, {.min_angle = 25,
                            .max_area = 1e-4,
                            .method = std::string(method.name),
                            .threads = threads});
        });
      }
      Outline points;
      points.points = generate_points("cluster", 2000, 2, 3);
      arena.execute(
          [&] { checked(points, {.method = std::string(method.name), .threads = threads}); });
    }
  }
}

TEST(Refine, ChewsTrianglesAreOfOneSize) {
  const double area = 1e-3, radius = std::sqrt(4 * area / (3 * std::sqrt(3.0)));
  const RefineOptions options{.min_angle = 20, .max_area = area, .method = "chew"};
  const Refined refined = checked(square(), options);
  const Triangulation domain = domain_of(refined);
  const Quality reached = quality(view(refined.points), domain);
  double longest = 0;
  for (std::size_t i = 0; i < domain.vertices.size(); ++i) {
    const glm::dvec3 &a = refined.points[domain.vertices[i]],
                     &b = refined.points[domain.vertices[i / 3 * 3 + (i + 1) % 3]];
    longest = std::max(longest, glm::length(a - b));
  }
  EXPECT_LE(longest, 2 * radius);
  EXPECT_GE(reached.mean_min_angle, 40);
  EXPECT_GE(reached.min_angle, 25);
}

TEST(Refine, TheDomainHasTheAreaOfTheOutline) {
  for (const char* kind : {"lake", "country"}) {
    const Outline outline = generate_outline(kind, 400, 5);
    double twice = 0;  // the domain is to the left of all segments
    for (const auto& [a, b] : outline.segments) {
      const glm::dvec3 &p = outline.points.positions[a], &q = outline.points.positions[b];
      twice += p.x * q.y - p.y * q.x;
    }
    ASSERT_GT(twice, 0) << kind;
    const Refined refined = checked(outline, {.min_angle = 20, .max_area = 1e-3});
    EXPECT_NEAR(area_of(refined), twice / 2, 1e-12) << kind;
  }
}

TEST(Refine, ReachesTheAngleOnHardPoints) {
  expect_refined_hard_points([](const Outline& outline) {
    return refine(outline, {.min_angle = kHardPointsAngle, .max_points = 1'000'000});
  });
}

TEST(Refine, AnAngleOfZeroMakesSegmentsEdgesOnly) {
  const Refined plain = checked(square(), {.min_angle = 0});
  EXPECT_EQ(plain.points.size(), 4U);
  EXPECT_EQ(plain.triangulation.size(), 2U);
  // The long segment is no edge before points near it cut it.
  Outline outline = polygon({{-4, -1}, {4, -1}, {4, 1}, {-4, 1}});
  add_segment(outline, {-3, 0}, {3, 0});
  outline.points.positions.emplace_back(0.25, 0.125, 0);
  const Refined refined = checked(outline, {.min_angle = 0});
  EXPECT_GT(refined.counts.on_segments, 0U);
  EXPECT_EQ(refined.counts.inside, 0U);
}

TEST(Refine, SegmentsThatMeetWithoutAPointGetOne) {
  Outline outline = square();
  add_segment(outline, {0.125, 0.25}, {0.875, 0.75});
  add_segment(outline, {0.125, 0.625}, {0.75, 0.25});
  const Refined refined = checked(outline, {.min_angle = 20});
  EXPECT_EQ(refined.counts.crossings, 1U);
  const double length = length_of(outline.points.positions, outline.segments);
  EXPECT_NEAR(length_of(refined.points, refined.segments), length, 1e-12);
}

TEST(Refine, SegmentsGoThroughPointsOnThemAndCountOnce) {
  Outline outline = square();
  outline.points.positions.emplace_back(0.25, 0, 0);           // on a side
  outline.points.positions.emplace_back(0.5, 1 + 0x1p-52, 0);  // beside one, by rounding
  outline.segments.push_back({0, 4});                          // a part of a side
  outline.segments.push_back({1, 0});                          // a side again
  outline.segments.push_back({2, 2});                          // nothing
  const Refined refined = checked(outline, {.min_angle = 20});
  EXPECT_NEAR(length_of(refined.points, refined.segments), 4, 1e-12);
  EXPECT_LT(refined.points.size(), 40U);
}

// A square with points and segments on a lattice: segments cross, go through points, lie upon each
// other and meet at any angle, and triangles are right-angled.
TEST(Refine, AnySegmentsOnALatticeAreKept) {
  int refinements = 0;
  for (std::uint32_t seed = 0; seed < 400; ++seed) {
    std::mt19937 random(seed);
    Outline outline;
    const auto side = 3 + random() % 6, points = 4 + random() % 20;
    const double spacing = random() % 2 == 0 ? 1 : 0.1, start = random() % 4 == 0 ? 1e3 : 0;
    const auto add = [&](std::uint64_t x, std::uint64_t y) {
      outline.points.positions.emplace_back(start + spacing * static_cast<double>(x),
                                            start + spacing * static_cast<double>(y), 0);
    };
    for (std::uint32_t i = 0; i < points; ++i) {
      const auto x = random() % (side + 1), y = random() % (side + 1);
      add(x, y);
    }
    const auto first = static_cast<std::uint32_t>(points);
    add(0, 0);
    add(side, 0);
    add(side, side);
    add(0, side);
    for (std::uint32_t k = 0; k < 4; ++k)
      outline.segments.push_back({first + k, first + (k + 1) % 4});
    for (auto more = random() % 12; more > 0; --more) {
      const auto a = static_cast<std::uint32_t>(random() % (points + 4)),
                 b = static_cast<std::uint32_t>(random() % (points + 4));
      outline.segments.push_back({a, b});
    }
    SCOPED_TRACE("seed " + std::to_string(seed));
    checked(outline, {.min_angle = static_cast<double>(random() % 31),
                      .max_area = random() % 2 == 0 ? 0 : spacing * spacing / 8,
                      .max_points = 100'000});
    ++refinements;
  }
  EXPECT_EQ(refinements, 400);
}

// Cuts of both sides are beside each other, so that a corner takes points by the logarithm of its
// width, also far from it.
TEST(Refine, NarrowCornersTakeFewPoints) {
  for (const double second : {1.25, 1.001, 1 + 1e-9}) {
    for (const double degrees : {1.0, 1e-2, 1e-4, 1e-6, 1e-8}) {
      const double radians = degrees * std::numbers::pi / 180;
      const glm::dvec2 end = {second * std::cos(radians), second * std::sin(radians)};
      SCOPED_TRACE(std::to_string(second) + ", " + std::to_string(degrees) + " degrees");
      const Refined refined =
          checked(polygon({{0, 0}, {1, 0}, end}), {.min_angle = 25, .max_points = 10'000});
      EXPECT_LT(refined.points.size(), 200U);
    }
  }
}

// Each of three vertices is within rounding of the edge between the two others.
TEST(Refine, VerticesWithinRoundingOfEachOtherEnd) {
  for (const double units : {2, 7, 20, 40, 80, 200}) {
    for (const double start : {1.0, 1e3}) {
      SCOPED_TRACE(std::to_string(units) + " units at " + std::to_string(start));
      Outline outline = polygon({{0, 0}, {2 * start, 0}, {2 * start, 2 * start}, {0, 2 * start}});
      const double unit = 0x1p-52 * start;
      const auto first = static_cast<std::uint32_t>(outline.points.size());
      outline.points.positions.emplace_back(start, start, 0);
      outline.points.positions.emplace_back(start + units * unit, start, 0);
      outline.points.positions.emplace_back(start + units / 2 * unit, start + 0.9 * units * unit,
                                            0);
      for (std::uint32_t k = 0; k < 3; ++k)
        outline.segments.push_back({first + k, first + (k + 1) % 3});
      const Refined refined = refine(outline, {.min_angle = 20, .max_points = 10'000});
      const Verdict verdict =
          verify_triangles(view(refined.points), refined.triangulation.vertices);
      EXPECT_TRUE(verdict.valid && verdict.delaunay) << verdict.reason;
    }
  }
}

TEST(Refine, SmallCornersAreListedAndExceptTheirTriangles) {
  for (const double degrees : {40.0, 10.0, 1.0, 0.01}) {
    const double radians = degrees * std::numbers::pi / 180;
    const Outline outline =
        polygon({{0, 0}, {1, 0}, {1.25 * std::cos(radians), 1.25 * std::sin(radians)}});
    SCOPED_TRACE(degrees);
    const RefineOptions options{.min_angle = 25, .max_points = 1'000'000};
    const Refined refined = checked(outline, options);
    bool is_listed = false;
    for (const SmallCorner& corner : refined.small_corners) {
      is_listed |= corner.row == 0 && std::abs(corner.degrees - degrees) < 1e-9;
    }
    EXPECT_TRUE(is_listed);
    EXPECT_EQ(refined.counts.excepted > 0, degrees < 25);
  }
}

TEST(Refine, HolesAreTakenOut) {
  Outline outline = polygon({{0, 0}, {4, 0}, {4, 4}, {0, 4}});
  const Outline hole = polygon({{1, 1}, {3, 1}, {3, 3}, {1, 3}});
  for (const glm::dvec3& p : hole.points.positions) outline.points.positions.push_back(p);
  for (const auto& [a, b] : hole.segments) outline.segments.push_back({a + 4, b + 4});
  EXPECT_NEAR(area_of(checked(outline, {.min_angle = 25})), 16, 1e-12);
  outline.holes = {{2, 2}, {9, 9}};  // the second is outside anyway
  EXPECT_NEAR(area_of(checked(outline, {.min_angle = 25})), 12, 1e-12);
}

TEST(Refine, HeightsOfAddedPointsAreThoseOfTheGivenTriangulation) {
  Outline outline = generate_outline("lake", 100, 3);
  outline.points.has_z = true;
  const auto height = [](const glm::dvec3& p) { return 3 * p.x - 2 * p.y + 7; };
  for (glm::dvec3& p : outline.points.positions) p.z = height(p);
  const Refined refined = refine(outline, {.min_angle = 25});
  for (const glm::dvec3& p : refined.points) EXPECT_NEAR(p.z, height(p), 1e-9);
}

TEST(Refine, PointsOnALineHaveNoTriangles) {
  Outline outline;
  outline.points = generate_points("collinear", 50, 2, 1);
  EXPECT_EQ(refine(outline, {}).triangulation.size(), 0U);
  outline.points.positions.clear();
  EXPECT_EQ(refine(outline, {}).points.size(), 0U);
}

TEST(Refine, AsManyPointsAsAreNeededSuffice) {
  for (const RefinementMethod& method : refinement_methods()) {
    SCOPED_TRACE(method.name);
    RefineOptions options{.max_area = 0.01, .method = std::string(method.name)};
    const std::size_t needed = refine(square(), options).points.size();
    options.max_points = needed;
    EXPECT_EQ(refine(square(), options).points.size(), needed);
    options.max_points = needed - 1;
    EXPECT_THROW(refine(square(), options), std::length_error);
  }
}

TEST(Refine, AreasThatTakeTooManyPointsAreRefusedAtOnce) {
  for (const RefinementMethod& method : refinement_methods()) {
    parallel::Progress progress;
    RefineOptions options{.max_area = 1e-30, .method = std::string(method.name)};
    options.progress = &progress;
    EXPECT_THROW(refine(square(), options), std::length_error) << method.name;
    EXPECT_EQ(progress.done(), 0U) << method.name;
  }
}

TEST(Refine, ArgumentsThatCannotBe) {
  EXPECT_THROW(refine(square(), {.min_angle = 31}), std::invalid_argument);
  EXPECT_THROW(refine(square(), {.min_angle = -1}), std::invalid_argument);
  EXPECT_THROW(refine(square(), {.max_area = -1}), std::invalid_argument);
  EXPECT_THROW(refine(square(), {.method = "none"}), std::invalid_argument);
  EXPECT_THROW(refine(square(), {.max_area = 1e-9, .max_points = 1000}), std::length_error);
  Outline open = square();
  open.segments.pop_back();
  EXPECT_THROW(refine(open, {}), std::invalid_argument);
  Outline beyond = square();
  beyond.segments.push_back({0, 4});
  EXPECT_THROW(refine(beyond, {}), std::invalid_argument);
  Outline huge = square();
  huge.points.positions[0].x = std::numeric_limits<double>::infinity();
  EXPECT_THROW(refine(huge, {}), std::invalid_argument);
  Outline tiny = square();
  for (glm::dvec3& p : tiny.points.positions) p *= 1e-90;
  EXPECT_THROW(refine(tiny, {.max_points = 1000}), std::invalid_argument);
  Outline nowhere = square();
  nowhere.holes = {{0.5, std::numeric_limits<double>::quiet_NaN()}};
  EXPECT_THROW(refine(nowhere, {}), std::invalid_argument);
}

TEST(Refine, EndsWhenAskedTo) {
  parallel::Progress progress;
  progress.request_stop();
  EXPECT_THROW(refine(square(), {.max_area = 1e-5, .progress = &progress}), parallel::Interrupted);
}

}  // namespace
}  // namespace delray::delaunay
