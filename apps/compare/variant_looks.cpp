// The looks of variants, from the tables of their families.
#include "apps/compare/variant_looks.h"

#include <algorithm>
#include <string>
#include <vector>

#include "composite/scheme.h"
#include "delaunay/distributed.h"
#include "delaunay/methods.h"
#include "loadbalance/partition.h"
#include "loadbalance/schedule.h"
#include "raster/strategies.h"

namespace delray::apps {
namespace {

bool names(std::string_view entry, std::string_view variant) {
  return variant.starts_with(entry) &&
         (variant.size() == entry.size() || variant[entry.size()] == ':' ||
          variant[entry.size()] == ',');
}

// A colour for each group, or for each entry of a table that has none; a mark for each entry of a
// group.
template <class Table>
report::Look look_in(const Table& table, std::string_view variant) {
  report::Look look;
  std::vector<std::string> groups;
  std::vector<int> members;
  std::size_t longest = 0;
  for (const auto& entry : table) {
    const std::string_view name = entry.name;
    std::string group(name);
    if constexpr (requires { entry.group; }) group = entry.group;
    auto at = std::find(groups.begin(), groups.end(), group) - groups.begin();
    if (at == std::ssize(groups)) {
      groups.push_back(group);
      members.push_back(0);
    }
    const int mark = members[static_cast<std::size_t>(at)]++;
    if (!names(name, variant) || name.size() <= longest) continue;
    longest = name.size();
    look = {static_cast<int>(at), mark, name.size() < variant.size() ? 1 : 0, group};
  }
  return look;
}

// The ways to run a method differ by their dashes, by place in the tables of what goes with it.
int dash_of_way(std::string_view variant) {
  int dash = 0, place = 0;
  for (const auto& choices :
       {delaunay::locations(), delaunay::splits(), delaunay::deadlock_strategies(),
        delaunay::lock_kinds(), delaunay::unlock_times()}) {
    for (const delaunay::Choice& choice : choices) {
      ++place;
      if (variant.find(", " + std::string(choice.name)) != std::string_view::npos) dash = place;
    }
  }
  return dash;
}

}  // namespace

report::Look look_of(Family family, std::string_view name) {
  switch (family) {
    case Family::scheme:
      return look_in(composite::schemes(), name);
    case Family::partition:
      return look_in(loadbalance::partitioners(), name);
    case Family::schedule:
      return look_in(loadbalance::schedules(), name);
    case Family::strategy:
      return look_in(raster::strategies(), name);
    case Family::method: {
      report::Look look = look_in(delaunay::methods(), name);
      look.dash = dash_of_way(name);
      return look;
    }
    case Family::distributed:
      return look_in(delaunay::distributed_methods(), name);
  }
  return {};
}

}  // namespace delray::apps
