// Looks of variants on pages: different within a family, and the same whatever is compared.
#include "apps/compare/variant_looks.h"

#include <gtest/gtest.h>

#include <set>
#include <tuple>

#include "composite/scheme.h"
#include "delaunay/methods.h"
#include "loadbalance/partition.h"
#include "loadbalance/schedule.h"
#include "raster/strategies.h"

namespace delray::apps {
namespace {

template <class Table>
void check_family(Family family, const Table& table) {
  std::set<std::pair<int, int>> looks;
  for (const auto& entry : table) {
    const report::Look look = look_of(family, entry.name);
    EXPECT_GE(look.colour, 0) << entry.name;
    EXPECT_LT(look.colour, report::kLookColours) << entry.name;
    EXPECT_LT(look.mark, report::kLookMarks) << entry.name;
    EXPECT_EQ(look.dash, 0) << entry.name;
    EXPECT_FALSE(look.group.empty()) << entry.name;
    EXPECT_TRUE(looks.insert({look.colour, look.mark}).second) << entry.name;
  }
}

TEST(VariantLooks, DifferWithinEveryFamily) {
  check_family(Family::scheme, composite::schemes());
  check_family(Family::partition, loadbalance::partitioners());
  check_family(Family::schedule, loadbalance::schedules());
  check_family(Family::strategy, raster::strategies());
  check_family(Family::method, delaunay::methods());
}

TEST(VariantLooks, OfParametersAreThoseOfTheVariantButForDashes) {
  const report::Look plain = look_of(Family::scheme, "radix-k");
  const report::Look given = look_of(Family::scheme, "radix-k:4,2");
  EXPECT_EQ(std::tie(given.colour, given.mark, given.group),
            std::tie(plain.colour, plain.mark, plain.group));
  EXPECT_NE(given.dash, 0);
  // An entry with a colon is one of its own.
  EXPECT_EQ(look_of(Family::scheme, "binary-swap:234").dash, 0);
  EXPECT_NE(look_of(Family::scheme, "binary-swap:234").mark,
            look_of(Family::scheme, "binary-swap").mark);
  EXPECT_EQ(look_of(Family::scheme, "binary").colour, -1);
  const report::Look dag = look_of(Family::method, "optimistic, dag");
  EXPECT_EQ(dag.mark, look_of(Family::method, "optimistic").mark);
  EXPECT_NE(dag.dash, look_of(Family::method, "optimistic").dash);
  EXPECT_NE(dag.dash, look_of(Family::method, "optimistic, slabs").dash);
}

}  // namespace
}  // namespace delray::apps
