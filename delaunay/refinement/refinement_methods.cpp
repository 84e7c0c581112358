// The table of refinements.
#include <array>
#include <stdexcept>
#include <string>

#include "delaunay/refine.h"
#include "delaunay/refinement/refinement_runs.h"

namespace delray::delaunay {
namespace {

using internal::Measure;

struct Row {
  RefinementMethod method;
  internal::RefinementWay way;
};

constexpr std::array kRows = {
    Row{{"ruppert", "one thread, the worst triangle first (Ruppert 1995)"},
        {&internal::refine_alone, Measure::area}},
    Row{{"chew",
         "one thread, triangles of one size by their circles, the largest first (Chew 1989)"},
        {&internal::refine_alone, Measure::circle}},
    Row{{"okusanya",
         "threads or ranks that lock the triangles of a cavity, or are denied (Okusanya and "
         "Peraire "
         "1996)",
         true, true},
        {&internal::refine_with_locks, Measure::area, &internal::refine_over_ranks}},
};

constexpr auto kMethods = [] {
  std::array<RefinementMethod, kRows.size()> methods;
  for (std::size_t i = 0; i < kRows.size(); ++i) methods[i] = kRows[i].method;
  return methods;
}();

}  // namespace

std::span<const RefinementMethod> refinement_methods() { return kMethods; }

internal::RefinementWay internal::refinement_way(std::string_view name, bool over_ranks) {
  std::string names;
  for (const Row& row : kRows) {
    if (over_ranks && !row.method.distributed) continue;
    if (name == "auto" || row.method.name == name) return row.way;
    names += " " + std::string(row.method.name);
  }
  throw std::invalid_argument("no refinement " + std::string(over_ranks ? "over ranks " : "") +
                              "is called \"" + std::string(name) + "\"; legal are" + names);
}

}  // namespace delray::delaunay
