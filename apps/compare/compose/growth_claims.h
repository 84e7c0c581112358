// What Kohout (2004, 3.1.2.3) says of how schemes grow with the ranks, beside what was counted.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "apps/compare/compose/compare_compose.h"
#include "apps/report/html.h"

namespace delray::apps {

// From n to m ranks: by 1, m / n, log m / log n, n / m; or no other scheme has less at m.
enum class GrowthLaw : std::uint8_t { constant, linear, logarithmic, hyperbolic, least_of_all };
const char* name(GrowthLaw growth);

// The report's figures: bytes that travel (of bus: over the bus), bytes that the busiest rank
// sends, pixels that the busiest rank composites.
enum class GrowingFigure : std::uint8_t { bytes, bytes_sent, pixels_composited };
const char* name(GrowingFigure figure);  // "B", "L_B", "L_C"

struct GrowthClaim {
  const char* scheme;  // as the table calls it
  GrowingFigure figure;
  GrowthLaw growth;
};
std::span<const GrowthClaim> growth_claims();

// A claim and what was counted for one codec with the fewest and the most ranks.
struct JudgedGrowth {
  GrowthClaim claim;
  std::string codec;
  int few = 0, many = 0;
  double at_few = 0, at_many = 0;
  GrowthLaw found = GrowthLaw::constant;  // the nearest
  bool is_right() const { return found == claim.growth; }
};

// Of the claims whose scheme has rows for at least two powers of two of ranks, the largest four
// times the smallest, which is not 1.
std::vector<JudgedGrowth> judge_growth(const std::vector<ComparedScheme>& rows);

// Empty where there are none.
report::Html growth_claims_tab(const std::vector<JudgedGrowth>& judged);
Json growth_claims_json(const std::vector<JudgedGrowth>& judged);

}  // namespace delray::apps
