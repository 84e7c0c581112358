// Edit distances, and the name that was probably meant.
#include "files/similar_name.h"

#include <gtest/gtest.h>

#include <vector>

namespace delray::files {
namespace {

TEST(EditDistance, CountsInsertionsDeletionsSubstitutionsAndExchanges) {
  EXPECT_EQ(edit_distance("", ""), 0U);
  EXPECT_EQ(edit_distance("", "abc"), 3U);
  EXPECT_EQ(edit_distance("abc", ""), 3U);
  EXPECT_EQ(edit_distance("render", "render"), 0U);
  EXPECT_EQ(edit_distance("rendr", "render"), 1U);
  EXPECT_EQ(edit_distance("rendeer", "render"), 1U);
  EXPECT_EQ(edit_distance("rander", "render"), 1U);
  EXPECT_EQ(edit_distance("redner", "render"), 1U);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);
  EXPECT_EQ(edit_distance("ca", "abc"), 3U) << "no character is changed twice";
}

TEST(EditDistance, IsSymmetric) {
  const std::vector<std::string> names = {"", "a", "ab", "ba", "abc", "acb", "mahd", "hadm"};
  for (const std::string& a : names)
    for (const std::string& b : names) EXPECT_EQ(edit_distance(a, b), edit_distance(b, a));
}

TEST(SimilarName, FindsWhatWasMeant) {
  const std::vector<std::string> names = {"info",   "generate", "triangulate",
                                          "render", "compose",  "compare"};
  EXPECT_EQ(similar_name("rendr", names), "render");
  EXPECT_EQ(similar_name("triagnulate", names), "triangulate");
  EXPECT_EQ(similar_name("ifno", names), "info");
  EXPECT_EQ(similar_name("comprae", names), "compare");
  EXPECT_EQ(similar_name("tri", names), "triangulate") << "the beginning of a name";
  EXPECT_EQ(similar_name("com", names), "") << "the beginning of two names";
  EXPECT_EQ(similar_name("bake", names), "");
  EXPECT_EQ(similar_name("", names), "");
  EXPECT_EQ(similar_name(std::string(100'000, 'r'), names), "");
  EXPECT_EQ(similar_name("render", {}), "");
}

TEST(SimilarName, IsNoOtherNameOfAsManyCharacters) {
  const std::vector<std::string> names = {"a", "xy"};
  EXPECT_EQ(similar_name("b", names), "");
  EXPECT_EQ(similar_name("ab", names), "");
}

TEST(DidYouMean, IsASentenceOrNothing) {
  const std::vector<std::string> names = {"mahd", "mahd-h"};
  EXPECT_EQ(did_you_mean("mhad", names), "; did you mean 'mahd'?");
  EXPECT_EQ(did_you_mean("nonsense", names), "");
}

}  // namespace
}  // namespace delray::files
