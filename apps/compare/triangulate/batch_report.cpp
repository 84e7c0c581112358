// Charts over what the batch method is told, and a table of what it chooses without being told.
#include "apps/compare/triangulate/batch_report.h"

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

namespace delray::apps {
namespace {

using namespace report;
using Row = ComparedTriangulation;
using Rows = ComparedTriangulations;

// Time against a number that the method was told, a line for each number of points.
template <class Told>
Html chart_of(const Rows& rows, const std::string& title, const std::string& x_label, Told&& told) {
  LineChart chart;
  chart.title = title;
  chart.x_label = x_label;
  chart.y_label = "time, ms";
  chart.x_scale = chart.y_scale = Scale::logarithmic;
  chart.ticks_at_points = true;
  chart.series = series_by(
      rows, [](const Row& row) { return fmt::format("{}, {} points", row.how.method, row.points); },
      [](const std::string& name) { return look_of(Family::method, name); }, Source::measured,
      [&](const Row& row) -> std::optional<ChartPoint> {
        const Spread& s = row.seconds;
        return ChartPoint{static_cast<double>(told(row)), s.median * 1e3, s.low * 1e3,
                          s.high * 1e3};
      });
  return line_chart(chart);
}

// "2, 3 from 4352 on".
std::string choices_text(const std::vector<delaunay::SearchingThreads>& choices) {
  std::string text;
  for (const auto& [inserted, threads] : choices) {
    text +=
        text.empty() ? std::to_string(threads) : fmt::format(", {} from {} on", threads, inserted);
  }
  return text;
}

}  // namespace

Html queues(const TriangulateComparison& comparison) {
  Rows rows = rows_of(comparison.rows, [](const Row& row) { return row.how.queue > 0; });
  std::ranges::stable_sort(rows, {}, [](const Row& row) { return row.how.queue; });
  if (rows.empty()) return {};
  return heading("The queue of the batch method") +
         chart_of(rows,
                  "Time against the capacity of the queue, " + threads_text(rows[0].how.threads),
                  "points in the queue", [](const Row& row) { return row.how.queue; }) +
         paragraph(
             "Threads that locate points wait while the queue is full, and the one that inserts "
             "them while it is empty. Without being told the queue goes by the number of points.");
}

Html searching_threads(const TriangulateComparison& comparison) {
  Rows given = rows_of(comparison.rows, [](const Row& row) { return row.how.searching > 0; });
  const Rows chosen = rows_of(comparison.rows, [](const Row& row) {
    return !row.statistics.searching.empty() && is_plain(row.how);
  });
  if (given.empty() || chosen.empty()) return {};
  std::ranges::stable_sort(given, {}, [](const Row& row) { return row.how.searching; });
  Table numbers;
  numbers.columns = {{"points", true, false, {}},
                     {"threads", true, false, {}},
                     {"of these locate points", false, true, Source::counted},
                     {"ms", true, true, Source::measured}};
  const auto add = [&](const Row& row, const std::string& searching) {
    numbers.rows.push_back({std::to_string(row.points), std::to_string(row.how.threads), searching,
                            fmt::format("{:.2f}", row.seconds.median * 1e3)});
  };
  for (const Row& row : given) add(row, fmt::format("{}, as told", row.how.searching));
  for (const Row& row : chosen) add(row, choices_text(row.statistics.searching));
  return heading("The threads of the batch method that locate points") +
         in_columns({chart_of(given,
                              "Time against threads that locate points, of at most " +
                                  threads_text(given[0].how.threads),
                              "threads that locate points",
                              [](const Row& row) { return row.how.searching; }),
                     table(numbers)}) +
         paragraph(
             "Without being told the method begins with two and measures how long it takes to "
             "locate a point and to insert one; the rounded ratio of these is how many keep the "
             "inserting thread busy. The others sleep. Locating takes longer the more points are "
             "in, so that the number may grow.");
}

}  // namespace delray::apps
