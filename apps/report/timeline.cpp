#include "apps/report/timeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "apps/report/axis.h"

namespace delray::apps::report {

Html timeline(const Timeline& timeline) {
  constexpr double kWidth = 960, kNames = 90, kRight = 12, kTop = 8, kBottom = 40, kLane = 18;
  double begin = std::numeric_limits<double>::infinity(), end = -begin;
  for (const Lane& lane : timeline.lanes)
    for (const Span& span : lane.spans) {
      begin = std::min(begin, span.begin);
      end = std::max(end, span.end);
    }
  if (!(end >= begin)) begin = end = 0;
  const std::vector<double> values = {0, (end - begin) * 1e3};
  const Axis axis(values, Scale::linear);
  const auto at = [&](double seconds) {
    return kNames + axis.position((seconds - begin) * 1e3) * (kWidth - kNames - kRight);
  };
  const auto look = [&](int kind) {
    return kind == timeline.idle ? std::string("idle") : fmt::format("c{}", kind);
  };
  const double bottom = kTop + kLane * static_cast<double>(timeline.lanes.size());
  Html svg = fmt::format("<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">", kWidth,
                         bottom + kBottom, escaped(timeline.title));
  for (const Tick& tick : axis.ticks())
    svg += fmt::format(
        "<line class=\"grid\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\"/>"
        "<text class=\"tick\" x=\"{0:.1f}\" y=\"{3}\" text-anchor=\"middle\">{4}</text>",
        at(begin + tick.value / 1e3), kTop, bottom, bottom + 16, escaped(tick.label));
  double y = kTop;
  for (const Lane& lane : timeline.lanes) {
    svg += fmt::format(
        "<text class=\"tick\" x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\" "
        "dominant-baseline=\"middle\">{}</text>",
        kNames - 6, y + kLane / 2, escaped(lane.name));
    for (const Span& span : lane.spans)
      svg += fmt::format(
          "<rect class=\"span {}\" x=\"{:.2f}\" y=\"{:.1f}\" width=\"{:.2f}\" height=\"{}\">"
          "<title>{}: {} {} ms ({}){}</title></rect>",
          look(span.kind), at(span.begin), y + 2, std::max(0.3, at(span.end) - at(span.begin)),
          kLane - 4, escaped(lane.name),
          escaped(timeline.kinds[static_cast<std::size_t>(span.kind)]),
          short_number((span.end - span.begin) * 1e3), name_of(timeline.source),
          span.note.empty() ? "" : "; " + escaped(span.note));
    y += kLane;
  }
  svg += fmt::format(
      "<text class=\"axis\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">time, ms</text></svg>",
      (kNames + kWidth) / 2, bottom + kBottom - 8);
  Html legend;
  for (std::size_t i = 0; i < timeline.kinds.size(); ++i)
    legend += fmt::format("<span class=\"key\"><i class=\"span {}\"></i>{}</span>",
                          look(static_cast<int>(i)), escaped(timeline.kinds[i]));
  return fmt::format(
      "<figure class=\"timeline\"><figcaption>{} <span class=\"source\">{}</span></figcaption>{}"
      "<div class=\"legend\">{}</div></figure>\n",
      escaped(timeline.title), name_of(timeline.source), svg, legend);
}

}  // namespace delray::apps::report
