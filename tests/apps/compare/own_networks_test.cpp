#include "apps/compare/compose/own_networks.h"

#include <gtest/gtest.h>

#include "comm/network.h"
#include "composite/scheme.h"

namespace delray::apps {
namespace {

ComparedScheme row(const std::string& scheme, const std::vector<Predicted>& predicted) {
  ComparedScheme result;
  result.scheme = scheme;
  result.codec = "active";
  result.ranks = 64;
  result.predicted = predicted;
  return result;
}

TEST(OwnNetworks, TheReportIsRightWhereNoOtherNetworkIsFaster) {
  std::vector<comm::NamedNetwork> networks;
  for (const char* name : {"ring", "grid", "fat-tree", "10-gigabit-ethernet"})
    networks.push_back(*comm::find_network(name));
  const std::vector<ComparedScheme> rows = {
      row("pipeline", {{"ring", 1.04, 0}, {"grid", 1, 0}, {"fat-tree", 0.1, 0}}),
      row("mesh", {{"ring", 1, 0}, {"grid", 2, 0}}),
      row("tree", {{"ring", 0.5, 0}, {"grid", 0.5, 0}}),
  };
  const std::vector<OnOwnNetwork> found = on_own_networks(rows, networks);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_TRUE(found[0].own_is_best());  // within 5 %; the fat tree does not count
  EXPECT_EQ(found[0].best_network, "grid");
  EXPECT_FALSE(found[0].is_fastest_there());
  EXPECT_EQ(found[0].fastest_scheme, "tree");
  EXPECT_FALSE(found[1].own_is_best());
  EXPECT_EQ(found[1].best_network, "ring");
  EXPECT_EQ(own_networks_json(found).size(), 2U);
  EXPECT_NE(own_networks_tab(found).find("wrong"), std::string::npos);
  // Other links, or no other network: nothing to compare with.
  EXPECT_TRUE(on_own_networks(rows, {networks.data(), 1}).empty());
}

TEST(OwnNetworks, EverySchemeOfTheReportIsInTheTable) {
  for (const SuitedScheme& suited : suited_schemes()) {
    EXPECT_NE(composite::find_scheme(suited.scheme), nullptr) << suited.scheme;
    EXPECT_NE(comm::find_network(comm::kind_of(suited.shape).name), nullptr) << suited.scheme;
  }
}

}  // namespace
}  // namespace delray::apps
