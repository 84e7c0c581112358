// One table for both engines; the time line of rays by thread, of the rasterizer by phase.
#include "apps/view/figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "apps/report/stacked_bars.h"
#include "apps/report/table.h"
#include "apps/report/timeline.h"

namespace delray::apps::view {
namespace {

using report::Source;

Json regions_of(const raster::Statistics& statistics) {
  Json regions = Json::array();
  if (!statistics.partition) return regions;
  for (const loadbalance::Region& region : statistics.partition->partition.regions) {
    const geometry::Rect& r = region.rect;
    if (r.empty()) continue;
    regions.push_back({{"x", r.x0},
                       {"y", r.y0},
                       {"width", r.width()},
                       {"height", r.height()},
                       {"rank", region.owner}});
  }
  return regions;
}
Json regions_of(const raytrace::Statistics&) { return Json::array(); }

report::Html times_of(const raster::Statistics& statistics) {
  report::StackedBars bars;
  bars.title = "Last frame, by rank";
  bars.unit = "ms";
  bars.kinds = {"transform", "bin", "rasterize", "shade", "redistribute", "compose", "gather"};
  for (const raster::RankStatistics& rank : statistics.ranks) {
    const raster::Phases& p = rank.phases;
    std::vector<double> parts = {p.transform,    p.bin,     p.rasterize, p.shade,
                                 p.redistribute, p.compose, p.gather};
    for (double& part : parts) part = std::max(0.0, part * 1e3);
    bars.bars.push_back({fmt::format("rank {}", rank.rank), std::move(parts)});
  }
  return report::stacked_bars(bars);
}

report::Html times_of(const raytrace::Statistics& statistics) {
  constexpr std::size_t kMostSpans = 400;  // of a lane; a page has some hundred pixels
  report::Timeline line;
  line.title = "Last frame, by rank and thread";
  line.kinds = {"rays", "messages", "waiting"};
  line.idle = 2;
  for (std::size_t rank = 0; rank < statistics.ranks.size(); ++rank) {
    std::map<std::uint32_t, report::Lane> lanes;
    for (const loadbalance::Interval& interval : statistics.ranks[rank].timeline) {
      report::Lane& lane = lanes[interval.thread];
      lane.name = fmt::format("{}.{}", rank, interval.thread);
      if (lane.spans.size() < kMostSpans && interval.end > interval.begin)
        lane.spans.push_back({static_cast<int>(interval.kind), interval.begin, interval.end, ""});
    }
    for (auto& [thread, lane] : lanes) line.lanes.push_back(std::move(lane));
  }
  return report::timeline(line);
}

template <class Statistics>
Json figures(const Statistics& statistics, int width, int height) {
  std::vector<double> busy;
  std::uint64_t bytes = 0, messages = 0;
  double sum = 0, most = 0;
  report::Table table;
  table.columns = {{"rank"},
                   {"busy, ms", true, true, Source::measured},
                   {"of the mean", true, true, Source::measured},
                   {"tasks"},
                   {"sent, bytes"},
                   {"received, bytes"},
                   {"messages"}};
  table.columns.front().labelled = false;
  for (const auto& rank : statistics.ranks) {
    busy.push_back(rank.busy);
    sum += rank.busy;
    most = std::max(most, rank.busy);
    bytes += rank.bytes_sent;
    messages += rank.messages;
  }
  const double mean = sum / static_cast<double>(std::max<std::size_t>(1, busy.size()));
  Json loads = Json::array();
  for (std::size_t i = 0; i < busy.size(); ++i) {
    const auto& rank = statistics.ranks[i];
    loads.push_back(mean > 0 ? busy[i] / mean : 1.0);
    table.rows.push_back({std::to_string(i), fmt::format("{:.2f}", rank.busy * 1e3),
                          fmt::format("{:.2f}", loads.back().get<double>()),
                          std::to_string(rank.tasks), std::to_string(rank.bytes_sent),
                          std::to_string(rank.bytes_received), std::to_string(rank.messages)});
  }
  return {{"type", "figures"},
          {"width", width},
          {"height", height},
          {"regions", regions_of(statistics)},
          {"loads", loads},
          {"busy", busy},
          {"imbalance", mean > 0 ? most / mean : 1.0},
          {"bytes", bytes},
          {"messages", messages},
          {"html", times_of(statistics) + report::table(table)}};
}

}  // namespace

Json figures_of(const EngineStatistics& statistics, int width, int height) {
  return std::visit([&](const auto& one) { return figures(one, width, height); }, statistics);
}

}  // namespace delray::apps::view
