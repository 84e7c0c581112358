#include "apps/report/stacked_bars.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "apps/report/axis.h"

namespace delray::apps::report {

Html stacked_bars(const StackedBars& chart) {
  constexpr double kWidth = 720, kNames = 190, kRight = 30, kTop = 8, kBottom = 44, kBar = 20;
  const auto sum_of = [](const StackedBar& bar) {
    return std::accumulate(bar.parts.begin(), bar.parts.end(), 0.0);
  };
  std::vector<double> values = {chart.shares ? 100.0 : 0.0};
  if (!chart.shares)
    for (const StackedBar& bar : chart.bars) values.push_back(sum_of(bar));
  const Axis axis(values, Scale::linear);
  const double room = kWidth - kNames - kRight;
  const auto at = [&](double value) { return kNames + axis.position(value) * room; };
  const double bottom = kTop + kBar * static_cast<double>(chart.bars.size());
  Html svg = fmt::format("<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">", kWidth,
                         bottom + kBottom, escaped(chart.title));
  for (const Tick& tick : axis.ticks())
    svg += fmt::format(
        "<line class=\"grid\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\"/>"
        "<text class=\"tick\" x=\"{0:.1f}\" y=\"{3}\" text-anchor=\"middle\">{4}</text>",
        at(tick.value), kTop, bottom, bottom + 16, escaped(tick.label));
  double y = kTop;
  for (const StackedBar& bar : chart.bars) {
    svg += fmt::format(
        "<text class=\"tick\" x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\" "
        "dominant-baseline=\"middle\">{}</text>",
        kNames - 6, y + kBar / 2, escaped(bar.name));
    const double sum = sum_of(bar), scale = sum > 0 ? 100 / sum : 0;
    double before = 0;
    for (std::size_t i = 0; i < bar.parts.size(); ++i) {
      const double part = bar.parts[i] * (chart.shares ? scale : 1);
      if (part > 0)
        svg += fmt::format(
            "<rect class=\"span c{}\" x=\"{:.2f}\" y=\"{:.1f}\" width=\"{:.2f}\" height=\"{}\">"
            "<title>{}: {} {} {}, {:.1f} % ({})</title></rect>",
            i % 8, at(before), y + 2, at(before + part) - at(before), kBar - 4, escaped(bar.name),
            escaped(chart.kinds[i]), short_number(bar.parts[i]), escaped(chart.unit),
            bar.parts[i] * scale, name_of(chart.source));
      before += part;
    }
    y += kBar;
  }
  svg += fmt::format(
      "<text class=\"axis\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text></svg>",
      kNames + room / 2, bottom + kBottom - 8, chart.shares ? "%" : escaped(chart.unit));
  Html legend;
  for (std::size_t i = 0; i < chart.kinds.size(); ++i)
    legend += fmt::format("<span class=\"key\"><i class=\"span c{}\"></i>{}</span>", i % 8,
                          escaped(chart.kinds[i]));
  return fmt::format(
      "<figure class=\"chart\"><figcaption>{} <span class=\"source\">{}</span></figcaption>{}"
      "<div class=\"legend\">{}</div></figure>\n",
      escaped(chart.title), name_of(chart.source), svg, legend);
}

}  // namespace delray::apps::report
