// A Gantt chart of what each rank or thread did when.
#include "apps/report/timeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "apps/report/axis.h"
#include "apps/report/plot.h"

namespace delray::apps::report {

Html timeline(const Timeline& timeline) {
  constexpr double kLane = 18;
  double begin = std::numeric_limits<double>::infinity(), end = -begin;
  for (const Lane& lane : timeline.lanes) {
    for (const Span& span : lane.spans) {
      begin = std::min(begin, span.begin);
      end = std::max(end, span.end);
    }
  }
  if (!(end >= begin)) begin = end = 0;
  const std::vector<double> values = {0, (end - begin) * 1e3};
  const Axis axis(values, Scale::linear);
  const auto position = [&](double milliseconds) { return axis.position(milliseconds); };
  const auto at = [&](double seconds) { return position((seconds - begin) * 1e3) * 100; };
  const auto look = [&](int kind) {
    return kind == timeline.idle ? std::string("idle") : fmt::format("c{}", kind);
  };
  internal::Margins margins;
  margins.right = 20;
  const double height = kLane * static_cast<double>(timeline.lanes.size());
  Html marks = internal::ticks_across(axis.ticks(), position, height, "time, ms");
  double y = 0;
  for (const Lane& lane : timeline.lanes) {
    margins.left = std::max(margins.left, internal::text_width(lane.name) + 10);
    marks += fmt::format(
        "<text class=\"tick\" x=\"-6\" y=\"{:.1f}\" text-anchor=\"end\" "
        "dominant-baseline=\"middle\">{}</text>",
        y + kLane / 2, escaped(lane.name));
    for (const Span& span : lane.spans) {
      marks += fmt::format(
          "<rect class=\"span {}\" x=\"{:.3f}%\" y=\"{:.1f}\" width=\"{:.3f}%\" height=\"{}\">"
          "<title>{}: {} {} ms ({}){}</title></rect>",
          look(span.kind), at(span.begin), y + 2, std::max(0.03, at(span.end) - at(span.begin)),
          kLane - 4, escaped(lane.name),
          escaped(timeline.kinds[static_cast<std::size_t>(span.kind)]),
          short_number((span.end - span.begin) * 1e3), name_of(timeline.source),
          span.note.empty() ? "" : "; " + escaped(span.note));
    }
    y += kLane;
  }
  std::vector<internal::Key> keys;
  for (std::size_t i = 0; i < timeline.kinds.size(); ++i) {
    keys.push_back({look(static_cast<int>(i)), timeline.kinds[i]});
  }
  return internal::figure("timeline", timeline.title, timeline.source,
                          internal::plot(timeline.title, margins, height, marks), keys);
}

}  // namespace delray::apps::report
