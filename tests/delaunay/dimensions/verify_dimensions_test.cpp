// The verifier of any dimension: beside that of the plane and of space, and against changed meshes.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

#include "delaunay/dimensions.h"
#include "delaunay/dimensions/determinants.h"
#include "tests/delaunay/same_simplices.h"

namespace delray::delaunay {
namespace {

using internal::PlaceNd;

template <int D>
PointView<double> seen_as(const std::vector<PlaceNd<D>>& points) {
  return {reinterpret_cast<const std::byte*>(points.data()), points.size(), sizeof(PlaceNd<D>)};
}

// Meshes with something wrong about them, or nothing.
std::vector<Triangulation> changed(const Triangulation& good, std::size_t points,
                                   std::mt19937_64& random) {
  const std::size_t corners = static_cast<std::size_t>(good.dim) + 1;
  const auto simplex = [&](Triangulation& mesh, std::size_t t) {
    return mesh.vertices.begin() + static_cast<std::ptrdiff_t>(t * corners);
  };
  std::vector<Triangulation> result = {good};
  const std::size_t t = random() % good.size(), other = random() % good.size();
  Triangulation bad = good;
  bad.vertices.erase(simplex(bad, t), simplex(bad, t + 1));
  result.push_back(bad);
  bad = good;
  bad.vertices.insert(bad.vertices.end(), good.vertices.begin(),
                      good.vertices.begin() + static_cast<std::ptrdiff_t>(corners));
  result.push_back(bad);
  bad = good;
  std::swap(bad.vertices[t * corners], bad.vertices[t * corners + 1]);
  result.push_back(bad);
  bad = good;
  bad.vertices[t * corners] = bad.vertices[other * corners + random() % corners];
  result.push_back(bad);
  bad.vertices[t * corners] = static_cast<std::uint32_t>(points);
  result.push_back(bad);
  bad.vertices.clear();
  result.push_back(bad);
  return result;
}

template <int D>
void expect_other_verifiers_verdict() {
  std::uint64_t seed = 0;
  int refused = 0;
  for (const auto& kind : hard_points_of<D>()) {
    std::mt19937_64 random(++seed);
    const auto points = kind.make(30, seed);
    Triangulation mesh = expected_of(points, D);
    if (mesh.size() == 0) continue;
    for (const Triangulation& each : changed(mesh, points.size(), random)) {
      const Verdict expected = verify_simplices(D, view(points), each.vertices);
      const Verdict actual = verify_dimensions(view(points), D, each.vertices);
      const std::string name = kind.name + ": " + expected.reason + "; " + actual.reason;
      EXPECT_EQ(actual.valid, expected.valid) << name;
      EXPECT_EQ(actual.delaunay, expected.delaunay) << name;
      EXPECT_EQ(actual.canonical, expected.canonical) << name;
      EXPECT_EQ(actual.reason.empty(), expected.reason.empty()) << name;
      refused += actual.valid ? 0 : 1;
    }
    // Another triangulation: of the points in other places.
    auto stretched = points;
    for (auto& p : stretched) p.y *= 4;
    if (std::ranges::any_of(stretched, [](const auto& p) { return !std::isfinite(p.y); })) continue;
    const Triangulation other = expected_of(stretched, D);
    const Verdict expected = verify_simplices(D, view(points), other.vertices);
    const Verdict actual = verify_dimensions(view(points), D, other.vertices);
    EXPECT_EQ(actual.valid, expected.valid) << kind.name << actual.reason;
    EXPECT_EQ(actual.delaunay, expected.delaunay) << kind.name << actual.reason;
    EXPECT_EQ(actual.canonical, expected.canonical) << kind.name << actual.reason;
  }
  EXPECT_GT(refused, 30);
}

TEST(VerifyDimensions, SaysWhatTheVerifierOfThePlaneSays) { expect_other_verifiers_verdict<2>(); }
TEST(VerifyDimensions, SaysWhatTheVerifierOfSpaceSays) { expect_other_verifiers_verdict<3>(); }

template <int D>
void expect_changes_are_seen(std::size_t n, int sets) {
  std::mt19937_64 random(D);
  for (int i = 0; i < sets; ++i) {
    std::vector<PlaceNd<D>> points(n);
    for (auto& p : points) {
      for (double& x : p) {
        x = i % 2 == 0 ? std::uniform_real_distribution<>(-1, 1)(random)
                       : static_cast<double>(random() % 3);
      }
    }
    const Triangulation good = triangulate_dimensions(seen_as<D>(points), D);
    if (good.size() == 0) continue;
    const auto meshes = changed(good, points.size(), random);
    for (std::size_t k = 0; k < meshes.size(); ++k) {
      const Verdict verdict = verify_dimensions(seen_as<D>(points), D, meshes[k].vertices);
      const bool is_same = hash(meshes[k]) == hash(good) && k != 3;
      EXPECT_EQ(verdict.canonical, is_same) << D << "D, change " << k << ": " << verdict.reason;
      EXPECT_EQ(verdict.valid, is_same) << D << "D, change " << k << ": " << verdict.reason;
    }
    // Delaunay in other places is valid and not Delaunay here.
    auto stretched = points;
    for (auto& p : stretched) p[1] *= 8;
    const Triangulation other = triangulate_dimensions(seen_as<D>(stretched), D);
    const Verdict verdict = verify_dimensions(seen_as<D>(points), D, other.vertices);
    EXPECT_TRUE(verdict.valid) << D << "D: " << verdict.reason;
    EXPECT_EQ(verdict.canonical, hash(other) == hash(good)) << D << "D: " << verdict.reason;
  }
}

TEST(VerifyDimensions, SeeChangesInFour) { expect_changes_are_seen<4>(25, 20); }
TEST(VerifyDimensions, SeeChangesInFive) { expect_changes_are_seen<5>(18, 8); }
TEST(VerifyDimensions, SeeChangesInSix) { expect_changes_are_seen<6>(14, 4); }

// Two simplices side by side, and a dent where a third would be.
TEST(VerifyDimensions, SeeADent) {
  const std::vector<PlaceNd<4>> points = {{0, 0, 0, 0}, {1, 0, 0, 0}, {0, 1, 0, 0},
                                          {0, 0, 1, 0}, {0, 0, 0, 1}, {2, 2, 2, 2}};
  Triangulation mesh = triangulate_dimensions(seen_as<4>(points), 4);
  ASSERT_TRUE(verify_dimensions(seen_as<4>(points), 4, mesh.vertices).canonical);
  ASSERT_EQ(mesh.size(), 2U);
  const std::vector<PlaceNd<4>> dented = {{0, 0, 0, 0}, {1, 0, 0, 0}, {0, 1, 0, 0},
                                          {0, 0, 1, 0}, {0, 0, 0, 1}, {-.2, .6, .6, .6}};
  const Verdict verdict = verify_dimensions(seen_as<4>(dented), 4, mesh.vertices);
  EXPECT_FALSE(verdict.valid);
  EXPECT_NE(verdict.reason.find("not convex"), std::string::npos) << verdict.reason;
}

TEST(VerifyDimensions, RefuseWhatCannotBe) {
  const std::vector<PlaceNd<4>> points(3);
  const std::vector<std::uint32_t> four = {0, 1, 2, 0};
  EXPECT_THROW(verify_dimensions(seen_as<4>(points), 4, four), std::invalid_argument);
  EXPECT_THROW(verify_dimensions(seen_as<4>(points), 7, {}), std::invalid_argument);
  EXPECT_TRUE(verify_dimensions(seen_as<4>(points), 4, {}).valid);
}

}  // namespace
}  // namespace delray::delaunay
