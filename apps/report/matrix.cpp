// Draws a table of amounts as an SVG of shaded cells, shaded by the root of the amount.
#include "apps/report/matrix.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace delray::apps::report {
namespace {

// By the root, or small amounts could not be seen.
double shade_of(double value, double most) {
  return 0.15 + 0.85 * std::sqrt(std::min(1.0, value / most));
}

}  // namespace

Html matrix(const Matrix& matrix, double most) {
  constexpr double kSide = 360, kLeft = 34, kTop = 34;
  if (!(most > 0))
    for (const double value : matrix.values) most = std::max(most, value);
  const double width = kSide / std::max(1, matrix.columns);
  const double height = kSide / std::max(1, matrix.rows);
  Html svg = fmt::format(
      "<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\"><rect class=\"frame\" x=\"{}\" "
      "y=\"{}\" width=\"{}\" height=\"{}\"/>",
      kSide + kLeft + 4, kSide + kTop + 4, escaped(matrix.title), kLeft, kTop, kSide, kSide);
  svg += fmt::format(
      "<text class=\"axis\" x=\"{:.1f}\" y=\"12\" text-anchor=\"middle\">{}</text>"
      "<text class=\"axis\" transform=\"translate(12 {:.1f}) rotate(-90)\" "
      "text-anchor=\"middle\">{}</text>",
      kLeft + kSide / 2, escaped(matrix.column_name), kTop + kSide / 2, escaped(matrix.row_name));
  // Numbers of rows and columns, as many as there is room for.
  const auto stride = [](int count) { return std::max(1, (count + 15) / 16); };
  for (int i = 0; i < matrix.columns; i += stride(matrix.columns)) {
    svg +=
        fmt::format("<text class=\"tick\" x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{}</text>",
                    kLeft + (i + 0.5) * width, kTop - 5, i);
  }
  for (int j = 0; j < matrix.rows; j += stride(matrix.rows)) {
    svg += fmt::format(
        "<text class=\"tick\" x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\" "
        "dominant-baseline=\"middle\">{}</text>",
        kLeft - 4, kTop + (j + 0.5) * height, j);
  }
  for (int j = 0; j < matrix.rows; ++j) {
    for (int i = 0; i < matrix.columns; ++i) {
      const double value = matrix.values[static_cast<std::size_t>(j) * matrix.columns + i];
      if (!(value > 0)) continue;
      svg += fmt::format(
          "<rect class=\"cell\" x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" "
          "fill-opacity=\"{:.3f}\"><title>{} {}, {} {}: {} {} ({})</title></rect>",
          kLeft + i * width, kTop + j * height, width, height, shade_of(value, most),
          escaped(matrix.row_name), j, escaped(matrix.column_name), i, short_number(value),
          escaped(matrix.unit), name_of(matrix.source));
    }
  }
  Html legend;
  if (std::none_of(matrix.values.begin(), matrix.values.end(), [](double v) { return v > 0; })) {
    legend = "<span class=\"key\">nothing</span>";
  } else {
    for (const double part : {1.0, 0.25, 0.01}) {
      legend += fmt::format(
          "<span class=\"key\"><svg viewBox=\"0 0 24 8\"><rect class=\"cell\" width=\"24\" "
          "height=\"8\" fill-opacity=\"{:.3f}\"/></svg>{} {}</span>",
          shade_of(part, 1), short_number(part * most), escaped(matrix.unit));
    }
  }
  return fmt::format(
      "<figure class=\"matrix\"><figcaption>{} <span class=\"source\">{}</span></figcaption>{}"
      "</svg><div class=\"legend\">{}</div></figure>\n",
      escaped(matrix.title), name_of(matrix.source), svg, legend);
}

}  // namespace delray::apps::report
