// Line charts: axes, lines in the look of their variants, names at their ends.
#include "apps/report/chart.h"

#include <fmt/format.h>
#include <utility>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "apps/report/plot.h"

namespace delray::apps::report {
namespace {

constexpr double kHeight = 280;
constexpr double kTop = 26, kBottom = 40;
constexpr double kBetweenNames = 15;
constexpr std::size_t kMostTicksAtPoints = 12;

Look look_of(const LineChart& chart, std::size_t i) {
  Look look = chart.series[i].look;
  if (look.colour < 0) {
    look.colour = static_cast<int>(i);
    look.mark = static_cast<int>(i) / kLookColours;
  }
  return look;
}
std::string classes_of(const Look& look) {
  return fmt::format("c{} d{}", look.colour % kLookColours,
                     look.dash == 0 ? 0 : 1 + (look.dash - 1) % kLookDashes);
}
// Series of the same group have the same.
std::string group_of(const LineChart& chart, std::size_t i) {
  const Look look = look_of(chart, i);
  return look.group.empty() ? fmt::format("{}/{}", look.colour, chart.series[i].name) : look.group;
}

class LinePlot {
 public:
  explicit LinePlot(const LineChart& chart)
      : chart_(chart),
        strong_(strong_series(chart)),
        xs_(values(chart, [](const ChartPoint& p) { return std::vector{p.x}; })),
        x_(xs_, chart.x_scale),
        y_(values(chart,
                  [](const ChartPoint& p) {
                    return std::vector{p.y, p.low, p.high};
                  }),
           chart.y_scale) {}

  Html html() const {
    internal::Margins margins;
    margins.top = kTop;
    margins.bottom = kBottom;
    const std::vector<Tick> ticks = y_.ticks();
    for (const Tick& tick : ticks)
      margins.left = std::max(margins.left, internal::text_width(tick.label) + 10);
    for (std::size_t i = 0; i < chart_.series.size(); ++i) {
      if (strong_[i])
        margins.right = std::max(margins.right, internal::text_width(chart_.series[i].name) + 12);
    }
    margins.right = std::max(margins.right, 24.0);
    Html lines;
    const std::vector<double> names = name_positions();
    // Strong ones above the others.
    for (const bool strong : {false, true}) {
      for (std::size_t i = 0; i < chart_.series.size(); ++i)
        if (strong_[i] == strong) lines += line(i, names[i]);
    }
    if (lines.empty()) {
      lines = fmt::format(
          "<text class=\"axis\" x=\"50%\" y=\"{:.0f}\" text-anchor=\"middle\">nothing but "
          "zeros</text>",
          kHeight / 2);
    }
    return internal::plot(chart_.title, margins, kHeight, grid(ticks, margins.left) + lines);
  }

  // The names of all series, by groups.
  Html legend(bool with_sources) const {
    std::map<std::string, std::vector<std::size_t>> members;
    std::vector<std::string> groups;
    for (std::size_t i = 0; i < chart_.series.size(); ++i) {
      const std::string group = group_of(chart_, i);
      if (members[group].empty()) groups.push_back(group);
      members[group].push_back(i);
    }
    Html result;
    for (const std::string& group : groups) {
      result += "<span class=\"group\">";
      for (const std::size_t i : members[group]) result += key(i, with_sources);
      result += "</span>";
    }
    return result;
  }

 private:
  template <class F>
  static std::vector<double> values(const LineChart& chart, F&& of_point) {
    std::vector<double> result;
    for (const Series& series : chart.series) {
      for (const ChartPoint& p : series.points)
        for (const double v : of_point(p)) result.push_back(v);
    }
    return result;
  }

  // Per cent of the width, and pixels from the top.
  double at_x(double value) const { return x_.position(value) * 100; }
  double at_y(double value) const { return (1 - y_.position(value)) * kHeight; }
  bool is_shown(double x, double y) const {
    return std::isfinite(x) && std::isfinite(y) && (chart_.x_scale == Scale::linear || x > 0) &&
           (chart_.y_scale == Scale::linear || y > 0);
  }
  std::optional<ChartPoint> last_shown(const Series& series) const {
    std::optional<ChartPoint> last;
    for (const ChartPoint& p : series.points)
      if (is_shown(p.x, p.y)) last = p;
    return last;
  }

  Html grid(const std::vector<Tick>& y_ticks, double left) const {
    Html result;
    for (const Tick& tick : y_ticks) {
      result += fmt::format(
          "<line class=\"grid\" x2=\"100%\" y1=\"{0:.1f}\" y2=\"{0:.1f}\"/><text class=\"tick\" "
          "x=\"-6\" y=\"{0:.1f}\" text-anchor=\"end\" dominant-baseline=\"middle\">{1}</text>",
          at_y(tick.value), escaped(tick.label));
    }
    std::vector<Tick> ticks = Axis::ticks_at(xs_);
    if (!chart_.ticks_at_points || ticks.size() > kMostTicksAtPoints) ticks = x_.ticks();
    result += internal::ticks_across(
        ticks, [this](double value) { return x_.position(value); }, kHeight, chart_.x_label);
    return result + fmt::format("<text class=\"axis\" x=\"{:.0f}\" y=\"-12\">{}</text>", -left,
                                escaped(chart_.y_label));
  }

  // Where the names of strong series stand, in pixels from the top; of the others where they end.
  std::vector<double> name_positions() const {
    std::vector<double> result(chart_.series.size());
    std::map<double, std::vector<std::size_t>> strong_at;  // by where they end
    for (std::size_t i = 0; i < result.size(); ++i) {
      const auto last = last_shown(chart_.series[i]);
      if (!last) continue;
      result[i] = at_y(last->y);
      if (strong_[i]) strong_at[last->x].push_back(i);
    }
    for (const auto& [x, series] : strong_at) {
      std::vector<double> positions;
      for (const std::size_t i : series) positions.push_back(result[i]);
      internal::move_apart(positions, kBetweenNames, 0, kHeight);
      for (std::size_t k = 0; k < series.size(); ++k) result[series[k]] = positions[k];
    }
    return result;
  }

  Html point(const Series& series, const ChartPoint& p, int mark, bool strong) const {
    const std::string spread =
        p.high > p.low ? fmt::format(", {} to {}", short_number(p.low), short_number(p.high))
                       : std::string();
    return fmt::format(
        "<use class=\"point\" href=\"#m{}\" x=\"{:.2f}%\" y=\"{:.1f}\"{}><title>{}: {} {}, {} {} "
        "({}{})</title></use>",
        mark % kLookMarks, at_x(p.x), at_y(p.y), strong ? " tabindex=\"0\"" : "",
        escaped(series.name), escaped(chart_.x_label), short_number(p.x), escaped(chart_.y_label),
        short_number(p.y), name_of(series.source), spread);
  }

  Html line(std::size_t i, double name_position) const {
    const Series& series = chart_.series[i];
    const Look look = look_of(chart_, i);
    std::string path;
    Html spreads, points;
    for (const ChartPoint& p : series.points) {
      if (!is_shown(p.x, p.y)) continue;
      path += fmt::format("{}{:.2f} {:.1f}", path.empty() ? "M" : "L", at_x(p.x), at_y(p.y));
      if (p.high > p.low && is_shown(p.x, p.low)) {
        spreads += fmt::format(
            "<line class=\"spread\" x1=\"{0:.2f}%\" x2=\"{0:.2f}%\" y1=\"{1:.1f}\" "
            "y2=\"{2:.1f}\"/>",
            at_x(p.x), at_y(p.low), at_y(p.high));
      }
      points += point(series, p, look.mark, strong_[i]);
    }
    if (path.empty()) return "";
    const ChartPoint last = *last_shown(series);
    return fmt::format(
        "<g class=\"series {0}{1}{2}\" data-name=\"{3}\"><svg viewBox=\"0 0 100 {4:.0f}\" "
        "width=\"100%\" height=\"{4:.0f}\" preserveAspectRatio=\"none\"><path class=\"hit\" "
        "d=\"{5}\"/><path class=\"line\" d=\"{5}\"/></svg>{6}{7}<text class=\"name\" "
        "x=\"{8:.2f}%\" dx=\"9\" y=\"{9:.1f}\" data-y=\"{10:.1f}\" "
        "dominant-baseline=\"middle\">{3}</text></g>",
        classes_of(look), strong_[i] ? "" : " weak",
        series.source == Source::predicted ? " predicted" : "", escaped(series.name), kHeight, path,
        spreads, points, at_x(last.x), name_position, at_y(last.y));
  }

  Html key(std::size_t i, bool with_source) const {
    const Series& series = chart_.series[i];
    const Look look = look_of(chart_, i);
    return fmt::format(
        "<button type=\"button\" class=\"key {0}{1}{2}\" data-name=\"{3}\" "
        "aria-pressed=\"false\"><svg viewBox=\"0 0 24 10\"><path class=\"line\" d=\"M0 "
        "5H24\"/><use class=\"point\" href=\"#m{4}\" x=\"12\" y=\"5\"/></svg>{3}{5}</button>",
        classes_of(look), strong_[i] ? "" : " weak",
        series.source == Source::predicted ? " predicted" : "", escaped(series.name),
        look.mark % kLookMarks,
        with_source ? fmt::format(" <span class=\"source\">{}</span>", name_of(series.source))
                    : "");
  }

  const LineChart& chart_;
  std::vector<bool> strong_;
  std::vector<double> xs_;
  Axis x_, y_;
};

// The number of times each series is the best of its group at one of the chart's x.
std::vector<int> times_best(const LineChart& chart) {
  std::map<std::pair<std::string, double>, std::pair<double, std::size_t>> best;
  for (std::size_t i = 0; i < chart.series.size(); ++i) {
    for (const ChartPoint& p : chart.series[i].points) {
      if (!std::isfinite(p.y)) continue;
      const double y = chart.more_is_better ? -p.y : p.y;
      const auto [at, is_new] = best.try_emplace({group_of(chart, i), p.x}, y, i);
      if (!is_new && y < at->second.first) at->second = {y, i};
    }
  }
  std::vector<int> result(chart.series.size());
  for (const auto& [where, value] : best) ++result[value.second];
  return result;
}

}  // namespace

std::vector<bool> strong_series(const LineChart& chart) {
  std::vector<bool> result(chart.series.size(), chart.series.size() <= kMostStrong);
  if (chart.series.size() <= kMostStrong) return result;
  const std::vector<int> times = times_best(chart);
  std::map<std::string, std::size_t> most;  // of each group
  for (std::size_t i = 0; i < result.size(); ++i) {
    const auto [at, is_new] = most.try_emplace(group_of(chart, i), i);
    if (!is_new && times[i] > times[at->second]) at->second = i;
  }
  for (const auto& [group, i] : most) result[i] = true;
  return result;
}

Html line_chart(const LineChart& chart) {
  const bool mixed =
      std::any_of(chart.series.begin(), chart.series.end(),
                  [&](const Series& series) { return series.source != chart.series[0].source; });
  const LinePlot plot(chart);
  return fmt::format(
      "<figure class=\"chart\"><figcaption>{}{}</figcaption>{}<div class=\"legend\">{}</div>"
      "</figure>\n",
      escaped(chart.title),
      mixed || chart.series.empty()
          ? ""
          : fmt::format(" <span class=\"source\">{}</span>", name_of(chart.series[0].source)),
      plot.html(), plot.legend(mixed));
}

Html logarithmic_chart(const std::string& title, const std::string& x_label,
                       const std::string& y_label, std::vector<Series> series) {
  LineChart chart;
  chart.title = title;
  chart.x_label = x_label;
  chart.y_label = y_label;
  chart.x_scale = chart.y_scale = Scale::logarithmic;
  chart.ticks_at_points = true;
  chart.series = std::move(series);
  return line_chart(chart);
}

}  // namespace delray::apps::report
