// Charts and tables of how strategies scale over each network, and the same as JSON. The tab says
// of each strategy where it stops gaining and which part of the busiest rank's time grows there.
#include "apps/compare/partition/scaling_figures.h"

#include <fmt/format.h>

#include <algorithm>

#include "apps/compare/comparison.h"
#include "apps/compare/variant_looks.h"
#include "apps/compare/verdict.h"
#include "apps/report/chart.h"
#include "apps/report/page.h"
#include "apps/report/series.h"
#include "apps/report/stacked_bars.h"
#include "apps/report/table.h"
#include "comm/network.h"
#include "files/memory_budget.h"

namespace delray::apps {
namespace {

using namespace report;

Json frame_json(const raster::PredictedFrame& frame, int ranks, double alone) {
  Json parts;
  for (int p = 0; p < raster::kParts; ++p) {
    const auto part = static_cast<raster::Part>(p);
    parts[raster::name(part)] = frame[part];
  }
  return {{"seconds", frame.seconds},
          {"speed_up", alone / frame.seconds},
          {"efficiency", alone / frame.seconds / ranks},
          {"serial_fraction", serial_fraction_json(alone / frame.seconds, ranks)},
          {"busiest_rank", frame.busiest},
          {"busiest_rank_seconds", std::move(parts)}};
}

std::vector<const char*> part_names() {
  std::vector<const char*> names;
  for (int p = 0; p < raster::kParts; ++p)
    names.push_back(raster::name(static_cast<raster::Part>(p)));
  return names;
}

std::vector<std::string> strategies_of(const StrategyScaling& scaling) {
  return unique_of(scaling.rows, [](const ScaledStrategy& row) { return row.strategy; });
}

Html lines(const StrategyScaling& scaling, const std::string& title, const std::string& label,
           auto&& of) {
  return logarithmic_chart(
      title, "ranks", label,
      series_by(
          scaling.rows, [](const ScaledStrategy& row) { return row.strategy; },
          [](const std::string& name) { return look_of(Family::strategy, name); },
          Source::predicted,
          [&](const ScaledStrategy& row) -> std::optional<ChartPoint> {
            const double x = static_cast<double>(row.ranks), y = of(row);
            return ChartPoint{x, y, y, y};
          }));
}

Html charts(const StrategyScaling& scaling, const std::string& network) {
  std::vector<Html> result;
  for (const Motion motion : kMotions) {
    const double alone = scaling.alone(motion);
    result.push_back(lines(
        scaling, fmt::format("A frame {}", name(motion)), "time, ms",
        [&](const ScaledStrategy& row) { return over(row, network)->of(motion).seconds * 1e3; }));
    result.push_back(lines(scaling, fmt::format("Efficiency {}", name(motion)),
                           "speed-up over one rank / ranks", [&](const ScaledStrategy& row) {
                             return alone / over(row, network)->of(motion).seconds / row.ranks;
                           }));
  }
  return in_columns(result);
}

Html limits(const StrategyScaling& scaling) {
  Html result;
  for (const Motion motion : kMotions) {
    Table text;
    text.columns = {{"network", false, false, {}}, {"strategy", false, false, {}}};
    for (const Column& column : limit_columns()) text.columns.push_back(column);
    for (const comm::NamedNetwork& named : scaling.networks) {
      for (const std::string& strategy : strategies_of(scaling)) {
        std::vector<std::string> line = {named.name, strategy};
        const ScalingLimit limit = limit_of(scaling, strategy, named.name, motion);
        for (std::string& cell : limit_cells(limit, part_names())) line.push_back(std::move(cell));
        text.rows.push_back(std::move(line));
      }
    }
    result += heading(fmt::format("Where strategies stop gaining, {}", name(motion)));
    result += table(text);
  }
  return result;
}

// Where the time of the busiest rank goes, over one network.
Html splits(const StrategyScaling& scaling, const std::string& network, Motion motion) {
  std::vector<Html> figures;
  for (const std::string& strategy : strategies_of(scaling)) {
    StackedBars bars;
    bars.title = fmt::format("{}, {}", strategy, name(motion));
    bars.unit = "ms";
    bars.source = Source::predicted;
    bars.kinds = {"transform and estimate"};
    for (int p = static_cast<int>(raster::Part::rasterize); p < raster::kParts; ++p)
      bars.kinds.emplace_back(raster::name(static_cast<raster::Part>(p)));
    for (const ScaledStrategy& row : scaling.rows) {
      if (row.strategy != strategy) continue;
      const raster::PredictedFrame& frame = over(row, network)->of(motion);
      StackedBar bar{std::to_string(row.ranks), {}};
      bar.parts.push_back((frame[raster::Part::transform] + frame[raster::Part::estimate]) * 1e3);
      for (int p = static_cast<int>(raster::Part::rasterize); p < raster::kParts; ++p)
        bar.parts.push_back(frame[static_cast<raster::Part>(p)] * 1e3);
      bars.bars.push_back(std::move(bar));
    }
    figures.push_back(stacked_bars(bars));
  }
  return in_columns(figures);
}

Html all_figures(const StrategyScaling& scaling) {
  Table text;
  text.columns = {{"strategy", false, false, {}},
                  {"ranks", true, false, {}},
                  {"network", false, false, {}},
                  {"frame", false, false, {}},
                  {"ms", true, true, Source::predicted}};
  for (Column& column : speed_up_columns(Source::predicted)) text.columns.push_back(column);
  for (int p = 0; p < raster::kParts; ++p) {
    text.columns.push_back({fmt::format("{} ms", raster::name(static_cast<raster::Part>(p))), true,
                            true, Source::predicted});
  }
  text.columns.push_back({"triangles max", true, true, Source::counted});
  text.columns.push_back({"samples max", true, true, Source::counted});
  text.columns.push_back({"MB", true, true, Source::counted});
  for (const ScaledStrategy& row : scaling.rows) {
    for (const ScaledStrategy::Over& over : row.over) {
      for (const Motion motion : kMotions) {
        const raster::PredictedFrame& frame = over.of(motion);
        const double speed_up = scaling.alone(motion) / frame.seconds;
        std::vector<std::string> line = {row.strategy, std::to_string(row.ranks), over.network,
                                         name(motion), milliseconds_text(frame.seconds, 3)};
        for (std::string& cell : speed_up_cells(speed_up, row.ranks))
          line.push_back(std::move(cell));
        for (const double seconds : frame.parts) line.push_back(milliseconds_text(seconds, 3));
        const bool turns = motion == Motion::turning;
        line.push_back(turns ? std::to_string(row.triangles_max) : "");
        line.push_back(turns ? std::to_string(row.shaded_max) : "");
        line.push_back(turns ? fmt::format("{:.3f}", static_cast<double>(row.bytes_total) / 1e6)
                             : "");
        text.rows.push_back(std::move(line));
      }
    }
  }
  return table(text);
}

}  // namespace

Json scaling_json(const StrategyScaling& scaling) {
  Json rows = Json::array(), limits = Json::array();
  for (const ScaledStrategy& row : scaling.rows) {
    Json one = {{"strategy", row.strategy},
                {"ranks", row.ranks},
                {"drawing", row.is_priced ? "priced" : "timed"},
                {"triangles_max", row.triangles_max},
                {"samples_shaded_max", row.shaded_max},
                {"bytes_total", row.bytes_total},
                {"messages", row.messages}};
    one["predicted"] = Json::array();
    for (const ScaledStrategy::Over& over : row.over) {
      one["predicted"].push_back(
          {{"network", over.network},
           {"at_rest", frame_json(over.at_rest, row.ranks, scaling.alone_at_rest)},
           {"turning", frame_json(over.turning, row.ranks, scaling.alone_turning)}});
    }
    rows.push_back(std::move(one));
  }
  for (const std::string& strategy : strategies_of(scaling)) {
    for (const comm::NamedNetwork& named : scaling.networks) {
      limits.push_back(
          {{"strategy", strategy},
           {"network", named.name},
           {"at_rest",
            limit_json(limit_of(scaling, strategy, named.name, Motion::at_rest), part_names())},
           {"turning",
            limit_json(limit_of(scaling, strategy, named.name, Motion::turning), part_names())}});
    }
  }
  Json left_out = Json::array();
  for (const NotScaled& one : scaling.left_out)
    left_out.push_back({{"strategy", one.strategy}, {"ranks", one.ranks}, {"bytes", one.bytes}});
  return {{"alone", {{"at_rest", scaling.alone_at_rest}, {"turning", scaling.alone_turning}}},
          {"rows", std::move(rows)},
          {"left_out", std::move(left_out)},
          {"stops_gaining", std::move(limits)}};
}

Html scaling_tab(const StrategyScaling& scaling) {
  // Of the network in the middle, as its parts show most.
  const std::string& shown = scaling.networks[(scaling.networks.size() - 1) / 2].name;
  const int measured =
      std::max_element(scaling.rows.begin(), scaling.rows.end(), [](const auto& a, const auto& b) {
        return (a.is_priced ? 0 : a.ranks) < (b.is_priced ? 0 : b.ranks);
      })->ranks;
  Html result = paragraph(fmt::format(
      "Every rank has a core of its own. One rank alone takes {} for a frame at rest and {} for "
      "one "
      "of a turntable, six degrees a frame (measured). Up to {} ranks drawing takes the processor "
      "time that it takes here; of more ranks triangles and samples are counted, at prices fitted "
      "to "
      "fewer ranks, and images are composited as masks. All messages are those of the strategies' "
      "own code. A strategy stops gaining at the fewest ranks that no others outdo by {:.0f} %.",
      time_text(scaling.alone_at_rest), time_text(scaling.alone_turning), measured,
      (kWorthwhile - 1) * 100));
  for (const NotScaled& one : scaling.left_out) {
    result +=
        paragraph(fmt::format("{} on {} ranks is left out: these would take {} of memory here.",
                              one.strategy, one.ranks, files::bytes_text(one.bytes)));
  }
  result += limits(scaling);
  for (const comm::NamedNetwork& named : scaling.networks) {
    result += heading(fmt::format("Over {}: {}", named.name, named.description));
    result += charts(scaling, named.name);
  }
  result += heading(fmt::format("Where the busiest rank's time goes, over {}", shown));
  result += paragraph(
      "The busiest rank works longest before its part of the picture is done. Waiting: for other "
      "ranks and for links. Gather: from then until rank 0 has the whole picture.");
  for (const Motion motion : kMotions) result += splits(scaling, shown, motion);
  return result + heading("All figures") + all_figures(scaling);
}

}  // namespace delray::apps
