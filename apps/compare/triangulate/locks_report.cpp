// Rows of methods that leave a choice of locks, and differ in nothing else from what they do
// without being told.
#include "apps/compare/triangulate/locks_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>

#include "apps/compare/triangulate/triangulate_rows.h"
#include "apps/compare/variant_looks.h"
#include "apps/report/chart.h"
#include "apps/report/page.h"
#include "apps/report/series.h"
#include "apps/report/table.h"
#include "delaunay/methods.h"

namespace delray::apps {
namespace {

using namespace report;
using Row = ComparedTriangulation;
using Rows = ComparedTriangulations;

// Of the shown number of threads, those that differ in nothing but `choice` from what the method
// does without being told, if it leaves the choice.
Rows rows_by(const TriangulateComparison& comparison, std::string delaunay::Options::*choice,
             std::vector<std::string_view> delaunay::Method::*choices) {
  return rows_of(comparison.rows, [&](const Row& row) {
    delaunay::Options usual = row.how;
    usual.*choice = "auto";
    return row.how.threads == comparison.shown_threads &&
           (method_of(row.how).*choices).size() > 1 && is_plain(resolve(usual));
  });
}

std::string for_each_point(std::uint64_t count, const Row& row) {
  return fmt::format("{:.4g}", static_cast<double>(count) / static_cast<double>(row.points));
}

}  // namespace

Html lock_kinds(const TriangulateComparison& comparison) {
  const Rows rows = rows_by(comparison, &delaunay::Options::locks, &delaunay::Method::locks);
  if (std::ranges::all_of(rows, [](const Row& row) { return is_plain(row.how); })) return {};
  LineChart chart;
  chart.title = "Time by kind of locks, " + threads_text(comparison.shown_threads);
  chart.x_label = "points";
  chart.y_label = "time, ms";
  chart.x_scale = chart.y_scale = Scale::logarithmic;
  chart.ticks_at_points = true;
  const auto name = [](const Row& row) { return row.how.method + ", " + row.how.locks; };
  chart.series = series_by(
      rows, name, [](const std::string& row) { return look_of(Family::method, row); },
      Source::measured,
      [](const Row& row) -> std::optional<ChartPoint> {
        const Spread& s = row.seconds;
        return ChartPoint{static_cast<double>(row.points), s.median * 1e3, s.low * 1e3,
                          s.high * 1e3};
      });
  Table numbers;
  numbers.columns = {{"points", true, false, {}},
                     {"method", false, false, {}},
                     {"locks", false, false, {}},
                     {"ms", true, true, Source::measured},
                     {"mutexes locked/N", true, true, Source::counted},
                     {"of these contended", true, true, Source::counted},
                     {"bytes of mutexes", true, true, Source::counted}};
  for (const Row& row : rows) {
    const delaunay::Synchronization& s = row.statistics.synchronization;
    numbers.rows.push_back({std::to_string(row.points), row.how.method, row.how.locks,
                            fmt::format("{:.2f}", row.seconds.median * 1e3),
                            for_each_point(s.mutex_locks, row), std::to_string(s.mutex_waits),
                            std::to_string(s.mutex_bytes)});
  }
  return heading("Atomic instructions against mutexes") +
         in_columns({line_chart(chart), table(numbers)}) +
         paragraph(
             "The optimistic and burglary methods look at the lock of a simplex and set it in one "
             "step: by an atomic instruction, under one mutex of the operating system for all "
             "simplices, or under one of 1024 (striped). A contended mutex puts the thread to "
             "sleep. The pessimistic method has one critical section, by a mutex or by an atomic "
             "flag.");
}

Html unlock_times(const TriangulateComparison& comparison) {
  const Rows rows = rows_by(comparison, &delaunay::Options::unlock, &delaunay::Method::unlocks);
  if (std::ranges::all_of(rows, [](const Row& row) { return is_plain(row.how); })) return {};
  Table numbers;
  numbers.columns = {{"points", true, false, {}},
                     {"method", false, false, {}},
                     {"unlocks", false, false, {}},
                     {"ms", true, true, Source::measured}};
  for (const char* name : {"unlocked early/N", "MA/N", "F/N", "W/N", "lock list, mean", "deadlocks",
                           "rollbacks", "burglaries"})
    numbers.columns.push_back({name, true, true, Source::counted});
  for (const Row& row : rows) {
    const delaunay::Synchronization& s = row.statistics.synchronization;
    const double insertions = std::max(static_cast<double>(s.lock_lists.lists), 1.0);
    numbers.rows.push_back(
        {std::to_string(row.points), row.how.method, row.how.unlock,
         fmt::format("{:.2f}", row.seconds.median * 1e3), for_each_point(s.unlocked_early, row),
         for_each_point(s.lock_calls, row), for_each_point(s.free, row),
         for_each_point(s.waits, row),
         fmt::format("{:.4g}", static_cast<double>(s.lock_lists.entries) / insertions),
         std::to_string(s.deadlocks), std::to_string(s.rollbacks), std::to_string(s.burglaries)});
  }
  return heading("Unlocking early") + table(numbers) +
         paragraph(
             "A neighbour of the new simplices that an insertion leaves as it is can be unlocked "
             "before the insertion ends: others cannot replace it without the new simplex beside "
             "it, which stays locked. If a later step of the insertion needs it again, it is "
             "locked "
             "again.");
}

}  // namespace delray::apps
