// Bars of parts, one below the other.
#include "apps/report/stacked_bars.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "apps/report/axis.h"
#include "apps/report/plot.h"

namespace delray::apps::report {

Html stacked_bars(const StackedBars& chart) {
  constexpr double kBar = 20;
  const auto sum_of = [](const StackedBar& bar) {
    return std::accumulate(bar.parts.begin(), bar.parts.end(), 0.0);
  };
  internal::Margins margins;
  margins.right = 20;
  std::vector<double> values = {chart.shares ? 100.0 : 0.0};
  for (const StackedBar& bar : chart.bars) {
    if (!chart.shares) values.push_back(sum_of(bar));
    margins.left = std::max(margins.left, internal::text_width(bar.name) + 10);
  }
  const Axis axis(values, Scale::linear);
  const auto position = [&](double value) { return axis.position(value); };
  const double height = kBar * static_cast<double>(chart.bars.size());
  Html marks =
      internal::ticks_across(axis.ticks(), position, height, chart.shares ? "%" : chart.unit);
  double y = 0;
  for (const StackedBar& bar : chart.bars) {
    marks += fmt::format(
        "<text class=\"tick\" x=\"-6\" y=\"{:.1f}\" text-anchor=\"end\" "
        "dominant-baseline=\"middle\">{}</text>",
        y + kBar / 2, escaped(bar.name));
    const double sum = sum_of(bar), scale = sum > 0 ? 100 / sum : 0;
    double before = 0;
    for (std::size_t i = 0; i < bar.parts.size(); ++i) {
      const double part = bar.parts[i] * (chart.shares ? scale : 1);
      if (part > 0) {
        marks += fmt::format(
            "<rect class=\"span c{}\" x=\"{:.3f}%\" y=\"{:.1f}\" width=\"{:.3f}%\" height=\"{}\">"
            "<title>{}: {} {} {}, {:.1f} % ({})</title></rect>",
            i % 8, position(before) * 100, y + 2,
            (position(before + part) - position(before)) * 100, kBar - 4, escaped(bar.name),
            escaped(chart.kinds[i]), short_number(bar.parts[i]), escaped(chart.unit),
            bar.parts[i] * scale, name_of(chart.source));
      }
      before += part;
    }
    y += kBar;
  }
  std::vector<internal::Key> keys;
  for (std::size_t i = 0; i < chart.kinds.size(); ++i) {
    keys.push_back({fmt::format("c{}", i % 8), chart.kinds[i]});
  }
  return internal::figure("chart", chart.title, chart.source,
                          internal::plot(chart.title, margins, height, marks), keys);
}

}  // namespace delray::apps::report
