#include "apps/report/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace delray::apps::report {
namespace {

constexpr double kWidth = 720, kHeight = 400;
constexpr double kLeft = 76, kRight = 30, kTop = 14, kBottom = 48;
constexpr std::size_t kColours = 8;  // more series are dashed
constexpr std::size_t kMostTicksAtPoints = 12;

struct Place {
  double x, y;
};

// Colour and dash of series i.
std::string look(const LineChart& chart, std::size_t i) {
  const int wanted = chart.series[i].look;
  const std::size_t k = wanted < 0 ? i : static_cast<std::size_t>(wanted);
  return fmt::format("c{} d{}", k % kColours, k / kColours % 3);
}

class LinePlot {
 public:
  explicit LinePlot(const LineChart& chart)
      : chart_(chart),
        xs_(values(chart, [](const ChartPoint& p) { return std::vector{p.x}; })),
        x_(xs_, chart.x_scale),
        y_(values(chart,
                  [](const ChartPoint& p) {
                    return std::vector{p.y, p.low, p.high};
                  }),
           chart.y_scale) {}

  Html svg() const {
    Html result = fmt::format("<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">", kWidth,
                              kHeight, escaped(chart_.title));
    result += grid();
    Html lines;
    for (std::size_t i = 0; i < chart_.series.size(); ++i) lines += line(i);
    if (lines.empty())
      lines = fmt::format(
          "<text class=\"axis\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">nothing but "
          "zeros</text>",
          (kLeft + kWidth - kRight) / 2, (kTop + kHeight - kBottom) / 2);
    return result + lines + "</svg>";
  }

 private:
  template <class F>
  static std::vector<double> values(const LineChart& chart, F&& of_point) {
    std::vector<double> result;
    for (const Series& series : chart.series)
      for (const ChartPoint& p : series.points)
        for (const double v : of_point(p)) result.push_back(v);
    return result;
  }

  double at_x(double value) const { return kLeft + x_.position(value) * (kWidth - kLeft - kRight); }
  double at_y(double value) const {
    return kHeight - kBottom - y_.position(value) * (kHeight - kTop - kBottom);
  }
  bool is_shown(double x, double y) const {
    return std::isfinite(x) && std::isfinite(y) && (chart_.x_scale == Scale::linear || x > 0) &&
           (chart_.y_scale == Scale::linear || y > 0);
  }

  Html grid() const {
    const double right = kWidth - kRight, bottom = kHeight - kBottom;
    Html result;
    for (const Tick& tick : y_.ticks())
      result += fmt::format(
          "<line class=\"grid\" x1=\"{0}\" x2=\"{1}\" y1=\"{2:.1f}\" y2=\"{2:.1f}\"/>"
          "<text class=\"tick\" x=\"{3}\" y=\"{2:.1f}\" text-anchor=\"end\" "
          "dominant-baseline=\"middle\">{4}</text>",
          kLeft, right, at_y(tick.value), kLeft - 6, escaped(tick.label));
    std::vector<Tick> ticks = Axis::ticks_at(xs_);
    if (!chart_.ticks_at_points || ticks.size() > kMostTicksAtPoints) ticks = x_.ticks();
    for (const Tick& tick : ticks)
      result += fmt::format(
          "<line class=\"grid\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\"/>"
          "<text class=\"tick\" x=\"{0:.1f}\" y=\"{3}\" text-anchor=\"middle\">{4}</text>",
          at_x(tick.value), kTop, bottom, bottom + 16, escaped(tick.label));
    result +=
        fmt::format("<text class=\"axis\" x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{}</text>",
                    (kLeft + right) / 2, kHeight - 8, escaped(chart_.x_label));
    result += fmt::format(
        "<text class=\"axis\" transform=\"translate(14 {:.1f}) rotate(-90)\" "
        "text-anchor=\"middle\">{}</text>",
        (kTop + bottom) / 2, escaped(chart_.y_label));
    return result;
  }

  Html line(std::size_t i) const {
    const Series& series = chart_.series[i];
    std::string path, spreads, points;
    bool begun = false;
    for (const ChartPoint& p : series.points) {
      if (!is_shown(p.x, p.y)) continue;
      const Place at{at_x(p.x), at_y(p.y)};
      path += fmt::format("{}{:.1f} {:.1f}", begun ? "L" : "M", at.x, at.y);
      begun = true;
      std::string spread;
      if (p.high > p.low && is_shown(p.x, p.low)) {
        spreads += fmt::format("M{:.1f} {:.1f}V{:.1f}", at.x, at_y(p.low), at_y(p.high));
        spread = fmt::format(", {} to {}", short_number(p.low), short_number(p.high));
      }
      points += fmt::format(
          "<circle class=\"point\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\" tabindex=\"0\">"
          "<title>{}: {} {}, {} {} ({}{})</title></circle>",
          at.x, at.y, escaped(series.name), escaped(chart_.x_label), short_number(p.x),
          escaped(chart_.y_label), short_number(p.y), name_of(series.source), spread);
    }
    if (!begun) return "";
    const char* predicted = series.source == Source::predicted ? " predicted" : "";
    return fmt::format(
        "<g class=\"series {0}{1}\" data-series=\"{2}\"><path class=\"line\" d=\"{3}\"/>"
        "<path class=\"spread\" d=\"{4}\"/>{5}</g>",
        look(chart_, i), predicted, i, path, spreads, points);
  }

  const LineChart& chart_;
  std::vector<double> xs_;
  Axis x_, y_;
};

}  // namespace

Html line_chart(const LineChart& chart) {
  const bool mixed =
      std::any_of(chart.series.begin(), chart.series.end(),
                  [&](const Series& series) { return series.source != chart.series[0].source; });
  const auto label = [](Source source) {
    return fmt::format("<span class=\"source\">{}</span>", name_of(source));
  };
  Html legend;
  for (std::size_t i = 0; i < chart.series.size(); ++i)
    legend += fmt::format(
        "<button type=\"button\" class=\"key {}{}\" data-series=\"{}\" aria-pressed=\"true\">"
        "<svg viewBox=\"0 0 24 8\"><path class=\"line\" d=\"M0 4H24\"/></svg>{}{}</button>",
        look(chart, i), chart.series[i].source == Source::predicted ? " predicted" : "", i,
        escaped(chart.series[i].name), mixed ? label(chart.series[i].source) : "");
  return fmt::format(
      "<figure class=\"chart\"><figcaption>{}{}</figcaption>{}<div class=\"legend\">{}</div>"
      "</figure>\n",
      escaped(chart.title), mixed || chart.series.empty() ? "" : label(chart.series[0].source),
      LinePlot(chart).svg(), legend);
}

Html bar_chart(const BarChart& chart) {
  constexpr double kBarHeight = 18, kValues = 80;
  const double names = chart.name_width;
  const double height = kTop + kBarHeight * static_cast<double>(chart.bars.size()) + kBottom;
  std::vector<double> values = {chart.mark};
  for (const Bar& bar : chart.bars) values.push_back(bar.value);
  const Axis axis(values, Scale::linear);
  const double room = kWidth - names - kValues;
  const auto at = [&](double value) { return names + axis.position(value) * room; };
  const double bottom = height - kBottom;
  Html svg = fmt::format("<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">", kWidth,
                         height, escaped(chart.title));
  for (const Tick& tick : axis.ticks())
    svg += fmt::format(
        "<line class=\"grid\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\"/>"
        "<text class=\"tick\" x=\"{0:.1f}\" y=\"{3}\" text-anchor=\"middle\">{4}</text>",
        at(tick.value), kTop, bottom, bottom + 16, escaped(tick.label));
  double y = kTop;
  Html amounts;  // above the mark, or it would cross them out
  for (const Bar& bar : chart.bars) {
    const double value = std::isfinite(bar.value) ? std::max(bar.value, 0.0) : 0.0;
    svg += fmt::format(
        "<text class=\"tick\" x=\"{0}\" y=\"{1:.1f}\" text-anchor=\"end\" "
        "dominant-baseline=\"middle\">{2}</text>"
        "<rect class=\"bar{3}\" x=\"{4}\" y=\"{5:.1f}\" width=\"{6:.1f}\" height=\"{7}\" "
        "tabindex=\"0\"><title>{2}: {8} {9} ({10}){11}</title></rect>",
        names - 6, y + kBarHeight / 2, escaped(bar.name), bar.emphasised ? " emphasised" : "",
        names, y + 2, at(value) - names, kBarHeight - 4, short_number(bar.value),
        escaped(chart.label), name_of(chart.source),
        bar.note.empty() ? "" : "; " + escaped(bar.note));
    amounts += fmt::format(
        "<text class=\"tick value\" x=\"{:.1f}\" y=\"{:.1f}\" "
        "dominant-baseline=\"middle\">{}</text>",
        at(value) + 4, y + kBarHeight / 2, short_number(bar.value));
    y += kBarHeight;
  }
  if (chart.mark > 0)
    svg += fmt::format("<line class=\"mark\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\"/>",
                       at(chart.mark), kTop, bottom);
  svg += amounts;
  svg += fmt::format("<text class=\"axis\" x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{}</text>",
                     names + room / 2, height - 8, escaped(chart.label));
  return fmt::format(
      "<figure class=\"chart\"><figcaption>{} <span class=\"source\">{}</span></figcaption>{}"
      "</svg></figure>\n",
      escaped(chart.title), name_of(chart.source), svg);
}

}  // namespace delray::apps::report
