// One function builds the first screen, with its advice, and one each tab of the page.
#include "apps/compare/schedule/schedule_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>

#include "apps/compare/schedule/schedule_figures.h"
#include "apps/compare/schedule/schedule_scaling.h"
#include "apps/compare/variant_looks.h"
#include "apps/compare/verdict.h"
#include "apps/provenance.h"
#include "apps/report/chart.h"
#include "apps/report/overlay.h"
#include "apps/report/page.h"
#include "apps/report/series.h"
#include "apps/report/table.h"
#include "apps/report/timeline.h"
#include "apps/statistics.h"
#include "comm/network.h"

namespace delray::apps {
namespace {

using namespace report;

constexpr const char* kFrame = "frame";
// Shorter than this part of a timeline nothing can be seen.
constexpr double kSeen = 1.0 / 1500;

double costliest(const ScheduleComparison& comparison) {
  double most = 0;
  for (const Tile& tile : comparison.tiles) most = std::max(most, tile.seconds.median);
  return most;
}

int frames_of(const ScheduleComparison& comparison) {
  return comparison.tiles.empty() ? 0 : comparison.tiles.front().seconds.runs;
}

// The least time that any schedule could take.
double least_seconds(const ScheduleComparison& comparison, int ranks) {
  return std::max(comparison.seconds / ranks, costliest(comparison));
}

std::vector<int> rank_counts(const ScheduleComparison& comparison) {
  return unique_of(comparison.rows, [](const ComparedSchedule& row) { return row.ranks; });
}

const ComparedSchedule* row_of(const ScheduleComparison& comparison, const std::string& schedule,
                               int ranks) {
  for (const ComparedSchedule& row : comparison.rows)
    if (row.schedule == schedule && row.ranks == ranks) return &row;
  return nullptr;
}

std::vector<std::string> names_of(const std::vector<const ComparedSchedule*>& rows) {
  std::vector<std::string> names;
  for (const ComparedSchedule* row : rows) names.push_back(row->schedule);
  return names;
}

// Times of whole frames of ranks that had a core each.
Html traced_sentence(const ScheduleComparison& comparison) {
  std::vector<const ComparedSchedule*> best;
  for (const int ranks : rank_counts(comparison)) {
    const auto traced = best_traced(comparison.rows, ranks);
    if (!traced.empty()) best = traced;
  }
  if (best.empty()) return "";
  const std::vector<std::string> names = names_of(best);
  Html text = fmt::format("<p>On {} ranks of this machine ", best.front()->ranks);
  text += best.size() == 1
              ? fmt::format("use {}: a frame takes ", strong(names[0]))
              : fmt::format("there is no difference between {}: with {} a frame takes ",
                            strong(listed(names)), escaped(names[0]));
  return text + measured_text(best.front()->traced->seconds) + ".</p>\n";
}

Html advice(const ScheduleRequest& request, const ScheduleComparison& comparison) {
  const std::vector<int> counts = rank_counts(comparison);
  const int ranks = std::find(counts.begin(), counts.end(), shown_ranks(request)) != counts.end()
                        ? shown_ranks(request)
                        : counts.back();
  const auto winners = best_schedules(comparison.rows, ranks);
  const ComparedSchedule& best = *winners.front();
  const ScheduleOver& over = best.over.front();
  const std::vector<std::string> names = names_of(winners);
  Html text = fmt::format("<p>For {} ranks over {} ", ranks, escaped(over.network));
  text += winners.size() == 1 ? fmt::format("hand out tiles by {}: ", strong(names[0]))
                              : fmt::format("no difference is predicted between {}: by {} ",
                                            strong(listed(names)), escaped(names[0]));
  text += fmt::format(
      "the last tile is done after {} (predicted, {} to {} with the tiles of single frames), "
      "{:.3g} "
      "times an equal share of what all take: {}; the rank with most rays sends {:.3g} times the "
      "mean (counted).",
      time_text(over.seconds), time_text(over.spread.low), time_text(over.spread.high),
      comparison.seconds > 0 ? over.seconds * ranks / comparison.seconds : 1.0,
      measured_text(comparison.frame), over.ray_imbalance);
  const auto is_winner = [&](const ComparedSchedule& row) {
    return std::find(winners.begin(), winners.end(), &row) != winners.end();
  };
  const ComparedSchedule* next = nullptr;
  for (const ComparedSchedule& row : comparison.rows) {
    if (!is_winner(row) && row.ranks == ranks &&
        (next == nullptr || row.over.front().seconds < next->over.front().seconds))
      next = &row;
  }
  const auto more = [&](const ComparedSchedule& row) {
    return (row.over.front().seconds / over.seconds - 1) * 100;
  };
  if (next != nullptr && over.seconds > 0)
    text += fmt::format(" {} takes {:.1f} % more", escaped(next->schedule), more(*next));
  const ComparedSchedule* fixed = row_of(comparison, "static", ranks);
  if (next != nullptr && fixed != nullptr && !is_winner(*fixed) && fixed != next &&
      over.seconds > 0)
    text += fmt::format(", static, which never adapts, {:.0f} %", more(*fixed));
  text += next != nullptr ? " (predicted).</p>\n" : "</p>\n";
  return traced_sentence(comparison) + text +
         fmt::format(
             "<p>The costliest tile alone takes {} (measured): with tiles of {} pixels no schedule "
             "is done sooner. An equal share of the work is as short with {:.0f} ranks.</p>\n",
             time_text(costliest(comparison)), request.tile,
             costliest(comparison) > 0 ? comparison.seconds / costliest(comparison) : 1.0);
}

Html first_screen(const ScheduleRequest& request, const ScheduleComparison& comparison) {
  Table best_of;
  best_of.columns = {{"ranks", true, false, {}},
                     {"here", false, true, Source::measured},
                     {"at least, ms", true, true, Source::predicted}};
  const std::vector<ScheduleOver>& over = comparison.rows.front().over;
  for (const ScheduleOver& one : over)
    best_of.columns.push_back({one.network, false, true, Source::predicted});
  for (const int ranks : rank_counts(comparison)) {
    const auto traced = best_traced(comparison.rows, ranks);
    std::vector<std::string> line = {
        std::to_string(ranks),
        traced.empty() ? "-"
                       : fmt::format("{}, {} ms", winners_cell(names_of(traced)),
                                     milliseconds_cell(traced.front()->traced->seconds)),
        short_number(least_seconds(comparison, ranks) * 1e3)};
    for (std::size_t i = 0; i < over.size(); ++i) {
      const auto best = best_schedules(comparison.rows, ranks, i);
      line.push_back(fmt::format("{}, {}", winners_cell(names_of(best)),
                                 time_text(best.front()->over[i].seconds)));
    }
    best_of.rows.push_back(std::move(line));
  }
  return advice_beside(
      advice(request, comparison),
      paragraph(
          "By number of ranks, the schedule whose last tile is done first over each network; no "
          "schedule could take less than what stands left of it. \u2248: no difference, the "
          "intervals of "
          "times with the tiles of single frames overlap, or here those of the frames' medians.") +
          table(best_of));
}

using SchedulePoint = std::function<std::optional<ChartPoint>(const ComparedSchedule&)>;

Html chart_by_ranks(const ScheduleComparison& comparison, const std::string& title,
                    const std::string& label, Source source, Scale scale, const SchedulePoint& of) {
  LineChart chart;
  chart.title = title;
  chart.x_label = "ranks";
  chart.y_label = label;
  chart.x_scale = Scale::logarithmic;
  chart.y_scale = scale;
  chart.ticks_at_points = true;
  chart.series = series_by(
      comparison.rows, [](const ComparedSchedule& row) { return row.schedule; },
      [](const std::string& name) { return look_of(Family::schedule, name); }, source, of);
  return line_chart(chart);
}

SchedulePoint value_of(std::function<double(const ScheduleOver&)> value, std::size_t network = 0) {
  return [value = std::move(value),
          network](const ComparedSchedule& row) -> std::optional<ChartPoint> {
    const double y = value(row.over[network]);
    return ChartPoint{static_cast<double>(row.ranks), y, y, y};
  };
}

Html evenness(const ScheduleRequest& request, const ScheduleComparison& comparison) {
  const std::string& network = comparison.rows.front().over.front().network;
  Html result = in_columns(
      {chart_by_ranks(comparison, "How even the ranks' work is", "most rays over mean",
                      Source::counted, Scale::logarithmic,
                      value_of([](const ScheduleOver& over) { return over.ray_imbalance; })),
       chart_by_ranks(comparison, "The same in processor time", "busiest rank over mean",
                      Source::predicted, Scale::logarithmic,
                      value_of([](const ScheduleOver& over) { return over.time_imbalance; })),
       chart_by_ranks(comparison, "Not tracing until the last tile is done", "% of the ranks' time",
                      Source::predicted, Scale::linear,
                      value_of([](const ScheduleOver& over) { return over.idle * 100; })),
       chart_by_ranks(comparison, "What is lost", "last tile over an equal share",
                      Source::predicted, Scale::logarithmic,
                      [&](const ComparedSchedule& row) -> std::optional<ChartPoint> {
                        if (!(comparison.seconds > 0)) return std::nullopt;
                        const double y = row.over.front().seconds * row.ranks / comparison.seconds;
                        return ChartPoint{static_cast<double>(row.ranks), y, y, y};
                      })});
  return result +
         paragraph(fmt::format(
             "The schedules' own code runs on a simulated machine that has a core for each rank, "
             "over {}; a tile takes the processor time that it took here, median of {} frames on "
             "one core. Work is counted in rays and in processor time, not in time that passes. "
             "Where ranks answer others they look for messages after every tile, which takes them "
             "{:.3g} us over this network.",
             network, frames_of(comparison), request.networks.front().network.overhead * 1e6));
}

Html traced_here(const ScheduleComparison& comparison) {
  Table measured;
  measured.columns = {{"ranks", true, false, {}},
                      {"schedule", false, false, {}},
                      {"frame ms", true, true, Source::measured},
                      {"least", true, true, Source::measured},
                      {"most", true, true, Source::measured},
                      {"rays max/mean", true, true, Source::counted},
                      {"requests", true, true, Source::counted},
                      {"steals", true, true, Source::counted},
                      {"messages", true, true, Source::counted}};
  int runs = 0;
  for (const ComparedSchedule& row : comparison.rows) {
    if (!row.traced) continue;
    const TracedFrames& traced = *row.traced;
    runs = traced.seconds.runs;
    measured.rows.push_back(
        {std::to_string(row.ranks), row.schedule, short_number(traced.seconds.median * 1e3),
         short_number(traced.seconds.least * 1e3), short_number(traced.seconds.most * 1e3),
         fmt::format("{:.3f}", traced.ray_imbalance), std::to_string(traced.requests),
         std::to_string(traced.steals), std::to_string(traced.messages)});
  }
  if (measured.rows.empty()) return "";
  return heading("Traced here") +
         paragraph(fmt::format("Whole frames by ranks that are threads of one process, with the "
                               "gathering of the picture, medians of {}; counts are of the first.",
                               runs)) +
         table(measured);
}

Html times(const ScheduleComparison& comparison) {
  std::vector<Html> charts;
  const std::vector<ScheduleOver>& over = comparison.rows.front().over;
  for (std::size_t i = 0; i < over.size(); ++i) {
    charts.push_back(chart_by_ranks(comparison,
                                    "Until the last tile is done, over " + over[i].network,
                                    "time, ms", Source::predicted, Scale::logarithmic,
                                    [i](const ComparedSchedule& row) -> std::optional<ChartPoint> {
                                      const Spread& s = row.over[i].spread;
                                      return ChartPoint{static_cast<double>(row.ranks),
                                                        s.median * 1e3, s.low * 1e3, s.high * 1e3};
                                    }));
  }
  return in_columns(charts) + traced_here(comparison);
}

Html tile_costs(const ScheduleRequest& request, const ScheduleComparison& comparison) {
  Overlay rays{
      "Rays of each tile", Source::counted, request.render.width, request.render.height, {},
      Shading::amount};
  Overlay seconds{"Processor time of each tile",
                  Source::measured,
                  request.render.width,
                  request.render.height,
                  {},
                  Shading::amount};
  double most_rays = 0;
  for (const Tile& tile : comparison.tiles)
    most_rays = std::max(most_rays, static_cast<double>(tile.rays));
  const double most_seconds = costliest(comparison);
  for (const Tile& tile : comparison.tiles) {
    const auto count = static_cast<double>(tile.rays);
    rays.areas.push_back(
        {tile.pixels, 0, most_rays > 0 ? count / most_rays : 0, fmt::format("{} rays", tile.rays)});
    seconds.areas.push_back(
        {tile.pixels, 0, most_seconds > 0 ? tile.seconds.median / most_seconds : 0,
         fmt::format("{}, {} to {}", time_text(tile.seconds.median), time_text(tile.seconds.least),
                     time_text(tile.seconds.most))});
  }
  return in_columns({overlay(rays, kFrame), overlay(seconds, kFrame)}) +
         paragraph(fmt::format("The darker, the more: up to {} rays and {}.",
                               short_number(most_rays), time_text(most_seconds)));
}

Html tile_owners(const ScheduleRequest& request, const ScheduleComparison& comparison) {
  std::vector<Html> maps;
  for (const ShownSchedule& shown : comparison.shown) {
    Overlay map{shown.name, Source::counted, request.render.width, request.render.height,
                {},         Shading::group};
    for (std::size_t i = 0; i < comparison.tiles.size(); ++i) {
      map.areas.push_back(
          {comparison.tiles[i].pixels, shown.owners[i], 1,
           fmt::format("rank {}, {} rays", shown.owners[i], comparison.tiles[i].rays)});
    }
    maps.push_back(overlay(map, kFrame));
  }
  return beside(maps);
}

Html tiles(const ScheduleRequest& request, const ScheduleComparison& comparison) {
  Html result = backdrop(comparison.picture, kFrame) + heading("What tiles cost") +
                tile_costs(request, comparison);
  if (comparison.shown.empty()) return result;
  return result +
         heading(fmt::format("Who traced which tile: a colour for each of {} ranks",
                             comparison.shown.front().ranks.size())) +
         tile_owners(request, comparison);
}

Timeline timeline_of(const ShownSchedule& shown) {
  Timeline result;
  result.title = shown.name;
  result.source = Source::predicted;
  result.kinds = {"trace tiles", "handle messages", "wait"};
  result.idle = 2;
  double all = 0;
  for (const loadbalance::RankReport& rank : shown.ranks)
    for (const loadbalance::Interval& interval : rank.timeline) all = std::max(all, interval.end);
  for (const loadbalance::RankReport& rank : shown.ranks) {
    Lane lane{fmt::format("rank {}", rank.rank), {}};
    std::uint64_t tasks = 0;
    for (const loadbalance::Interval& interval : rank.timeline) {
      const int kind = static_cast<int>(interval.kind);
      if (interval.kind != loadbalance::Interval::Kind::work &&
          interval.end - interval.begin < kSeen * all)
        continue;
      const bool goes_on = !lane.spans.empty() && lane.spans.back().kind == kind &&
                           interval.begin - lane.spans.back().end < kSeen * all;
      tasks = goes_on ? tasks + interval.tasks : interval.tasks;
      if (goes_on)
        lane.spans.back().end = interval.end;
      else
        lane.spans.push_back({kind, interval.begin, interval.end, ""});
      if (tasks > 0) lane.spans.back().note = fmt::format("{} tiles", tasks);
    }
    result.lanes.push_back(std::move(lane));
  }
  return result;
}

Html timelines(const ScheduleComparison& comparison) {
  Html result = paragraph(
      fmt::format("What each rank did when, over {}; what is too short to be seen is left out.",
                  comparison.rows.front().over.front().network));
  for (const ShownSchedule& shown : comparison.shown) result += timeline(timeline_of(shown));
  return result;
}

Html traffic(const ScheduleComparison& comparison) {
  const auto number = [](std::uint64_t ScheduleOver::*amount) {
    return value_of(
        [amount](const ScheduleOver& over) { return static_cast<double>(over.*amount); });
  };
  const auto chart = [&](const char* title, const char* label,
                         std::uint64_t ScheduleOver::*amount) {
    return chart_by_ranks(comparison, title, label, Source::counted, Scale::logarithmic,
                          number(amount));
  };
  return in_columns({chart("Requests for tiles", "messages", &ScheduleOver::requests),
                     chart("Steals: messages with tiles of another's share", "messages",
                           &ScheduleOver::steals),
                     chart("Tiles stolen", "tiles", &ScheduleOver::tasks_stolen),
                     chart("Rays stolen of tiles in progress", "rays", &ScheduleOver::rays_stolen),
                     chart("All messages of the schedule", "messages", &ScheduleOver::messages)}) +
         paragraph(
             "Counted on the simulated machine, without those that bring pixels to rank 0. "
             "Schedules without any are not in the chart.");
}

Html figures(const ScheduleRequest& request, const ScheduleComparison& comparison) {
  const TextTable text = schedule_table(comparison);
  Table result;
  for (std::size_t i = 0; i < text[0].size(); ++i) {
    std::string name = text[0][i];
    Source source = name.ends_with(" ms") ? Source::measured : Source::counted;
    if (name.ends_with("predicted")) {
      source = Source::predicted;
      name = name.substr(0, name.find(','));
    }
    result.columns.push_back({name, i != 1, i > 1, source});
  }
  result.rows.assign(text.begin() + 1, text.end());
  return table(result) +
         paragraph(fmt::format("Counts are of the simulated machine over {}. Integrator {}, {} "
                               "per pixel, tiles of {} pixels, size {}.",
                               request.networks.front().name, request.render.raytrace.integrator,
                               count_text(request.render.raytrace.samples, "ray"), request.tile,
                               request.render.size));
}

}  // namespace

std::string schedule_report(const Session& session, const ScheduleRequest& request,
                            const Prepared& prepared, const ScheduleComparison& comparison) {
  Page result;
  const std::filesystem::path file(request.render.scene.file.path);
  result.title = fmt::format("Schedules for {}, {}", file.filename().string(), request.render.size);
  result.unfinished = comparison.unfinished;
  result.machine = machine_and_compiler();
  result.answer = first_screen(request, comparison);
  result.tabs.push_back({"Balance", evenness(request, comparison)});
  result.tabs.push_back({"Tiles", tiles(request, comparison)});
  if (!comparison.shown.empty()) result.tabs.push_back({"Timelines", timelines(comparison)});
  result.tabs.push_back({"Times", times(comparison)});
  result.tabs.push_back({"Whole frames", schedule_scaling_tab(comparison)});
  result.tabs.push_back({"Requests and steals", traffic(comparison)});
  result.tabs.push_back({"All figures", figures(request, comparison)});
  result.data = schedule_statistics(request, prepared, comparison);
  result.provenance = provenance(session, request.render.scene.file.path);
  result.provenance.emplace_back(
      "seed", fmt::format("{}, of the schedule random", loadbalance::ScheduleOptions().seed));
  return page(result);
}

}  // namespace delray::apps
