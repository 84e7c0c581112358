// The verifier against triangulations made by brute force, right and wrong, in 2D and 3D.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "delaunay/generate.h"
#include "delaunay/verify.h"
#include "tests/delaunay/brute_force.h"

namespace delray::delaunay {
namespace {

using Simplices = std::vector<std::uint32_t>;

template <int D>
struct Sample {
  std::vector<Point<D>> points;
  Simplices simplices;  // canonical, positively oriented

  Simplex<D> corners(const std::uint32_t* v) const {
    Simplex<D> result;
    for (int k = 0; k <= D; ++k) result[k] = points[v[k]];
    return result;
  }
  Verdict verify(const Simplices& mutant) const {
    return verify_simplices(D, view(points), mutant);
  }
  Verdict verify() const { return verify(simplices); }
};

template <int D>
Sample<D> sample_of(std::vector<Point<D>> points) {
  Sample<D> sample{std::move(points), {}};
  for (auto rows : brute_force<D>(sample.points)) {
    if (orient(sample.corners(rows.data())) < 0) std::swap(rows[0], rows[1]);
    sample.simplices.insert(sample.simplices.end(), rows.begin(), rows.end());
  }
  return sample;
}

// Uniform, on small lattices (with duplicates), on a lattice of tenths, and generated kinds.
template <int D>
std::vector<Sample<D>> samples(std::size_t count, std::size_t n) {
  std::mt19937_64 random(20);
  const char* kinds[] = {"arc", "sphere", "ulp", "cocircular", "jitter", "parabola", "far"};
  std::vector<Sample<D>> result;
  for (std::size_t s = 0; result.size() < count; ++s) {
    std::vector<Point<D>> points(n);
    if (s % 5 == 4) {
      const auto cloud = generate_points(kinds[s / 5 % std::size(kinds)], n, D, s);
      for (std::size_t i = 0; i < n; ++i) points[i] = Point<D>(cloud.positions[i]);
    } else {
      const double step = s % 5 == 1 ? 1 : s % 5 == 2 ? 0.1 : 0;
      for (auto& p : points) {
        for (int k = 0; k < D; ++k) {
          p[k] = step > 0 ? step * static_cast<double>(random() % (D == 2 ? 6 : 4))
                          : std::uniform_real_distribution<>(0, 1)(random);
        }
      }
    }
    Sample<D> sample = sample_of<D>(std::move(points));
    if (sample.simplices.size() > D + 1) result.push_back(std::move(sample));
  }
  return result;
}

template <int D>
void expect_accepted() {
  for (const auto& sample : samples<D>(100, D == 2 ? 20 : 16)) {
    const Verdict verdict = sample.verify();
    EXPECT_TRUE(verdict.canonical) << verdict.reason;
    EXPECT_TRUE(verdict.reason.empty());
    EXPECT_FALSE(verdict.simplex.has_value());
  }
}
TEST(VerifyMutations, AcceptsBruteForce2d) { expect_accepted<2>(); }
TEST(VerifyMutations, AcceptsBruteForce3d) { expect_accepted<3>(); }

// 1000 mutants of a kind, none of which may be valid.
template <int D, class Mutate>
void expect_invalid(Mutate&& mutate) {
  constexpr std::size_t kCorners = D + 1;
  std::mt19937_64 random(7);
  std::size_t tried = 0, found = 0;
  for (const auto& sample : samples<D>(40, D == 2 ? 24 : 18)) {
    for (int round = 0; round < 25; ++round) {
      Simplices mutant = sample.simplices;
      while (!mutate(sample, mutant, random() % (mutant.size() / kCorners), random)) {
        mutant = sample.simplices;
      }
      const Verdict verdict = sample.verify(mutant);
      ++tried;
      found += !verdict.valid && !verdict.reason.empty() ? 1 : 0;
    }
  }
  EXPECT_EQ(tried, 1000U);
  EXPECT_EQ(found, tried);
}

template <int D>
void expect_missing_found() {
  expect_invalid<D>([](const Sample<D>&, Simplices& mutant, std::size_t t, auto&) {
    const auto first = mutant.begin() + static_cast<long>(t * (D + 1));
    mutant.erase(first, first + D + 1);
    return true;
  });
}
TEST(VerifyMutations, FindsMissing2d) { expect_missing_found<2>(); }
TEST(VerifyMutations, FindsMissing3d) { expect_missing_found<3>(); }

template <int D>
void expect_doubled_found() {
  expect_invalid<D>([](const Sample<D>& sample, Simplices& mutant, std::size_t t, auto& random) {
    std::array<std::uint32_t, D + 1> copy;
    std::copy_n(sample.simplices.begin() + static_cast<long>(t * (D + 1)), D + 1, copy.begin());
    // An even permutation is the same simplex.
    for (auto turns = random() % 3; turns > 0; --turns) {
      std::rotate(copy.begin(), copy.begin() + 1, copy.begin() + 3);
    }
    mutant.insert(mutant.end(), copy.begin(), copy.end());
    return true;
  });
}
TEST(VerifyMutations, FindsDoubled2d) { expect_doubled_found<2>(); }
TEST(VerifyMutations, FindsDoubled3d) { expect_doubled_found<3>(); }

// Two vertices of a simplex, or of two simplices, exchanged.
template <int D>
void expect_swapped_found() {
  expect_invalid<D>([](const Sample<D>& sample, Simplices& mutant, std::size_t t, auto& random) {
    const std::size_t s = random() % 2 == 0 ? t : random() % (mutant.size() / (D + 1));
    const std::size_t i = t * (D + 1) + random() % (D + 1), j = s * (D + 1) + random() % (D + 1);
    if (sample.points[mutant[i]] == sample.points[mutant[j]]) return false;
    std::swap(mutant[i], mutant[j]);
    return true;
  });
}
TEST(VerifyMutations, FindsSwapped2d) { expect_swapped_found<2>(); }
TEST(VerifyMutations, FindsSwapped3d) { expect_swapped_found<3>(); }

template <int D>
void expect_replaced_found() {
  expect_invalid<D>([](const Sample<D>& sample, Simplices& mutant, std::size_t t, auto& random) {
    std::uint32_t& vertex = mutant[t * (D + 1) + random() % (D + 1)];
    const auto other = static_cast<std::uint32_t>(random() % sample.points.size());
    if (sample.points[vertex] == sample.points[other]) return false;
    vertex = other;
    return true;
  });
}
TEST(VerifyMutations, FindsReplaced2d) { expect_replaced_found<2>(); }
TEST(VerifyMutations, FindsReplaced3d) { expect_replaced_found<3>(); }

// Facet i of simplex t and the vertex q beyond it: D simplices take the place of two, which turn
// about the edge from the vertex opposite to the facet to q.
template <int D>
struct Diamond {
  std::size_t t, s;
  std::uint32_t q;
};

template <int D>
std::vector<Diamond<D>> diamonds(const Simplices& simplices) {
  constexpr std::size_t kCorners = D + 1;
  std::vector<Diamond<D>> result;
  const std::size_t n = simplices.size() / kCorners;
  const auto has = [&](std::size_t t, std::uint32_t vertex) {
    const auto* first = simplices.data() + t * kCorners;
    return std::find(first, first + kCorners, vertex) != first + kCorners;
  };
  for (std::size_t t = 0; t < n; ++t) {
    for (std::size_t s = 0; s < n; ++s) {
      std::uint32_t q = 0;
      std::size_t own = 0;
      for (std::size_t k = 0; k < kCorners; ++k) {
        if (has(t, simplices[s * kCorners + k])) continue;
        q = simplices[s * kCorners + k];
        ++own;
      }
      if (s != t && own == 1) result.push_back({t, s, q});
    }
  }
  return result;
}

template <int D>
void expect_flips_found() {
  constexpr std::size_t kCorners = D + 1;
  std::mt19937_64 random(31);
  std::size_t tried = 0, found = 0, valid = 0, ties = 0;
  for (const auto& sample : samples<D>(40, D == 2 ? 24 : 18)) {
    const auto inner = diamonds<D>(sample.simplices);
    ASSERT_FALSE(inner.empty());
    for (int round = 0; round < 25; ++round) {
      const Diamond<D>& d = inner[random() % inner.size()];
      const std::uint32_t* t = sample.simplices.data() + d.t * kCorners;
      const std::uint32_t* s = sample.simplices.data() + d.s * kCorners;
      Simplices mutant;
      bool convex = true;
      for (std::size_t k = 0; k < kCorners; ++k) {
        if (std::find(s, s + kCorners, t[k]) == s + kCorners) continue;  // not of the facet
        std::array<std::uint32_t, kCorners> made;
        std::copy_n(t, kCorners, made.begin());
        made[k] = d.q;
        convex &= orient(sample.corners(made.data())) > 0;
        mutant.insert(mutant.end(), made.begin(), made.end());
      }
      for (std::size_t i = 0; i < sample.simplices.size() / kCorners; ++i) {
        if (i == d.t || i == d.s) continue;
        const std::uint32_t* v = sample.simplices.data() + i * kCorners;
        mutant.insert(mutant.end(), v, v + kCorners);
      }
      const bool tie = in_sphere(sample.corners(t), sample.points[d.q]) == 0;
      const Verdict verdict = sample.verify(mutant);
      ++tried;
      found += !verdict.canonical && !verdict.reason.empty() ? 1 : 0;
      EXPECT_EQ(verdict.valid, convex) << verdict.reason;
      if (!convex) continue;
      ++valid;
      ties += tie ? 1 : 0;
      if (!tie) {
        EXPECT_FALSE(verdict.delaunay);
      } else if (D == 2) {
        EXPECT_TRUE(verdict.delaunay);
      }
    }
  }
  EXPECT_EQ(tried, 1000U);
  EXPECT_EQ(found, tried);
  EXPECT_GT(valid, 200U);
  EXPECT_GT(ties, D == 2 ? 20U : 5U);
}
TEST(VerifyMutations, FindsWrongFlips2d) { expect_flips_found<2>(); }
TEST(VerifyMutations, FindsWrongFlips3d) { expect_flips_found<3>(); }

TEST(VerifyMutations, AcceptsNoTetrahedraInAPlaneOnly) {
  std::vector<glm::dvec3> points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 1}, {1, 1, 1}, {0, 1, 1}};
  EXPECT_TRUE(verify_simplices(3, view(points), {}).canonical);
  points.emplace_back(1, 1, 2);
  EXPECT_FALSE(verify_simplices(3, view(points), {}).valid);
  EXPECT_TRUE(verify_simplices(3, view(std::vector<glm::dvec3>{}), {}).canonical);
}

// Tetrahedra around an edge that is passed twice: every face and every edge of the boundary is
// convex, and every place inside is covered twice.
TEST(VerifyMutations, RefusesTwoTurnsAboutAnEdge) {
  std::vector<glm::dvec3> points = {{0, 0, -9}, {0, 0, 9},   {10, 0, 0}, {3, 9, 0},
                                    {-8, 6, 0}, {-8, -6, 0}, {3, -9, 0}};
  const auto ring = [](std::uint32_t step) {
    Simplices result;
    for (std::uint32_t i = 0; i < 5; ++i) {
      for (const std::uint32_t v : {2 + step * i % 5, 2 + step * (i + 1) % 5, 1U, 0U}) {
        result.push_back(v);
      }
    }
    return result;
  };
  Simplices once = ring(1), twice = ring(2);
  if (orient3d(points[once[0]], points[once[1]], points[once[2]], points[once[3]]) < 0) {
    for (std::size_t i = 0; i < once.size(); i += 4) {
      std::swap(once[i], once[i + 1]);
      std::swap(twice[i], twice[i + 1]);
    }
  }
  EXPECT_TRUE(verify_simplices(3, view(points), once).valid);
  EXPECT_FALSE(verify_simplices(3, view(points), twice).valid);
  // Two bodies beside each other.
  Simplices both = once;
  const auto n = static_cast<std::uint32_t>(points.size());
  for (std::uint32_t i = 0; i < n; ++i) points.push_back(points[i] + glm::dvec3(100, 1, 2));
  for (const std::uint32_t v : once) both.push_back(v + n);
  EXPECT_FALSE(verify_simplices(3, view(points), both).valid);
}

}  // namespace
}  // namespace delray::delaunay
