// One function builds each tab of the page; regions are drawn over a picture that the page has
// once.
#include "apps/compare/partition/partition_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <numeric>

#include "apps/compare/partition/partition_answer.h"
#include "apps/compare/partition/partition_figures.h"
#include "apps/compare/partition/scaling_figures.h"
#include "apps/compare/variant_looks.h"
#include "apps/compare/verdict.h"
#include "apps/provenance.h"
#include "apps/report/bar_chart.h"
#include "apps/report/chart.h"
#include "apps/report/overlay.h"
#include "apps/report/page.h"
#include "apps/report/series.h"
#include "apps/report/table.h"
#include "comm/network.h"

namespace delray::apps {
namespace {

using namespace report;
using PartitionRows = std::vector<ComparedPartition>;

constexpr const char* kPicture = "picture";

ChartPoint point(double x, double y) { return {x, y, y, y}; }
ChartPoint point(double x, const Spread& spread, double unit) {
  return {x, spread.median * unit, spread.low * unit, spread.high * unit};
}

using PartitionPoint = std::function<std::optional<ChartPoint>(const ComparedPartition&)>;

Html chart(const PartitionRows& rows, const std::string& title, const std::string& x,
           const std::string& y, Source source, Scale scale, const PartitionPoint& of) {
  LineChart chart;
  chart.title = title;
  chart.x_label = x;
  chart.y_label = y;
  chart.x_scale = Scale::logarithmic;
  chart.y_scale = scale;
  chart.ticks_at_points = true;
  chart.series = series_by(
      rows, [](const ComparedPartition& row) { return row.partition; },
      [](const std::string& name) { return look_of(Family::partition, name); }, source, of);
  return chart.series.empty() ? Html() : line_chart(chart);
}

double ranks_of(const ComparedPartition& row) { return static_cast<double>(row.ranks); }

// Points at x(row).
template <class X>
PartitionPoint work_imbalance(X x) {
  return [x](const ComparedPartition& row) -> std::optional<ChartPoint> {
    if (!row.drawn) return std::nullopt;
    return point(x(row), row.drawn->work_imbalance);
  };
}
template <class X>
PartitionPoint predicted_imbalance(X x) {
  return [x](const ComparedPartition& row) -> std::optional<ChartPoint> {
    return point(x(row), row.predicted_imbalance);
  };
}
template <class X>
PartitionPoint time_imbalance(X x) {
  return [x](const ComparedPartition& row) -> std::optional<ChartPoint> {
    if (!row.drawn) return std::nullopt;
    return point(x(row), row.drawn->imbalance, 1);
  };
}

Html balance(const PartitionRequest& request, const PartitionComparison& comparison) {
  const PartitionRows rows = with_regions(comparison.rows, request.regions.front());
  const auto x_ranks = ranks_of;
  Html result = in_columns(
      {chart(rows, "How even the ranks' work is", "ranks", "most work over mean", Source::counted,
             Scale::logarithmic, work_imbalance(x_ranks)),
       chart(rows, "The same as the costs foretell it", "ranks", "largest load over mean",
             Source::predicted, Scale::logarithmic, predicted_imbalance(x_ranks)),
       chart(rows, "The same in processor time", "ranks", "busiest rank over mean",
             Source::measured, Scale::logarithmic, time_imbalance(x_ranks)),
       chart(rows, "Processor time of the busiest rank", "ranks", "time, ms", Source::measured,
             Scale::logarithmic,
             [](const ComparedPartition& row) -> std::optional<ChartPoint> {
               if (!row.drawn) return std::nullopt;
               return point(ranks_of(row), row.drawn->busiest, 1e3);
             }),
       chart(rows, "What is lost: unevenness and work that several ranks do", "ranks",
             "most work over an equal share of one alone", Source::counted, Scale::logarithmic,
             [](const ComparedPartition& row) -> std::optional<ChartPoint> {
               if (!row.drawn) return std::nullopt;
               return point(ranks_of(row), row.drawn->work_over_share);
             })});
  if (request.regions.size() > 1) {
    const int ranks = shown_ranks(request);
    PartitionRows shown;
    std::copy_if(comparison.rows.begin(), comparison.rows.end(), std::back_inserter(shown),
                 [&](const ComparedPartition& row) { return row.ranks == ranks; });
    std::stable_sort(shown.begin(), shown.end(), [](const auto& a, const auto& b) {
      return a.regions_per_rank < b.regions_per_rank;
    });
    const auto x = [](const ComparedPartition& row) {
      return static_cast<double>(row.regions_per_rank);
    };
    const std::string label = "regions for each rank";
    result += heading(fmt::format("More regions than ranks, with {} ranks", ranks));
    result += in_columns(
        {chart(shown, "How even the ranks' work is", label, "most work over mean", Source::counted,
               Scale::logarithmic, work_imbalance(x)),
         chart(shown, "The same as the costs foretell it", label, "largest load over mean",
               Source::predicted, Scale::logarithmic, predicted_imbalance(x)),
         chart(shown, "The same in processor time", label, "busiest rank over mean",
               Source::measured, Scale::logarithmic, time_imbalance(x)),
         chart(shown, "Ranks that get a primitive", label, "ranks, on average", Source::counted,
               Scale::linear, [&](const ComparedPartition& row) -> std::optional<ChartPoint> {
                 return point(x(row), row.overlap);
               })});
  }
  return result +
         paragraph(
             "Counted: a rank's work is the triangles that it rasterizes and the samples that it "
             "shades, a triangle at the price of two samples. Measured: processor time of "
             "sort-first's ranks, which take turns on one core and its caches; medians, the "
             "upright lines are the intervals in which they lie with 95 %, of fewer than six "
             "frames all of their spread; "
             "where a frame takes a rank less than a "
             "millisecond, what each rank does once weighs more than its share. Predicted: from "
             "the "
             "boxes of groups of primitives and the pixels that they cover, before anything is "
             "drawn.");
}

Html shown_partition(const PartitionRequest& request, const ShownPartition& shown) {
  const auto mean_of = [](const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  };
  const double mean = mean_of(shown.work), predicted_mean = mean_of(shown.predicted);
  const auto over_mean = [](double value, double of) { return of > 0 ? value / of : 1.0; };
  const auto share_text = [&](std::size_t rank) {
    return fmt::format(
        "{:.2f} of the mean, predicted {:.2f}; measured {}", over_mean(shown.work[rank], mean),
        over_mean(shown.predicted[rank], predicted_mean), time_text(shown.busy[rank]));
  };
  Overlay drawn;
  drawn.title = shown.name;
  drawn.source = Source::counted;
  drawn.width = request.render.width;
  drawn.height = request.render.height;
  for (const loadbalance::Region& region : shown.partition.regions) {
    const auto rank = static_cast<std::size_t>(region.owner);
    drawn.areas.push_back({region.rect, region.owner, over_mean(shown.work[rank], mean),
                           fmt::format("rank {}: {}", region.owner, share_text(rank))});
  }
  BarChart bars;
  bars.title = shown.name + ", by rank";
  bars.label = "work, samples' worth";
  bars.source = Source::counted;
  bars.mark = mean;
  const auto busiest = std::max_element(shown.work.begin(), shown.work.end());
  for (std::size_t rank = 0; rank < shown.work.size(); ++rank) {
    bars.bars.push_back({fmt::format("rank {}", rank), shown.work[rank], share_text(rank),
                         shown.work.begin() + static_cast<std::ptrdiff_t>(rank) == busiest});
  }
  return "<div>" + overlay(drawn, kPicture) + bar_chart(bars) + "</div>";
}

Html regions(const PartitionRequest& request, const PartitionComparison& comparison) {
  Html result = paragraph(fmt::format(
      "Each partition of {} ranks over the picture, and the ranks' loads; the broken line is their "
      "mean.",
      shown_ranks(request)));
  result += overlay_key("less than the mean", "even", "more than the mean, at twice it in full");
  std::vector<Html> shown;
  for (const ShownPartition& one : comparison.shown) shown.push_back(shown_partition(request, one));
  return result + in_columns(shown);
}

Html price(const PartitionRequest& request, const PartitionComparison& comparison) {
  const PartitionRows rows = with_regions(comparison.rows, request.regions.front());
  const auto bytes = [](std::uint64_t DrawnFrames::*amount) {
    return [amount](const ComparedPartition& row) -> std::optional<ChartPoint> {
      if (!row.drawn) return std::nullopt;
      return point(ranks_of(row), static_cast<double>(*row.drawn.*amount) / 1e6);
    };
  };
  const Html result =
      in_columns({chart(rows, "Overlap: ranks that get a primitive", "ranks", "ranks, on average",
                        Source::counted, Scale::linear,
                        [](const ComparedPartition& row) -> std::optional<ChartPoint> {
                          return point(ranks_of(row), row.overlap);
                        }),
                  chart(rows, "Own time: what cutting takes", "ranks", "time, ms", Source::measured,
                        Scale::logarithmic,
                        [](const ComparedPartition& row) -> std::optional<ChartPoint> {
                          return point(ranks_of(row), row.cut_seconds, 1e3);
                        }),
                  chart(rows, "Bytes that ranks send for the first frame", "ranks", "MB",
                        Source::counted, Scale::linear, bytes(&DrawnFrames::bytes_total)),
                  chart(rows, "Bytes that ranks send for a frame after it", "ranks", "MB",
                        Source::counted, Scale::linear, bytes(&DrawnFrames::bytes_next))});
  return result +
         paragraph(
             "Primitives are sent in groups; a group goes to every rank whose region its box "
             "touches. For the first frame they travel, later only what a rank does not have; the "
             "picture goes to rank 0 every time.");
}

Html strategies(const PartitionComparison& comparison) {
  const std::vector<ComparedStrategy>& all = comparison.strategies;
  const auto lines = [&](const std::string& title, const std::string& label, Source source,
                         auto&& of) {
    return logarithmic_chart(
        title, "ranks", label,
        series_by(
            all, [](const ComparedStrategy& row) { return row.strategy; },
            [](const std::string& name) { return look_of(Family::strategy, name); }, source,
            [&](const ComparedStrategy& row) -> std::optional<ChartPoint> { return of(row); }));
  };
  const auto x = [](const ComparedStrategy& row) { return static_cast<double>(row.ranks); };
  if (all.empty()) return paragraph("No strategy was run.");
  Html result = paragraph(
      fmt::format("Sort-first and sort-middle with the partition {}, sort-last composited by "
                  "binary-swap with the codec active.",
                  comparison.rows.front().partition));
  for (const comm::NamedNetwork& named : comparison.networks) {
    result += heading(fmt::format("Over {}: {}", named.name, named.description));
    result += in_columns(
        {lines("A frame after the first", "time, ms", Source::predicted,
               [&](const ComparedStrategy& row) {
                 return point(x(row), prediction(row.drawn, named.name)->spread, 1e3);
               }),
         lines("The first frame: primitives travel", "time, ms", Source::predicted,
               [&](const ComparedStrategy& row) {
                 return point(x(row), prediction(row.drawn, named.name)->first_seconds * 1e3);
               })});
  }
  result += heading("What goes into it");
  result += in_columns(
      {lines("Busiest rank", "processor time, ms", Source::measured,
             [&](const ComparedStrategy& row) { return point(x(row), row.drawn.busiest, 1e3); }),
       lines("Bytes that ranks send for a frame after the first", "MB", Source::counted,
             [&](const ComparedStrategy& row) {
               return point(x(row), static_cast<double>(row.drawn.bytes_next) / 1e6);
             })});
  return result +
         paragraph(
             "Predicted: the ranks run the renderer's own code in turn, in the processor time that "
             "it takes here, and their messages pass a simulated network of a machine that has a "
             "core for each rank.");
}

Html wall(const PartitionRequest& request, const PartitionComparison& comparison) {
  const PartitionRows rows = with_regions(comparison.rows, request.regions.front());
  Table others;
  others.columns = {{"ranks", true, true, Source::counted},
                    {"gathered on rank 0, pixels", true, true, Source::counted},
                    {"drawn at home: over share", true, true, Source::predicted},
                    {"drawn at home: overlap", true, true, Source::predicted}};
  for (const ComparedWall& row : comparison.walls) {
    others.rows.push_back({std::to_string(row.ranks), std::to_string(row.gathered),
                           fmt::format("{:.2f}", row.predicted_over_share),
                           fmt::format("{:.2f}", row.overlap)});
  }
  return chart(rows, "Pixels that the busiest rank sends and receives", "ranks", "pixels",
               Source::counted, Scale::logarithmic,
               [](const ComparedPartition& row) -> std::optional<ChartPoint> {
                 return point(ranks_of(row), static_cast<double>(row.to_displays->busiest));
               }) +
         table(others) +
         paragraph(
             "Regions are finer than displays and drawn wherever the partition says; each pixel "
             "then "
             "goes to the rank that shows it. Beside them: all pixels gathered on rank 0, and each "
             "display drawn by the rank that shows it, where no pixel travels and the work is as "
             "uneven as the scene.");
}

Html all_rows(const PartitionRequest& request, const PartitionRows& rows) {
  const TextTable text = partition_table(rows);
  Table result;
  for (std::size_t i = 0; i < text[0].size(); ++i) {
    std::string name = text[0][i];
    Source source =
        name.ends_with(" ms") || name == "time max/mean" ? Source::measured : Source::counted;
    if (name.ends_with("predicted")) {
      source = Source::predicted;
      name = name.substr(0, name.find(','));
    }
    result.columns.push_back({name, i != 2, i > 2, source});
  }
  result.rows.assign(text.begin() + 1, text.end());
  return table(result) +
         paragraph(
             "Primitives in the frame; those that fall to several ranks are shared. Triangles and "
             "samples are of the rank that has most. Over share: the largest load over an equal "
             "share of what one rank alone would do. Size " +
             request.render.size + ".");
}

}  // namespace

std::string partition_report(const Session& session, const PartitionRequest& request,
                             const Prepared& prepared, const PartitionComparison& comparison) {
  Page result;
  const std::filesystem::path file(request.render.scene.file.path);
  result.title = fmt::format("Partitions of the screen for {}, {}", file.filename().string(),
                             request.render.size);
  result.unfinished = comparison.unfinished;
  result.machine = machine_and_compiler();
  result.answer = backdrop(comparison.picture, kPicture) + partition_answer(comparison);
  result.tabs.push_back({"Balance", balance(request, comparison)});
  if (!comparison.shown.empty()) result.tabs.push_back({"Regions", regions(request, comparison)});
  result.tabs.push_back({"Overlap and cutting", price(request, comparison)});
  if (!comparison.walls.empty()) result.tabs.push_back({"Wall", wall(request, comparison)});
  result.tabs.push_back({"Strategies", strategies(comparison)});
  if (!comparison.scaling.rows.empty())
    result.tabs.push_back({"Beyond this machine", scaling_tab(comparison.scaling)});
  result.tabs.push_back({"All figures", all_rows(request, comparison.rows)});
  result.data = partition_statistics(request, prepared, comparison);
  result.provenance = provenance(session, request.render.scene.file.path);
  return page(result);
}

}  // namespace delray::apps
