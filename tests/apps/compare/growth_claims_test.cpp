#include "apps/compare/compose/growth_claims.h"

#include <gtest/gtest.h>

#include "composite/scheme.h"

namespace delray::apps {
namespace {

ComparedScheme counted(const std::string& scheme, int ranks, std::uint64_t bytes) {
  ComparedScheme row;
  row.scheme = scheme;
  row.codec = "active";
  row.ranks = ranks;
  row.counts.bytes_total = row.counts.bytes_received_max = bytes;
  return row;
}

// The claim about all bytes of a scheme.
GrowthLaw found_for(std::vector<ComparedScheme> rows) {
  const std::vector<JudgedGrowth> judged = judge_growth(rows);
  EXPECT_EQ(judged.size(), 1U);
  return judged.empty() ? GrowthLaw::least_of_all : judged[0].found;
}

TEST(GrowthClaims, TheNearestGrowthIsFound) {
  EXPECT_EQ(found_for({counted("tree", 64, 1000), counted("tree", 1024, 1100)}),
            GrowthLaw::constant);
  EXPECT_EQ(found_for({counted("tree", 64, 600), counted("tree", 1024, 1000)}),
            GrowthLaw::logarithmic);
  EXPECT_EQ(found_for({counted("tree", 64, 63), counted("tree", 1024, 1023)}), GrowthLaw::linear);
  EXPECT_EQ(found_for({counted("tree", 64, 1600), counted("tree", 1024, 90)}),
            GrowthLaw::hyperbolic);
}

TEST(GrowthClaims, ARightOneIsToldFromAWrongOne) {
  std::vector<ComparedScheme> rows = {counted("bus", 4, 160), counted("bus", 64, 10),
                                      counted("pipeline", 4, 40), counted("pipeline", 64, 40)};
  std::vector<JudgedGrowth> judged = judge_growth(rows);
  ASSERT_EQ(judged.size(), 3U);
  EXPECT_FALSE(judged[0].is_right());  // pipeline: linear, they say
  EXPECT_TRUE(judged[1].is_right());
  EXPECT_TRUE(judged[2].is_right());  // nobody has less
  rows.push_back(counted("direct-send", 64, 9));
  EXPECT_FALSE(judge_growth(rows)[2].is_right());
  EXPECT_EQ(growth_claims_json(judged).size(), 3U);
  EXPECT_NE(growth_claims_tab(judged).find("wrong"), std::string::npos);
}

// Other numbers of ranks than powers of two take more rounds, and few of them tell nothing.
TEST(GrowthClaims, NothingIsSaidOfTooFewRanks) {
  EXPECT_TRUE(judge_growth({counted("tree", 1, 1), counted("tree", 2, 2)}).empty());
  EXPECT_TRUE(judge_growth({counted("tree", 3, 1), counted("tree", 48, 2)}).empty());
  EXPECT_TRUE(growth_claims_tab({}).empty());
}

TEST(GrowthClaims, EverySchemeOfTheReportIsInTheTable) {
  for (const GrowthClaim& claim : growth_claims())
    EXPECT_NE(composite::find_scheme(claim.scheme), nullptr) << claim.scheme;
}

}  // namespace
}  // namespace delray::apps
