// Options that choose points, as a filter of the readers.
#include "apps/input/point_choice.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "apps/options/help.h"
#include "apps/options/list.h"
#include "apps/options/numbers.h"
#include "apps/session.h"

namespace delray::apps {
namespace {

// The numbers between commas, or none if one of them is no finite number.
template <class T>
std::optional<std::vector<T>> comma_separated(std::string_view text) {
  std::vector<T> numbers;
  while (true) {
    const std::string_view word = text.substr(0, text.find(','));
    T value{};
    const auto parsed = std::from_chars(word.data(), word.data() + word.size(), value);
    const bool whole = parsed.ec == std::errc() && parsed.ptr == word.data() + word.size();
    if (!whole || !std::isfinite(static_cast<double>(value))) return std::nullopt;
    numbers.push_back(value);
    if (word.size() == text.size()) return numbers;
    text.remove_prefix(word.size() + 1);
  }
}

std::bitset<256> classes_of(const std::string& text) {
  std::bitset<256> classes;
  const auto numbers = comma_separated<int>(text);
  if (numbers) {
    for (const int value : *numbers) {
      if (value < 0 || value > 255) throw UsageError("--class: classes are numbers from 0 to 255");
      classes.set(static_cast<std::size_t>(value));
    }
    return classes;
  }
  throw UsageError(fmt::format("--class: '{}' is no list of classes such as 2,8", text));
}

void set_bounds(const std::string& text, delaunay::PointFilter& filter) {
  const auto numbers = comma_separated<double>(text);
  if (!numbers || (numbers->size() != 4 && numbers->size() != 6)) {
    throw UsageError(
        fmt::format("--bounds: '{}' is neither x0,y0,x1,y1 nor x0,y0,x1,y1,z0,z1", text));
  }
  constexpr double kAnywhere = std::numeric_limits<double>::infinity();
  const std::vector<double>& n = *numbers;
  filter.bounds_z = n.size() == 6;
  geometry::Box3d box;
  box.low = {n[0], n[1], filter.bounds_z ? n[4] : -kAnywhere};
  box.high = {n[2], n[3], filter.bounds_z ? n[5] : kAnywhere};
  if (box.empty()) throw UsageError("--bounds: a greatest coordinate is below the least");
  filter.bounds = box;
}

}  // namespace

void add_choice_options(CLI::App& command, PointChoice& choice) {
  command
      .add_option("--class", choice.classes,
                  "Read points of these classes only, separated by commas, such as 2,8 (LAS: 2 is "
                  "ground, 6 buildings, 9 water)")
      ->group(group::kInput)
      ->type_name("LIST");
  command
      .add_option("--returns", choice.returns,
                  "Read these returns of LiDAR pulses only: first, last, only (pulses that came "
                  "back but once), intermediate, first-of-many or last-of-many")
      ->group(group::kInput);
  choose_from(command, "--returns", names_in(delaunay::return_choices()));
  command
      .add_option("--bounds", choice.bounds,
                  "Read points of this box only: x0,y0,x1,y1 or x0,y0,x1,y1,z0,z1")
      ->group(group::kInput)
      ->type_name("BOX");
  command
      .add_option("--resolution", choice.resolution,
                  "Read no finer levels of a COPC file's octree than this distance between points "
                  "needs")
      ->group(group::kInput)
      ->check(positive_number());
}

delaunay::PointFilter filter_of(const PointChoice& choice) {
  delaunay::PointFilter filter;
  if (!choice.classes.empty()) filter.classes = classes_of(choice.classes);
  if (!choice.bounds.empty()) set_bounds(choice.bounds, filter);
  if (!choice.returns.empty()) {
    filter.returns = &find_entry(delaunay::return_choices(), choice.returns, "--returns");
  }
  filter.resolution = choice.resolution;
  return filter;
}

}  // namespace delray::apps
