// Plots that are as wide as their figure: margins, ticks and labels that do not touch.
#include "apps/report/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace delray::apps::report::internal {
namespace {

// The width of text at 12 pixels, in the widest of the usual fonts (DejaVu Sans).
constexpr double kLetter = 7.3;
// Plots on a telephone, and beside each other on a screen, in pixels.
constexpr double kNarrow = 190, kWide = 330;
constexpr double kBetween = 6;  // neighbouring labels

// Whether the label of ticks[i] touches one of `others` in a plot so wide.
bool touches(std::span<const Tick> ticks, const std::function<double(double)>& position,
             std::size_t i, const std::vector<std::size_t>& others, double width) {
  return std::any_of(others.begin(), others.end(), [&](std::size_t other) {
    const double apart = std::abs(position(ticks[i].value) - position(ticks[other].value)) * width;
    return apart < (text_width(ticks[i].label) + text_width(ticks[other].label)) / 2 + kBetween;
  });
}

}  // namespace

Html plot(const std::string& title, const Margins& margins, double height, const Html& marks) {
  return fmt::format(
      "<div class=\"plot\" style=\"padding:{:.0f}px {:.0f}px {:.0f}px {:.0f}px\"><svg "
      "height=\"{:.0f}\" role=\"img\" aria-label=\"{}\">{}</svg></div>",
      margins.top, margins.right, margins.bottom, margins.left, height, escaped(title), marks);
}

Html figure(std::string_view look, const std::string& title, Source source, const Html& plot,
            std::span<const Key> keys) {
  Html legend;
  for (const Key& key : keys) {
    legend += fmt::format("<span class=\"key\"><i class=\"span {}\"></i>{}</span>", key.look,
                          escaped(key.meaning));
  }
  return fmt::format(
      "<figure class=\"{}\"><figcaption>{} <span class=\"source\">{}</span></figcaption>{}"
      "<div class=\"legend\">{}</div></figure>\n",
      look, escaped(title), name_of(source), plot, legend);
}

double text_width(std::string_view text) { return kLetter * static_cast<double>(text.size()); }

Html ticks_across(std::span<const Tick> ticks, const std::function<double(double)>& position,
                  double height, const std::string& label) {
  std::vector<std::size_t> always, wide;
  for (std::size_t i = 0; i < ticks.size(); ++i)
    if (!touches(ticks, position, i, always, kNarrow)) always.push_back(i);
  wide = always;
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    if (std::find(wide.begin(), wide.end(), i) == wide.end() &&
        !touches(ticks, position, i, wide, kWide))
      wide.push_back(i);
  }
  Html result;
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    const double x = position(ticks[i].value) * 100;
    result += fmt::format("<line class=\"grid\" x1=\"{0:.2f}%\" x2=\"{0:.2f}%\" y2=\"{1:.0f}\"/>",
                          x, height);
    if (std::find(wide.begin(), wide.end(), i) == wide.end()) continue;
    const bool spare = std::find(always.begin(), always.end(), i) == always.end();
    result += fmt::format(
        "<text class=\"tick{}\" x=\"{:.2f}%\" y=\"{:.0f}\" text-anchor=\"middle\">{}</text>",
        spare ? " spare" : "", x, height + 16, escaped(ticks[i].label));
  }
  return result +
         fmt::format("<text class=\"axis\" x=\"50%\" y=\"{:.0f}\" text-anchor=\"middle\">{}</text>",
                     height + 34, escaped(label));
}

void move_apart(std::vector<double>& positions, double gap, double low, double high) {
  std::vector<std::size_t> order(positions.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return positions[a] < positions[b]; });
  const auto count = static_cast<double>(order.size());
  if (count > 1) gap = std::min(gap, (high - low) / (count - 1));
  double least = low;
  for (const std::size_t i : order) {
    positions[i] = std::max(positions[i], least);
    least = positions[i] + gap;
  }
  double most = high;
  for (auto at = order.rbegin(); at != order.rend(); ++at) {
    positions[*at] = std::min(positions[*at], most);
    most = positions[*at] - gap;
  }
}

}  // namespace delray::apps::report::internal
