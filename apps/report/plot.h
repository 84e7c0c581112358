// Plots that are as wide as their figure while text keeps its size: positions across are per cent
// of the plot, everything else is in pixels.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "apps/report/axis.h"
#include "apps/report/html.h"

namespace delray::apps::report::internal {

// Around the plot, for what is written there, in pixels.
struct Margins {
  double left = 0, right = 0, top = 6, bottom = 40;
};

// An SVG element of the height, `marks` in it.
Html plot(const std::string& title, const Margins& margins, double height, const Html& marks);

// A colour's class in the style sheet, and what it stands for.
struct Key {
  std::string look, meaning;
};

// A figure of this class: the title, where its numbers are from, a plot, and what its colours mean.
Html figure(std::string_view look, const std::string& title, Source source, const Html& plot,
            std::span<const Key> keys);

// Room that a text takes at most in the usual fonts, in pixels.
double text_width(std::string_view text);

// Lines from top to bottom with labels below, and `label` below these. Labels that would touch
// others are left out where the plot is narrow, or everywhere. `position` gives 0 to 1. O(ticks^2).
Html ticks_across(std::span<const Tick> ticks, const std::function<double(double)>& position,
                  double height, const std::string& label);

// Moved apart as little as needed, so that neighbours are `gap` apart within [low, high]; the order
// stays. Where there is no room for all they begin at `low` and are closer. O(n log n).
void move_apart(std::vector<double>& positions, double gap, double low, double high);

}  // namespace delray::apps::report::internal
