// One function builds each tab of the page. Charts over threads and over points choose their rows
// and what is drawn of each.
#include "apps/compare/triangulate/triangulate_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>

#include "apps/compare/triangulate/algorithms_report.h"
#include "apps/compare/triangulate/batch_report.h"
#include "apps/compare/triangulate/flips_report.h"
#include "apps/compare/triangulate/locks_report.h"
#include "apps/compare/triangulate/scaling_laws.h"
#include "apps/compare/triangulate/triangulate_answer.h"
#include "apps/compare/triangulate/triangulate_figures.h"
#include "apps/compare/triangulate/triangulate_rows.h"
#include "apps/compare/variant_looks.h"
#include "apps/provenance.h"
#include "apps/report/chart.h"
#include "apps/report/page.h"
#include "apps/report/series.h"
#include "apps/report/stacked_bars.h"
#include "apps/report/table.h"
#include "delaunay/methods.h"

namespace delray::apps {
namespace {

using namespace report;
using Row = ComparedTriangulation;
using Rows = ComparedTriangulations;

constexpr const char* kPhases[] = {"order", "locate", "subdivide", "legalize", "extract"};
// The report's sequential algorithm.
constexpr std::string_view kSequentialRow = "insertion, dag";

// The largest of the requested numbers of threads that does not share cores.
int threads_of_own(const TriangulateComparison& comparison) {
  int result = comparison.threads.front();
  for (const int count : comparison.threads)
    if (count <= comparison.cores) result = count;
  return result;
}
// Not one of those that are there to be compared with the way that a method takes without being
// told.
bool is_plain_row(const Row& row) { return is_plain(row.how); }

using TriangulationPoint = std::function<std::optional<ChartPoint>(const Row&)>;

ChartPoint time_at(double x, const Row& row) {
  return {x, row.seconds.median * 1e3, row.seconds.low * 1e3, row.seconds.high * 1e3};
}
// The ratio of the times of `base` and the row, over `divisor`.
ChartPoint ratio_at(double x, const Spread& base, const Spread& seconds, double divisor) {
  const double scale = base.median / divisor;
  return {x, scale / seconds.median, scale / seconds.high, scale / seconds.low};
}

// The quantity that a chart shows upwards.
struct Shown {
  std::string title, label;  // the label with units
  Scale scale = Scale::logarithmic;
  Source source = Source::measured;
  bool more_is_better = false;
};

Html chart_of(const Shown& shown, const std::string& x_label, std::vector<Series> series) {
  if (series.empty()) return "";
  LineChart chart;
  chart.title = shown.title;
  chart.x_label = x_label;
  chart.y_label = shown.label;
  chart.x_scale = Scale::logarithmic;
  chart.y_scale = shown.scale;
  chart.ticks_at_points = true;
  chart.more_is_better = shown.more_is_better;
  chart.series = std::move(series);
  return line_chart(chart);
}

report::Look look(const std::string& name) { return look_of(Family::method, name); }

Html chart_of(const Rows& rows, const Shown& shown, const std::string& x_label,
              const TriangulationPoint& point) {
  return chart_of(
      shown, x_label,
      series_by(
          rows, [](const Row& row) { return name_of(row.how); }, look, shown.source, point));
}
Html over_threads(const Rows& rows, const Shown& shown, const TriangulationPoint& point) {
  return chart_of(rows, shown, "threads", point);
}
Html over_points(const Rows& rows, const Shown& shown, const TriangulationPoint& point) {
  return chart_of(rows, shown, "points", point);
}

// What there are no numbers of; empty where there are all.
Html left_out(const TriangulateComparison& comparison) {
  std::string names;
  for (const std::string& name : comparison.left_out) names += (names.empty() ? "" : "; ") + name;
  if (names.empty()) return {};
  return paragraph(
      "Left out, as they would take too long (--method names what is to be run nevertheless): " +
      names + ".");
}

Html times(const TriangulateComparison& comparison) {
  const Rows rows = rows_of(comparison.rows, is_plain_row);
  const std::size_t points = most_points(rows);
  const int threads = threads_of_own(comparison);
  return in_columns(
             {over_threads(rows_of(rows, [&](const Row& row) { return row.points == points; }),
                           {fmt::format("Time for {} points", points), "time, ms"},
                           [](const Row& row) { return time_at(row.how.threads, row); }),
              over_points(
                  rows_of(
                      rows,
                      [&](const Row& row) { return is_alone(row) || row.how.threads == threads; }),
                  {"Time with " + threads_text(threads), "time, ms"},
                  [](const Row& row) { return time_at(static_cast<double>(row.points), row); })}) +
         paragraph(
             "Medians; the upright lines are the intervals in which they lie with 95 %, of fewer "
             "than "
             "six runs all of their spread. Times are from points in memory to simplices in "
             "memory, sorting and extraction included. "
             "insertion always works with one thread.") +
         left_out(comparison);
}

Html speed_ups(const TriangulateComparison& comparison) {
  const Rows all = rows_of(comparison.rows, is_plain_row);
  const std::size_t points = most_points(all);
  const Rows several = rows_of(all, [](const Row& row) { return !is_alone(row); });
  const Rows most = rows_of(several, [&](const Row& row) { return row.points == points; });
  const auto ratio = [&](double x, const Row& row, double divisor) -> std::optional<ChartPoint> {
    const Row* base = base_of(all, row);
    if (base == nullptr) return std::nullopt;
    return ratio_at(x, base->seconds, row.seconds, divisor);
  };
  const auto shown = [](const std::string& title, const std::string& label) {
    return Shown{title, label, Scale::linear, Source::measured, true};
  };
  const std::string of = fmt::format(", {} points", points);
  std::vector<Html> charts;
  charts.push_back(
      over_threads(most, shown("Speed-up over one thread of the same method" + of, "speed-up"),
                   [&](const Row& row) { return ratio(row.how.threads, row, 1); }));
  charts.push_back(
      over_threads(most, shown("Efficiency: speed-up over threads" + of, "efficiency"),
                   [&](const Row& row) { return ratio(row.how.threads, row, row.how.threads); }));
  for (const int threads : comparison.threads) {
    if (threads == 1) continue;
    const Rows such = rows_of(several, [&](const Row& row) { return row.how.threads == threads; });
    charts.push_back(over_points(
        such, shown("Speed-up over one thread, " + threads_text(threads), "speed-up"),
        [&](const Row& row) { return ratio(static_cast<double>(row.points), row, 1); }));
  }
  const auto sequential = std::ranges::find_if(all, [&](const Row& row) {
    return row.points == points && name_of(row.how) == kSequentialRow;
  });
  if (sequential != all.end()) {
    charts.push_back(
        over_threads(rows_of(all, [&](const Row& row) { return row.points == points; }),
                     {"Times as fast as the report's sequential algorithm, which is " +
                          std::string(kSequentialRow) + of,
                      "times as fast", Scale::logarithmic, Source::measured, true},
                     [&](const Row& row) {
                       return ratio_at(row.how.threads, sequential->seconds, row.seconds, 1);
                     }));
  }
  std::erase(charts, Html());
  if (charts.empty()) return paragraph("One number of threads tells nothing about speed-up.");
  return in_columns(charts) +
         paragraph(
             "Of measured times; the upright lines are what the spread of the repetitions makes of "
             "them." +
             crowded_text(comparison)) +
         scaling_laws(all, most);
}

StackedBar phases_of(const std::string& name, const Row& row) {
  const delaunay::Statistics& s = row.statistics;
  StackedBar bar{name, {s.order, s.locate, s.subdivide, s.legalize, s.extract}};
  for (double& part : bar.parts) part *= 1e3;
  return bar;
}
StackedBars phase_bars(const std::string& title) {
  StackedBars chart;
  chart.title = title;
  chart.unit = "ms";
  chart.shares = true;
  chart.kinds.assign(std::begin(kPhases), std::end(kPhases));
  return chart;
}

Html phases(const TriangulateComparison& comparison) {
  const Rows& rows = comparison.rows;
  const std::size_t points = most_points(rows);
  std::vector<Html> result;
  std::set<int> counts = {1, threads_of_own(comparison)};
  for (const int threads : counts) {
    StackedBars chart = phase_bars(
        fmt::format("Shares of the phases, {}, {} points", threads_text(threads), points));
    for (const Row& row : rows) {
      if (row.points == points && row.how.threads == threads)
        chart.bars.push_back(phases_of(name_of(row.how), row));
    }
    if (!chart.bars.empty()) result.push_back(stacked_bars(chart));
  }
  for (const std::string& name :
       unique_of(rows, [](const Row& row) { return is_alone(row) ? name_of(row.how) : ""; })) {
    if (name.empty()) continue;
    StackedBars chart = phase_bars("Shares of the phases against points, " + name);
    for (const Row& row : rows) {
      if (name_of(row.how) == name)
        chart.bars.push_back(phases_of(fmt::format("{} points", row.points), row));
    }
    result.push_back(stacked_bars(chart));
  }
  return in_columns(result) + queues(comparison) + searching_threads(comparison) +
         paragraph(
             "Seconds of one run each, summed over threads; who waits for a lock waits in "
             "the phase that needs it. divide-and-conquer does everything but sorting and "
             "extraction in subdivide, cavity makes its simplices there.");
}

Html locks(const TriangulateComparison& comparison) {
  const Rows rows = rows_of(comparison.rows, [](const Row& row) {
    return row.statistics.synchronization.lock_calls > 0;
  });
  // A critical section is no lock of a simplex.
  const Rows several = rows_of(rows, [](const Row& row) {
    return row.how.threads > 1 && row.statistics.synchronization.free > 0 &&
           is_plain_but_for_makers(row.how);
  });
  if (rows.empty()) return paragraph("No locks were taken.");
  std::vector<Html> charts;
  for (const int threads : unique_of(several, [](const Row& row) { return row.how.threads; })) {
    const Rows such = rows_of(several, [&](const Row& row) { return row.how.threads == threads; });
    const auto count = [&](const char* title, const char* label,
                           std::uint64_t delaunay::Synchronization::*amount, double per_points) {
      charts.push_back(over_points(
          such, {title + (", " + threads_text(threads)), label, Scale::linear, Source::counted},
          [=](const Row& row) {
            const double x = static_cast<double>(row.points);
            const double y = static_cast<double>(row.statistics.synchronization.*amount) *
                             (per_points > 0 ? per_points / x : 1);
            return ChartPoint{x, y, y, y};
          }));
    };
    count("Deadlocks", "deadlocks", &delaunay::Synchronization::deadlocks, 0);
    count("Simplices that another thread had locked", "for a thousand points",
          &delaunay::Synchronization::waits, 1000);
  }
  const Html result = in_columns(charts);
  Table numbers;
  numbers.columns = {
      {"points", true, false, {}}, {"method", false, false, {}}, {"threads", true, false, {}}};
  for (const char* name : {"MA/N", "AL/N", "F/N", "W/N", "deadlocks", "rollbacks", "burglaries",
                           "repaired", "rebuilds"})
    numbers.columns.push_back({name, true, true, Source::counted});
  for (const Row& row : rows) {
    const delaunay::Synchronization& s = row.statistics.synchronization;
    std::vector<std::string> line = {std::to_string(row.points), name_of(row.how),
                                     std::to_string(row.how.threads)};
    for (const std::uint64_t count : {s.lock_calls, s.already_locked, s.free, s.waits}) {
      line.push_back(
          fmt::format("{:.4g}", static_cast<double>(count) / static_cast<double>(row.points)));
    }
    for (const std::uint64_t count :
         {s.deadlocks, s.rollbacks, s.burglaries, s.repaired, s.rebuilds})
      line.push_back(std::to_string(count));
    numbers.rows.push_back(std::move(line));
  }
  return result + heading("What the locks did, for each of the N points") + table(numbers) +
         paragraph(
             "MA: calls of the locking routine, each for all simplices that the next step "
             "needs. AL: simplices that the thread held already. F: free ones. W: those that "
             "another thread held. Of the pessimistic method MA is how often threads entered "
             "the critical section, and W how often another one was inside. Rollbacks are "
             "insertions that were undone and tried "
             "again; repaired and rebuilds are what the burglary and circumcircle methods "
             "do at the end, where a burglary may have left something wrong.") +
         lock_kinds(comparison) + unlock_times(comparison) + list_lengths(comparison);
}

// The simplices in the colours of their threads; empty without pictures.
Html pictures_of_makers(const TriangulateComparison& comparison) {
  if (comparison.pictures.empty()) return {};
  const int threads = comparison.shown_threads;
  Html result = paragraph(fmt::format(
      "The {} coloured by the thread that made them, {}{}. Where the colours lie together, "
      "threads seldom meet.",
      simplices_text(comparison.dim), threads_text(threads),
      comparison.dim == 3 ? ", where a plane through the middle cuts them" : ""));
  result += "<div class=\"legend\">";
  for (int thread = 0; thread < threads; ++thread) {
    result += fmt::format("<span class=\"key\"><i class=\"span c{}\"></i>thread {}</span>",
                          thread % 8, thread);
  }
  result += "</div>\n";
  std::vector<Html> pictures;
  for (const PictureOfMakers& one : comparison.pictures) {
    pictures.push_back(picture(one.picture, fmt::format("{}, {} points: {} fragments (counted)",
                                                        one.name, one.points, one.fragments)));
  }
  result += beside(pictures);
  return result;
}

// The shares of the threads in the simplices of so many points; empty without rows.
Html makers_bars(const TriangulateComparison& comparison, const Rows& rows, std::size_t points) {
  StackedBars shares;
  shares.title =
      fmt::format("Who made the {} {} of {} points", rows.empty() ? 0 : rows.back().simplices,
                  simplices_text(comparison.dim), points);
  shares.unit = simplices_text(comparison.dim);
  shares.source = Source::counted;
  shares.shares = true;
  for (int thread = 0; thread < comparison.shown_threads; ++thread)
    shares.kinds.push_back(fmt::format("thread {}", thread));
  for (const Row& row : rows) {
    if (row.points != points || row.simplices == 0) continue;
    StackedBar bar{name_of(row.how), {}};
    for (const std::uint64_t count : row.simplices_by_thread)
      bar.parts.push_back(static_cast<double>(count));
    shares.bars.push_back(std::move(bar));
  }
  return shares.bars.empty() ? Html() : stacked_bars(shares);
}

Html fragments(const TriangulateComparison& comparison) {
  const int threads = comparison.shown_threads;
  const Rows rows = rows_of(comparison.rows, [&](const Row& row) {
    return row.how.threads == threads && is_plain_but_for_makers(row.how);
  });
  Html result = pictures_of_makers(comparison);
  const Html chart = over_points(
      rows,
      {"Fragments, " + threads_text(threads), "fragments", Scale::logarithmic, Source::counted},
      [](const Row& row) {
        const auto y = static_cast<double>(row.fragments);
        return ChartPoint{static_cast<double>(row.points), y, y, y};
      });
  const std::size_t points = most_points(comparison.rows);
  Table table_of;
  table_of.columns = {{"method", false, false, {}},
                      {"split", false, false, {}},
                      {"fragments", true, true, Source::counted},
                      {"ms", true, true, Source::measured},
                      {"least", true, true, Source::measured},
                      {"most", true, true, Source::measured}};
  for (const Row& row : rows) {
    if (row.points != points) continue;
    const auto ms = [](double seconds) { return fmt::format("{:.2f}", seconds * 1e3); };
    table_of.rows.push_back({row.how.method, row.how.split, std::to_string(row.fragments),
                             ms(row.seconds.median), ms(row.seconds.least), ms(row.seconds.most)});
  }
  result += in_columns(
      {chart, "<div>" + heading(fmt::format("{} points, {}", points, threads_text(threads))) +
                  table(table_of) + "</div>"});
  if (threads <= 8) result += makers_bars(comparison, rows, points);
  return result +
         paragraph(
             "A fragment is a connected set of simplices that one thread made: at best there are "
             "as many as threads. The optimistic method stands there with every way to split the "
             "points among threads; the others with the one they take without being told. Of the "
             "batch method one thread makes everything. Threads of divide-and-conquer and cavity "
             "take their parts as they come.");
}

Html history(const TriangulateComparison& comparison) {
  const Rows rows = rows_of(comparison.rows, [&](const Row& row) {
    return row.statistics.dag_nodes > 0 && row.how.threads <= comparison.cores;
  });
  if (rows.empty()) return paragraph("No history was kept.");
  const Html chart = chart_of(
      {"Time against nodes of the history", "time, ms"}, "nodes",
      series_by(
          rows,
          [](const Row& row) { return name_of(row.how) + ", " + threads_text(row.how.threads); },
          look, Source::measured,
          [](const Row& row) -> std::optional<ChartPoint> {
            return time_at(static_cast<double>(row.statistics.dag_nodes), row);
          }));
  Table numbers;
  numbers.columns = {{"points", true, false, {}},
                     {"method", false, false, {}},
                     {"threads", true, false, {}},
                     {"nodes", true, true, Source::counted},
                     {"nodes/point", true, true, Source::counted},
                     {"bytes/node", true, true, Source::counted},
                     {"ms", true, true, Source::measured},
                     {"ns/node", true, true, Source::measured}};
  for (const Row& row : rows) {
    const auto nodes = static_cast<double>(row.statistics.dag_nodes);
    numbers.rows.push_back({std::to_string(row.points), name_of(row.how),
                            std::to_string(row.how.threads),
                            std::to_string(row.statistics.dag_nodes),
                            fmt::format("{:.2f}", nodes / static_cast<double>(row.points)),
                            std::to_string(row.statistics.dag_node_bytes),
                            fmt::format("{:.2f}", row.seconds.median * 1e3),
                            fmt::format("{:.1f}", row.seconds.median * 1e9 / nodes)});
  }
  return in_columns({chart, table(numbers)}) +
         paragraph(
             "The history has a node for every simplex that ever was. Points that need more "
             "flips make more of them, and time goes with nodes rather than with points.");
}

Html all_rows(const TriangulateComparison& comparison) {
  const TextTable text = triangulate_table(comparison);
  Table result;
  for (const std::string& name : text[0]) {
    const bool measured =
        name.ends_with("ms") || name == "speed-up" || name == "efficiency" || name == "sequential";
    const bool given = name == "points" || name == "method" || name == "threads";
    result.columns.push_back(
        {name, name != "method", !given, measured ? Source::measured : Source::counted});
  }
  result.rows.assign(text.begin() + 1, text.end());
  return table(result) +
         paragraph(
             "ms is the median; speed-up is over the same method with one thread; "
             "sequential is the fraction of the work that Amdahl's law takes for it then (Karp and "
             "Flatt).");
}

}  // namespace

report::Page page_of_triangulations(const Session& session, const TriangulateRequest& request,
                                    const std::string& what) {
  Page result;
  const std::filesystem::path file(request.input.path);
  result.title = fmt::format("Triangulating {}{}", file.filename().string(), what);
  result.machine = machine_and_compiler();
  result.provenance = provenance(session);
  result.provenance.emplace_back("seed", std::to_string(request.seed));
  return result;
}

report::Page triangulate_page(const Session& session, const TriangulateRequest& request,
                              const TriangulateComparison& comparison,
                              const DistributedComparison& simulated) {
  Page result = page_of_triangulations(
      session, request, fmt::format(", {} points in {}D", comparison.points, comparison.dim));
  result.unfinished = comparison.unfinished;
  result.answer = triangulate_answer(comparison);
  result.tabs.push_back({"Times", times(comparison)});
  result.tabs.push_back({"Speed-up", speed_ups(comparison)});
  result.tabs.push_back({"Algorithms", algorithms(comparison, simulated)});
  result.tabs.push_back({"Fragments", fragments(comparison)});
  result.tabs.push_back({"Phases", phases(comparison)});
  result.tabs.push_back({"Flips", flips(comparison)});
  result.tabs.push_back({"Locks", locks(comparison)});
  result.tabs.push_back({"History", history(comparison)});
  result.tabs.push_back({"All figures", all_rows(comparison)});
  result.data = triangulate_statistics(request, comparison);
  return result;
}

}  // namespace delray::apps
