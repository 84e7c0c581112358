// Some simplices of the Delaunay triangulation are a part of it; others are not.
#include <gtest/gtest.h>

#include "delaunay/triangulate.h"
#include "delaunay/verify.h"
#include "tests/delaunay/hard_points.h"

namespace delray::delaunay {
namespace {

TEST(VerifyPart, TakesAnySimplicesOfTheTriangulationAndNoOthers) {
  std::uint64_t seed = 0;
  for (const HardPoints& kind : hard_points()) {
    const auto points = kind.make(80, ++seed);
    const Triangulation whole = triangulate(view(points)).triangulation;
    std::vector<std::uint32_t> part;
    for (std::size_t t = 0; t < whole.size(); t += 3) {
      // In any order and orientation.
      for (const std::size_t k : {2, 1, 0}) part.push_back(whole.vertices[3 * t + k]);
    }
    EXPECT_TRUE(verify_part(2, view(points), part).canonical) << kind.name << ", seed " << seed;
    if (part.empty()) continue;
    std::vector<std::uint32_t> twice = part;
    twice.insert(twice.end(), {part[1], part[2], part[0]});
    const Verdict verdict = verify_part(2, view(points), twice);
    EXPECT_FALSE(verdict.valid) << kind.name;
    EXPECT_NE(verdict.reason.find("twice"), std::string::npos) << verdict.reason;
  }
}

TEST(VerifyPart, NamesTheFirstThatIsNone) {
  const std::vector<glm::dvec2> points = {{0, 0}, {4, 0}, {0, 4}, {5, 5}, {1, 1}};
  const std::vector<std::uint32_t> wrong = {0, 1, 4, 0, 1, 2, 3, 1, 2};
  const Verdict verdict = verify_part(2, view(points), wrong);
  EXPECT_FALSE(verdict.valid || verdict.delaunay || verdict.canonical);
  EXPECT_EQ(verdict.simplex, 1U);
  EXPECT_TRUE(verify_part(2, view(points), {}).canonical);
  EXPECT_THROW(verify_part(2, view(points), std::vector<std::uint32_t>{0, 1, 5}),
               std::invalid_argument);
}

}  // namespace
}  // namespace delray::delaunay
