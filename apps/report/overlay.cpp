// Draws rectangles and the borders between their groups as an SVG over a picture. Borders are found
// on a grid of small cells and strung together into lines: O(areas + cells).
#include "apps/report/overlay.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/report/page.h"

namespace delray::apps::report {
namespace {

// Cells of so many pixels are told apart by their borders.
constexpr int kBorderCell = 2;

// Classes and attributes of an area.
std::string look_of(const Area& area, Shading shading) {
  const double value = std::isfinite(area.value) ? area.value : 0;
  switch (shading) {
    case Shading::around_one:
      // By the root, or small differences could not be seen.
      return fmt::format("class=\"{}\" fill-opacity=\"{:.3f}\"", value > 1 ? "above" : "below",
                         0.75 * std::sqrt(std::min(1.0, std::abs(value - 1))));
    case Shading::amount:
      return fmt::format("class=\"amount\" fill-opacity=\"{:.3f}\"",
                         0.9 * std::clamp(value, 0.0, 1.0));
    case Shading::group:
      // By the golden angle neighbouring numbers look unlike.
      return fmt::format("class=\"group\" fill=\"hsl({:.0f} 75% {}%)\"",
                         std::fmod(area.group * 137.508, 360.0), 40 + area.group % 3 * 12);
  }
  return "";
}

// Borders between cells of different groups, neighbouring pieces of a line strung together.
std::string borders(const Overlay& overlay) {
  const int columns = (overlay.width + kBorderCell - 1) / kBorderCell;
  const int rows = (overlay.height + kBorderCell - 1) / kBorderCell;
  if (columns <= 0 || rows <= 0) return "";
  std::vector<int> groups(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), -1);
  const auto at = [&](int i, int j) -> int& {
    return groups[static_cast<std::size_t>(j) * static_cast<std::size_t>(columns) +
                  static_cast<std::size_t>(i)];
  };
  for (const Area& area : overlay.areas) {
    for (int j = area.rect.y0 / kBorderCell; j * kBorderCell < area.rect.y1 && j < rows; ++j) {
      for (int i = area.rect.x0 / kBorderCell; i * kBorderCell < area.rect.x1 && i < columns; ++i)
        at(i, j) = area.group;
    }
  }
  std::string path;
  for (int j = 1; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      if (at(i, j) == at(i, j - 1)) continue;
      const int begin = i;
      while (i < columns && at(i, j) != at(i, j - 1)) ++i;
      path += fmt::format("M{} {}H{}", begin * kBorderCell, j * kBorderCell, i * kBorderCell);
    }
  }
  for (int i = 1; i < columns; ++i) {
    for (int j = 0; j < rows; ++j) {
      if (at(i, j) == at(i - 1, j)) continue;
      const int begin = j;
      while (j < rows && at(i, j) != at(i - 1, j)) ++j;
      path += fmt::format("M{} {}V{}", i * kBorderCell, begin * kBorderCell, j * kBorderCell);
    }
  }
  return path;
}

}  // namespace

Html overlay(const Overlay& overlay, const std::string& picture_id) {
  Html svg = fmt::format(
      "<svg viewBox=\"0 0 {0} {1}\" role=\"img\" aria-label=\"{2}\"><use href=\"#{3}\" "
      "width=\"{0}\" height=\"{1}\"/>",
      overlay.width, overlay.height, escaped(overlay.title), picture_id);
  for (const Area& area : overlay.areas) {
    if (area.rect.empty()) continue;
    svg += fmt::format(
        "<rect {} x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"><title>{} ({})</title></rect>",
        look_of(area, overlay.shading), area.rect.x0, area.rect.y0, area.rect.width(),
        area.rect.height(), escaped(area.note), name_of(overlay.source));
  }
  svg += fmt::format("<path class=\"border\" d=\"{}\"/></svg>", borders(overlay));
  return fmt::format(
      "<figure class=\"overlay\"><figcaption>{} <span class=\"source\">{}</span></figcaption>{}"
      "</figure>\n",
      escaped(overlay.title), name_of(overlay.source), svg);
}

Html backdrop(const image::Image8& picture, const std::string& id) {
  return fmt::format(
      "<svg class=\"backdrop\" width=\"0\" height=\"0\"><symbol id=\"{}\" viewBox=\"0 0 {} {}\" "
      "preserveAspectRatio=\"none\"><image width=\"{}\" height=\"{}\" href=\"{}\"/></symbol></svg>"
      "\n",
      id, picture.width, picture.height, picture.width, picture.height, png_url(picture));
}

Html overlay_key(const std::string& low, const std::string& even, const std::string& high) {
  return fmt::format(
      "<div class=\"legend\"><span class=\"key\"><i class=\"below\"></i>{}</span><span "
      "class=\"key\"><i></i>{}</span><span class=\"key\"><i class=\"above\"></i>{}</span></div>\n",
      escaped(low), escaped(even), escaped(high));
}

}  // namespace delray::apps::report
