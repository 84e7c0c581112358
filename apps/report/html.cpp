// Escapes text and formats numbers for pages.
#include "apps/report/html.h"

#include <fmt/format.h>

#include <cmath>

namespace delray::apps::report {

Html escaped(std::string_view text) {
  Html result;
  result.reserve(text.size());
  for (const char c : text) {
    switch (c) {
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '&':
        result += "&amp;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

Html strong(std::string_view text) { return "<strong>" + escaped(text) + "</strong>"; }

std::string_view name_of(Source source) {
  switch (source) {
    case Source::counted:
      return "counted";
    case Source::measured:
      return "measured";
    case Source::predicted:
      return "predicted";
  }
  return "";
}

std::string short_number(double value) {
  if (!std::isfinite(value)) return "-";
  struct Unit {
    double from, size;
    const char* name;
  };
  constexpr Unit kUnits[] = {{1e9, 1e9, " G"}, {1e6, 1e6, " M"}, {1e4, 1e3, " k"}};
  for (const Unit& unit : kUnits)
    if (std::abs(value) >= unit.from) return fmt::format("{:.4g}{}", value / unit.size, unit.name);
  return fmt::format("{:.4g}", value);
}

}  // namespace delray::apps::report
