// The table of methods: resolution of "auto", and refusals.
#include "delaunay/methods.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <stdexcept>
#include <string>

namespace delray::delaunay {
namespace {

std::string refusal(const Options& options) {
  try {
    resolve(options);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Methods, NamesAreUniqueAndWhatMethodsAllowExists) {
  const auto exists = [](std::span<const Choice> table, std::string_view name) {
    return std::ranges::find(table, name, &Choice::name) != table.end();
  };
  std::set<std::string_view> names;
  for (const Method& method : methods()) {
    EXPECT_TRUE(names.insert(method.name).second) << method.name;
    EXPECT_NE(method.name, "auto");
    EXPECT_FALSE(method.description.empty());
    for (const auto name : method.locations) EXPECT_TRUE(exists(locations(), name)) << name;
    for (const auto name : method.splits) EXPECT_TRUE(exists(splits(), name)) << name;
    for (const auto name : method.orders) EXPECT_TRUE(exists(orders(), name)) << name;
  }
}

TEST(Methods, AutoBecomesTheFirstThatGoesWithTheRest) {
  const Options plain = resolve({});
  EXPECT_EQ(plain.method, "divide-and-conquer");
  EXPECT_EQ(plain.order, "none");
  EXPECT_EQ(plain.location, "none");
  Options options;
  options.method = "insertion";
  const Options insertion = resolve(options);
  EXPECT_EQ(insertion.order, "brio");
  EXPECT_EQ(insertion.location, "walk");
  EXPECT_EQ(method_of(insertion).name, "insertion");
}

TEST(Methods, ResolvingTwiceChangesNothing) {
  for (const Method& method : methods()) {
    Options options;
    options.dim = method.dims.front();
    options.method = method.name;
    const Options once = resolve(options), twice = resolve(once);
    EXPECT_EQ(once.location, twice.location);
    EXPECT_EQ(once.split, twice.split);
    EXPECT_EQ(once.order, twice.order);
  }
}

TEST(Methods, RefusalsNameWhatIsLegal) {
  Options options;
  options.method = "magic";
  EXPECT_NE(refusal(options).find("divide-and-conquer"), std::string::npos) << refusal(options);
  options.method = "insertion";
  options.order = "alphabetic";
  EXPECT_NE(refusal(options).find("brio, hilbert, random"), std::string::npos) << refusal(options);
  options.dim = 3;
  options.order = "auto";
  options.location = "hierarchy";
  EXPECT_NE(refusal(options).find("it has: walk, dag"), std::string::npos) << refusal(options);
  options.dim = 2;
  EXPECT_EQ(refusal(options), "accepted");
  options.location = "auto";
  options.method = "divide-and-conquer";
  options.order = "brio";
  EXPECT_NE(refusal(options).find("no choice of order"), std::string::npos) << refusal(options);
  options = {};
  options.dim = 4;
  EXPECT_NE(refusal(options).find("2 or 3, not 4"), std::string::npos) << refusal(options);
}

}  // namespace
}  // namespace delray::delaunay
