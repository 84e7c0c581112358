// Bar charts: names at the left, amounts at the ends of bars.
#include "apps/report/bar_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/report/axis.h"
#include "apps/report/plot.h"

namespace delray::apps::report {

Html bar_chart(const BarChart& chart) {
  constexpr double kBar = 18, kValue = 64;
  internal::Margins margins;
  margins.right = kValue;
  std::vector<double> values = {chart.mark};
  for (const Bar& bar : chart.bars) {
    values.push_back(bar.value);
    margins.left = std::max(margins.left, internal::text_width(bar.name) + 10);
  }
  const Axis axis(values, Scale::linear);
  const auto position = [&](double value) { return axis.position(value); };
  const double height = kBar * static_cast<double>(chart.bars.size());
  Html marks = internal::ticks_across(axis.ticks(), position, height, chart.label);
  Html amounts;  // above the mark, or it would cross them out
  double y = 0;
  for (const Bar& bar : chart.bars) {
    const double value = std::isfinite(bar.value) ? std::max(bar.value, 0.0) : 0.0;
    const double end = position(value) * 100;
    marks += fmt::format(
        "<text class=\"tick\" x=\"-6\" y=\"{0:.1f}\" text-anchor=\"end\" "
        "dominant-baseline=\"middle\">{1}</text>"
        "<rect class=\"bar{2}\" y=\"{3:.1f}\" width=\"{4:.2f}%\" height=\"{5}\" tabindex=\"0\">"
        "<title>{1}: {6} {7} ({8}){9}</title></rect>",
        y + kBar / 2, escaped(bar.name), bar.emphasised ? " emphasised" : "", y + 2, end, kBar - 4,
        short_number(bar.value), escaped(chart.label), name_of(chart.source),
        bar.note.empty() ? "" : "; " + escaped(bar.note));
    amounts += fmt::format(
        "<text class=\"tick value\" x=\"{:.2f}%\" dx=\"4\" y=\"{:.1f}\" "
        "dominant-baseline=\"middle\">{}</text>",
        end, y + kBar / 2, short_number(bar.value));
    y += kBar;
  }
  if (chart.mark > 0) {
    marks += fmt::format("<line class=\"mark\" x1=\"{0:.2f}%\" x2=\"{0:.2f}%\" y2=\"{1:.1f}\"/>",
                         position(chart.mark) * 100, height);
  }
  return fmt::format(
      "<figure class=\"chart\"><figcaption>{} <span class=\"source\">{}</span></figcaption>{}"
      "</figure>\n",
      escaped(chart.title), name_of(chart.source),
      internal::plot(chart.title, margins, height, marks + amounts));
}

}  // namespace delray::apps::report
