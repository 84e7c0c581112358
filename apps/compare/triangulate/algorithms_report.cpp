// Figures 7.31 and 7.32 of Kohout (2004): there grades of the authors' opinion and speed-ups taken
// from papers, here lines that were counted, times that were measured, and ranks that were
// simulated.
#include "apps/compare/triangulate/algorithms_report.h"

#include <fmt/format.h>

#include <algorithm>

#include "apps/compare/triangulate/method_lines.h"
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

// The report's sequential algorithm.
constexpr std::string_view kSequentialName = "insertion, dag";

std::string ratio_text(double value) { return value > 0 ? fmt::format("{:.2f}", value) : "-"; }

// The largest number of threads that does not share cores.
int most_threads(const TriangulateComparison& comparison) {
  int most = 1;
  for (const int threads : comparison.threads)
    if (threads <= comparison.cores) most = std::max(most, threads);
  return most;
}

const MethodLines* lines_of(const std::string& method) {
  const auto all = method_lines();
  const auto found = std::ranges::find(all, method, &MethodLines::method);
  return found == all.end() ? nullptr : &*found;
}

// Simplicity, scalability and efficiency of each method of all points (Figure 7.31).
Html grades(const TriangulateComparison& comparison, const Rows& rows) {
  const int threads = most_threads(comparison);
  const auto sequential = std::ranges::find_if(
      rows, [](const Row& row) { return name_of(row.how) == kSequentialName; });
  Table numbers;
  numbers.columns = {{"method", false, false, {}},
                     {"lines beyond insertion", true, true, Source::counted},
                     {"lines in all", true, true, Source::counted},
                     {"scalability", true, true, Source::measured},
                     {"efficiency", true, true, Source::measured}};
  for (const Row& row : rows) {
    if (!is_plain(row.how) || !(is_alone(row) || row.how.threads == threads)) continue;
    const MethodLines* const lines = lines_of(row.how.method);
    const double gain = threads > 1 && !is_alone(row) ? speed_up(rows, row) : 0;
    const double faster = sequential != rows.end() && row.seconds.median > 0
                              ? sequential->seconds.median / row.seconds.median
                              : 0;
    numbers.rows.push_back({name_of(row.how), lines ? std::to_string(lines->own) : "-",
                            lines ? std::to_string(lines->all) : "-",
                            ratio_text(gain / row.how.threads), ratio_text(faster)});
  }
  return heading("Simplicity, scalability, efficiency") + table(numbers) +
         paragraph(fmt::format(
             "Lines are those of code, without comments: of the files that sequential insertion "
             "does not need, and of all that the method needs, mesh and exact predicates among "
             "them. Scalability is the speed-up over one thread, for each of {}; efficiency is how "
             "many times as fast as the report's sequential algorithm, which is {}, the method is "
             "then.",
             threads_text(threads), kSequentialName));
}

Look look_of_method(const std::string& name) { return look_of(Family::method, name); }

// Speed-ups at two, four and eight processing elements (Figure 7.32).
Html by_elements(const TriangulateComparison& comparison, const Rows& rows,
                 const DistributedComparison& simulated) {
  const std::vector<int> shown = shown_elements();
  const auto is_shown = [&](int elements) {
    return std::ranges::find(shown, elements) != shown.end();
  };
  std::vector<Series> series = series_by(
      rows_of(rows,
              [&](const Row& row) {
                return is_plain(row.how) && !is_alone(row) && is_shown(row.how.threads);
              }),
      [](const Row& row) { return name_of(row.how); }, look_of_method, Source::measured,
      [&](const Row& row) -> std::optional<ChartPoint> {
        const double gain = speed_up(rows, row);
        if (!(gain > 0)) return std::nullopt;
        return ChartPoint{static_cast<double>(row.how.threads), gain, gain, gain};
      });
  const auto seconds = [&](const std::string& method, int ranks) {
    for (const ComparedDistributedMethod& row : simulated.rows) {
      if (row.method == method && row.ranks == ranks && row.points == simulated.points)
        return row.predicted.front().seconds;
    }
    return 0.0;
  };
  for (const std::string& method :
       unique_of(simulated.rows, [](const auto& row) { return row.method; })) {
    const double base = seconds(method, 1);
    Series line{method + ", ranks", Source::predicted, {}, look_of_method(method)};
    for (const int ranks : shown) {
      const double taken = seconds(method, ranks);
      if (base > 0 && taken > 0) {
        line.points.push_back(
            {static_cast<double>(ranks), base / taken, base / taken, base / taken});
      }
    }
    if (!line.points.empty()) series.push_back(std::move(line));
  }
  if (series.empty()) return {};
  LineChart chart;
  chart.title = fmt::format("Speed-up over one processing element, {} points", rows.back().points);
  chart.x_label = "threads, or ranks";
  chart.y_label = "speed-up";
  chart.x_scale = Scale::logarithmic;
  chart.ticks_at_points = true;
  chart.more_is_better = true;
  chart.series = std::move(series);
  Html result = heading("Processing elements") + line_chart(chart) +
                paragraph("Threads are measured on this machine." + crowded_text(comparison));
  if (!simulated.networks.empty()) {
    result += paragraph(fmt::format(
        "Ranks are predicted: every one has a core of its own on the simulated machine, whose "
        "network is {}; what they compute is timed, how long messages take is calculated.",
        simulated.networks.front().name));
  }
  if (!simulated.left_out.empty()) {
    std::string names;
    for (const std::string& name : simulated.left_out) names += (names.empty() ? "" : "; ") + name;
    result += paragraph("Left out, as fewer ranks took too long: " + names + ".");
  }
  return result;
}

}  // namespace

std::vector<int> shown_elements() { return {2, 4, 8}; }

Html algorithms(const TriangulateComparison& comparison, const DistributedComparison& simulated) {
  const std::size_t points = most_points(comparison.rows);
  const Rows rows = rows_of(comparison.rows, [&](const Row& row) { return row.points == points; });
  return grades(comparison, rows) + by_elements(comparison, rows, simulated);
}

}  // namespace delray::apps
