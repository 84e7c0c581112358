// Charts of whole frames by number of ranks over each network, a table of where each schedule stops
// gaining and which part of the busiest rank's time grows there, and that rank's time as bars.
#include "apps/compare/schedule/schedule_scaling.h"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "apps/compare/comparison.h"
#include "apps/compare/schedule/cut_levels.h"
#include "apps/compare/variant_looks.h"
#include "apps/compare/verdict.h"
#include "apps/report/chart.h"
#include "apps/report/page.h"
#include "apps/report/series.h"
#include "apps/report/stacked_bars.h"
#include "apps/report/table.h"

namespace delray::apps {
namespace {

using namespace report;

std::vector<std::string> schedules_in(const ScheduleComparison& comparison) {
  return unique_of(comparison.rows, [](const ComparedSchedule& row) { return row.schedule; });
}

Html lines(const ScheduleComparison& comparison, const std::string& title, const std::string& label,
           auto&& of) {
  return logarithmic_chart(
      title, "ranks", label,
      series_by(
          comparison.rows, [](const ComparedSchedule& row) { return row.schedule; },
          [](const std::string& name) { return look_of(Family::schedule, name); },
          Source::predicted,
          [&](const ComparedSchedule& row) -> std::optional<ChartPoint> {
            const double x = static_cast<double>(row.ranks), y = of(row);
            return ChartPoint{x, y, y, y};
          }));
}

// `limit(name, i)`: over the i-th network of `networks`.
Html limits(const std::string& what, const std::vector<std::string>& names,
            const std::vector<std::string>& networks, auto&& limit) {
  Table text;
  text.columns = {{"network", false, false, {}}, {what, false, false, {}}};
  for (const Column& column : limit_columns()) text.columns.push_back(column);
  for (std::size_t i = 0; i < networks.size(); ++i) {
    for (const std::string& name : names) {
      std::vector<std::string> line = {networks[i], name};
      for (std::string& cell : limit_cells(limit(name, i), kScheduleParts))
        line.push_back(std::move(cell));
      text.rows.push_back(std::move(line));
    }
  }
  return table(text);
}

std::vector<std::string> networks_of(const auto& over) {
  std::vector<std::string> names;
  for (const auto& one : over) names.push_back(one.network);
  return names;
}

Html splits(const ScheduleComparison& comparison) {
  std::vector<Html> figures;
  for (const std::string& schedule : schedules_in(comparison)) {
    StackedBars bars;
    bars.title = schedule;
    bars.unit = "ms";
    bars.source = Source::predicted;
    bars.kinds.assign(kScheduleParts.begin(), kScheduleParts.end());
    for (const ComparedSchedule& row : comparison.rows) {
      if (row.schedule != schedule) continue;
      StackedBar& bar = bars.bars.emplace_back();
      bar.name = std::to_string(row.ranks);
      for (const double seconds : row.over.front().parts) bar.parts.push_back(seconds * 1e3);
    }
    figures.push_back(stacked_bars(bars));
  }
  return in_columns(figures);
}

Html all_figures(const ScheduleComparison& comparison) {
  Table text;
  text.columns = {{"schedule", false, false, {}},
                  {"ranks", true, false, {}},
                  {"network", false, false, {}},
                  {"frame ms", true, true, Source::predicted}};
  for (Column& column : speed_up_columns(Source::predicted)) text.columns.push_back(column);
  for (const char* part : kScheduleParts)
    text.columns.push_back({fmt::format("{} ms", part), true, true, Source::predicted});
  for (const ComparedSchedule& row : comparison.rows) {
    for (const ScheduleOver& over : row.over) {
      const double speed_up = comparison.seconds / over.frame_seconds;
      std::vector<std::string> line = {row.schedule, std::to_string(row.ranks), over.network,
                                       milliseconds_text(over.frame_seconds, 3)};
      for (std::string& cell : speed_up_cells(speed_up, row.ranks)) line.push_back(std::move(cell));
      for (const double seconds : over.parts) line.push_back(milliseconds_text(seconds, 3));
      text.rows.push_back(std::move(line));
    }
  }
  return table(text);
}

Html distributions(const ScheduleComparison& comparison) {
  const std::vector<ComparedDistribution>& rows = comparison.distributions;
  if (rows.empty()) return "";
  const std::vector<std::string> names =
      unique_of(rows, [](const ComparedDistribution& row) { return row.distribution; });
  Table figures;
  figures.columns = {{"distribution", false, false, {}},
                     {"ranks", true, false, {}},
                     {"network", false, false, {}},
                     {"frame ms", true, true, Source::predicted},
                     {"efficiency", true, true, Source::predicted}};
  for (const char* part : kScheduleParts)
    figures.columns.push_back({fmt::format("{} ms", part), true, true, Source::predicted});
  figures.columns.push_back({"rays sent", true, true, Source::counted});
  figures.columns.push_back({"MB", true, true, Source::counted});
  for (const ComparedDistribution& row : rows) {
    for (const auto& [network, frame] : row.over) {
      std::vector<std::string> line = {
          row.distribution, std::to_string(row.ranks), network, milliseconds_text(frame.seconds, 3),
          fmt::format("{:.3f}", comparison.seconds / frame.seconds / row.ranks)};
      for (const double seconds : frame.parts) line.push_back(milliseconds_text(seconds, 3));
      line.push_back(std::to_string(frame.rays_sent));
      line.push_back(fmt::format("{:.3f}", static_cast<double>(frame.bytes) / 1e6));
      figures.rows.push_back(std::move(line));
    }
  }
  return heading("Where no rank has the whole scene") +
         paragraph(fmt::format(
             "Distributions of the scene (--data) over at most {} ranks, frame after the first: "
             "the "
             "renderer's own code on the simulated machine, in the processor time that it takes "
             "here. A replicated scene is what the rest of this page is about.",
             rows.back().ranks)) +
         limits("distribution", names, networks_of(rows.front().over),
                [&](const std::string& name, std::size_t i) {
                  return limit_of_distribution(comparison, name, i);
                }) +
         table(figures);
}

}  // namespace

Html schedule_scaling_tab(const ScheduleComparison& comparison) {
  Html result = paragraph(fmt::format(
      "Frames until rank 0 has the picture. One rank alone takes {} for its tiles (measured). The "
      "tiles' pixels go to rank 0 in one message of each rank, 20 bytes a pixel, which both copy "
      "once more. A schedule stops gaining at the fewest ranks that no others outdo by {:.0f} %.",
      time_text(comparison.seconds), (kWorthwhile - 1) * 100));
  const std::vector<ScheduleOver>& over = comparison.rows.front().over;
  result += heading("Where schedules stop gaining");
  result +=
      limits("schedule", schedules_in(comparison), networks_of(over),
             [&](const std::string& name, std::size_t i) { return limit_of(comparison, name, i); });
  for (std::size_t i = 0; i < over.size(); ++i) {
    result += heading("Over " + over[i].network);
    result += in_columns(
        {lines(comparison, "A frame", "time, ms",
               [&](const ComparedSchedule& row) { return row.over[i].frame_seconds * 1e3; }),
         lines(comparison, "Efficiency", "speed-up over one rank / ranks",
               [&](const ComparedSchedule& row) {
                 return comparison.seconds / row.over[i].frame_seconds / row.ranks;
               })});
  }
  result += heading("Where the busiest rank's time goes, over " + over.front().network);
  result += paragraph(
      "The rank that traces longest. Messages: the schedule's. Waiting: for tiles. Gather: from "
      "the end of its tiles until rank 0 has the whole picture.");
  result += splits(comparison) + distributions(comparison) + cut_levels_tab(comparison.cut_levels);
  return result + heading("All figures") + all_figures(comparison);
}

}  // namespace delray::apps
