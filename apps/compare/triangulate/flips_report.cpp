// Counts of the run that counts, over its points or its insertions.
#include "apps/compare/triangulate/flips_report.h"

#include <fmt/format.h>

#include <set>
#include <span>

#include "apps/compare/triangulate/triangulate_rows.h"
#include "apps/report/page.h"
#include "apps/report/stacked_bars.h"
#include "apps/report/table.h"

namespace delray::apps {
namespace {

using namespace report;
using Row = ComparedTriangulation;
using Rows = ComparedTriangulations;

struct FlipKind {
  const char* name;
  std::uint64_t delaunay::FlipCounts::*count;
};
constexpr FlipKind kKinds[] = {{"2-2", &delaunay::FlipCounts::two_two},
                               {"2-3", &delaunay::FlipCounts::two_three},
                               {"3-2", &delaunay::FlipCounts::three_two},
                               {"4-4", &delaunay::FlipCounts::four_four}};

// Those that there are in a dimension.
std::span<const FlipKind> kinds(int dim) {
  return dim == 2 ? std::span(kKinds).first<1>() : std::span<const FlipKind>(kKinds);
}

std::string ratio_text(std::uint64_t count, std::uint64_t of) {
  return of == 0 ? "-"
                 : fmt::format("{:.4g}", static_cast<double>(count) / static_cast<double>(of));
}

StackedBars bars_of(const Rows& rows, int dim, const std::string& title) {
  StackedBars chart;
  chart.title = title;
  chart.unit = "flips";
  chart.source = Source::counted;
  for (const FlipKind& kind : kinds(dim)) chart.kinds.emplace_back(kind.name);
  for (const Row& row : rows) {
    StackedBar bar{name_of(row.how), {}};
    for (const FlipKind& kind : kinds(dim))
      bar.parts.push_back(static_cast<double>(row.statistics.flips.*kind.count));
    chart.bars.push_back(std::move(bar));
  }
  return chart;
}

Table table_of(const Rows& rows, int dim) {
  Table numbers;
  numbers.columns = {
      {"points", true, false, {}}, {"method", false, false, {}}, {"threads", true, false, {}}};
  for (const FlipKind& kind : kinds(dim))
    numbers.columns.push_back({kind.name, true, true, Source::counted});
  numbers.columns.push_back({"flips/point", true, true, Source::counted});
  for (const Row& row : rows) {
    std::vector<std::string> line = {std::to_string(row.points), name_of(row.how),
                                     std::to_string(row.how.threads)};
    for (const FlipKind& kind : kinds(dim))
      line.push_back(std::to_string(row.statistics.flips.*kind.count));
    line.push_back(ratio_text(row.statistics.flips.sum(), row.distinct));
    numbers.rows.push_back(std::move(line));
  }
  return numbers;
}

}  // namespace

Html flips(const TriangulateComparison& comparison) {
  const Rows rows =
      rows_of(comparison.rows, [](const Row& row) { return row.statistics.flips.sum() > 0; });
  if (rows.empty()) return paragraph("No method here flips.");
  const std::size_t points = most_points(comparison.rows);
  std::vector<Html> charts;
  for (const int threads : std::set<int>{1, comparison.shown_threads}) {
    const Rows such = rows_of(
        rows, [&](const Row& row) { return row.points == points && row.how.threads == threads; });
    if (such.empty()) continue;
    charts.push_back(stacked_bars(
        bars_of(such, comparison.dim,
                fmt::format("Flips by kind, {}, {} points", threads_text(threads), points))));
  }
  return in_columns(charts) + table(table_of(rows, comparison.dim)) +
         paragraph(comparison.dim == 2
                       ? "Every flip replaces two triangles by two. Flips of insertions that were "
                         "undone count, too, so that more threads may have more of them."
                       : "The tetrahedra that a flip replaces, and those that it makes; 2-2 are at "
                         "flat sides of the hull. Flips of insertions that were undone count, too, "
                         "so that more threads may have more of them.");
}

Html list_lengths(const TriangulateComparison& comparison) {
  Table numbers;
  numbers.columns = {
      {"points", true, false, {}}, {"method", false, false, {}}, {"threads", true, false, {}}};
  for (const char* name : {"journal, mean", "journal, longest", "lock list, mean",
                           "lock list, longest", "insertions, undone ones included"})
    numbers.columns.push_back({name, true, true, Source::counted});
  for (const Row& row : comparison.rows) {
    const delaunay::Synchronization& s = row.statistics.synchronization;
    if (s.lock_lists.lists == 0) continue;
    const bool has_journal = s.journals.lists > 0;
    numbers.rows.push_back(
        {std::to_string(row.points), name_of(row.how), std::to_string(row.how.threads),
         ratio_text(s.journals.entries, s.journals.lists),
         has_journal ? std::to_string(s.journals.longest) : "-",
         ratio_text(s.lock_lists.entries, s.lock_lists.lists), std::to_string(s.lock_lists.longest),
         std::to_string(s.lock_lists.lists)});
  }
  if (numbers.rows.empty()) return {};
  return heading("Lengths of the lists that a thread keeps for an insertion") + table(numbers) +
         paragraph(
             "A journal has the links that an undone insertion restores; a method that undoes "
             "nothing has none. A lock list has the simplices that the thread holds at the end of "
             "an insertion, those that it has made among them.");
}

}  // namespace delray::apps
