// A chart for each method, with a line for each input.
#include "apps/compare/triangulate/inputs_report.h"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "apps/compare/triangulate/triangulate_figures.h"
#include "apps/compare/triangulate/triangulate_report.h"
#include "apps/compare/triangulate/triangulate_rows.h"
#include "apps/report/chart.h"
#include "apps/report/series.h"
#include "delaunay/methods.h"
#include "parallel/speed_up.h"

namespace delray::apps {
namespace {

using namespace report;
using Row = ComparedTriangulation;

std::string input_name(const ComparedInput& input) {
  return std::filesystem::path(input.request.input.path).filename().string();
}

// Speed-up over one thread of the same method, or that over threads, of the most points of an
// input.
Series series_of(const ComparedInput& input, const std::string& method, bool per_thread) {
  Series series{input_name(input), Source::measured, {}, {}};
  const ComparedTriangulations& rows = input.comparison.rows;
  for (const Row& row : rows) {
    if (row.points != most_points(rows) || row.how.method != method || !is_plain(row.how)) continue;
    const Row* base = base_of(rows, row);
    if (base == nullptr || !(row.seconds.median > 0)) continue;
    const double gain = parallel::speed_up(base->seconds.median, row.seconds.median);
    const double y = per_thread ? parallel::efficiency(gain, row.how.threads) : gain;
    series.points.push_back({static_cast<double>(row.how.threads), y, y, y});
  }
  return series;
}

Html chart_of(std::span<const ComparedInput> inputs, const std::string& method, bool per_thread) {
  LineChart chart;
  chart.title = method + (per_thread ? ", efficiency" : ", speed-up over one thread");
  chart.x_label = "threads";
  chart.y_label = per_thread ? "efficiency" : "speed-up";
  chart.x_scale = Scale::logarithmic;
  chart.ticks_at_points = true;
  chart.more_is_better = true;
  for (const ComparedInput& input : inputs) {
    Series series = series_of(input, method, per_thread);
    if (series.points.size() > 1) chart.series.push_back(std::move(series));
  }
  return chart.series.empty() ? Html() : line_chart(chart);
}

Html inputs_tab(std::span<const ComparedInput> inputs) {
  std::vector<Html> charts;
  for (const delaunay::Method& method : delaunay::methods()) {
    if (method.alone) continue;
    for (const bool per_thread : {false, true}) {
      Html chart = chart_of(inputs, std::string(method.name), per_thread);
      if (!chart.empty()) charts.push_back(std::move(chart));
    }
  }
  if (charts.empty()) return paragraph("One number of threads tells nothing about speed-up.");
  return in_columns(charts) +
         paragraph(
             "Of measured times of all points of each input. The other tabs are about the first "
             "one.");
}

}  // namespace

TextTable inputs_table(std::span<const ComparedInput> inputs) {
  if (inputs.size() == 1) return triangulate_table(inputs[0].comparison);
  TextTable all;
  for (const ComparedInput& input : inputs) {
    TextTable one = triangulate_table(input.comparison);
    for (std::size_t line = 0; line < one.size(); ++line) {
      if (line == 0 && !all.empty()) continue;
      one[line].insert(one[line].begin(), line == 0 ? "input" : input_name(input));
      all.push_back(std::move(one[line]));
    }
  }
  return all;
}

Json inputs_statistics(std::span<const ComparedInput> inputs) {
  Json result = triangulate_statistics(inputs[0].request, inputs[0].comparison);
  if (inputs.size() == 1) return result;
  Json each = Json::array();
  for (const ComparedInput& input : inputs) {
    each.push_back(triangulate_statistics(input.request, input.comparison));
  }
  result["inputs"] = std::move(each);
  return result;
}

report::Page inputs_page(const Session& session, std::span<const ComparedInput> inputs) {
  report::Page page =
      triangulate_page(session, inputs[0].request, inputs[0].comparison, inputs[0].simulated);
  if (inputs.size() == 1) return page;
  page.title += fmt::format(", and {} more inputs", inputs.size() - 1);
  page.tabs.insert(page.tabs.begin(), {"Inputs", inputs_tab(inputs)});
  page.data = inputs_statistics(inputs);
  for (const ComparedInput& input : inputs) {
    page.unfinished = page.unfinished || input.comparison.unfinished;
  }
  return page;
}

}  // namespace delray::apps
