// The factor by which a figure grows from the fewest to the most ranks is taken for the growth
// whose factor is nearest to it, as logarithms. Degenerate: a figure that is 0 grows like none of
// them, and is left out.
#include "apps/compare/compose/growth_claims.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>

#include "apps/report/page.h"
#include "apps/report/table.h"

namespace delray::apps {
namespace {

constexpr std::array kClaims = {
    GrowthClaim{"centralized", GrowingFigure::bytes, GrowthLaw::constant},
    GrowthClaim{"centralized", GrowingFigure::bytes_sent, GrowthLaw::constant},
    GrowthClaim{"centralized", GrowingFigure::pixels_composited, GrowthLaw::linear},
    GrowthClaim{"pipeline", GrowingFigure::bytes, GrowthLaw::linear},
    GrowthClaim{"pipeline", GrowingFigure::bytes_sent, GrowthLaw::linear},
    GrowthClaim{"pipeline", GrowingFigure::pixels_composited, GrowthLaw::linear},
    GrowthClaim{"tree", GrowingFigure::bytes, GrowthLaw::logarithmic},
    GrowthClaim{"tree", GrowingFigure::bytes_sent, GrowthLaw::logarithmic},
    GrowthClaim{"tree", GrowingFigure::pixels_composited, GrowthLaw::logarithmic},
    GrowthClaim{"binary-swap", GrowingFigure::bytes, GrowthLaw::logarithmic},
    GrowthClaim{"binary-swap", GrowingFigure::bytes_sent, GrowthLaw::hyperbolic},
    GrowthClaim{"binary-swap", GrowingFigure::pixels_composited, GrowthLaw::hyperbolic},
    GrowthClaim{"mesh", GrowingFigure::bytes, GrowthLaw::hyperbolic},
    GrowthClaim{"mesh", GrowingFigure::bytes_sent, GrowthLaw::hyperbolic},
    GrowthClaim{"mesh", GrowingFigure::pixels_composited, GrowthLaw::hyperbolic},
    GrowthClaim{"bus", GrowingFigure::bytes, GrowthLaw::hyperbolic},
    GrowthClaim{"bus", GrowingFigure::pixels_composited, GrowthLaw::logarithmic},
    GrowthClaim{"bus", GrowingFigure::bytes, GrowthLaw::least_of_all},
};

double figure_of(const ComparedScheme& row, GrowingFigure figure) {
  switch (figure) {
    case GrowingFigure::bytes:
      // What goes over a bus comes to the composer, each message once.
      return static_cast<double>(row.scheme == "bus" ? row.counts.bytes_received_max
                                                     : row.counts.bytes_total);
    case GrowingFigure::bytes_sent:
      return static_cast<double>(row.counts.bytes_sent_max);
    case GrowingFigure::pixels_composited:
      return static_cast<double>(row.counts.pixels_composited_max);
  }
  return 0;
}

GrowthLaw nearest_growth(double factor, int few, int many) {
  const double f = static_cast<double>(many) / few;
  const std::array<std::pair<GrowthLaw, double>, 4> candidates = {
      {{GrowthLaw::constant, 1.0},
       {GrowthLaw::logarithmic, std::log(many) / std::log(few)},
       {GrowthLaw::linear, f},
       {GrowthLaw::hyperbolic, 1 / f}}};
  const auto distance = [&](const auto& candidate) {
    return std::abs(std::log(factor) - std::log(candidate.second));
  };
  return std::ranges::min_element(candidates, {}, distance)->first;
}

bool is_judged(const ComparedScheme& row) {
  return row.ranks > 1 && std::has_single_bit(static_cast<unsigned>(row.ranks));
}

// Whether no scheme has less with as many ranks.
bool is_least(const std::vector<ComparedScheme>& rows, const ComparedScheme& row,
              GrowingFigure figure) {
  return std::ranges::none_of(rows, [&](const ComparedScheme& other) {
    return other.ranks == row.ranks && other.codec == row.codec &&
           figure_of(other, figure) < figure_of(row, figure);
  });
}

std::optional<JudgedGrowth> judge(const std::vector<ComparedScheme>& rows, const GrowthClaim& claim,
                                  const std::string& codec) {
  const ComparedScheme *few = nullptr, *many = nullptr;
  for (const ComparedScheme& row : rows) {
    if (row.scheme != claim.scheme || row.codec != codec || !is_judged(row)) continue;
    if (few == nullptr || row.ranks < few->ranks) few = &row;
    if (many == nullptr || row.ranks > many->ranks) many = &row;
  }
  constexpr int kFarApart = 4;
  if (few == nullptr || many->ranks < kFarApart * few->ranks) return std::nullopt;
  JudgedGrowth result{claim,
                      codec,
                      few->ranks,
                      many->ranks,
                      figure_of(*few, claim.figure),
                      figure_of(*many, claim.figure),
                      GrowthLaw::constant};
  if (!(result.at_few > 0) || !(result.at_many > 0)) return std::nullopt;
  result.found = nearest_growth(result.at_many / result.at_few, few->ranks, many->ranks);
  if (claim.growth == GrowthLaw::least_of_all && is_least(rows, *many, claim.figure))
    result.found = GrowthLaw::least_of_all;
  return result;
}

}  // namespace

const char* name(GrowthLaw growth) {
  constexpr std::array<const char*, 5> kNames = {"constant", "linear", "logarithmic", "as 1/n",
                                                 "least of all"};
  return kNames[static_cast<std::size_t>(growth)];
}

const char* name(GrowingFigure figure) {
  constexpr std::array<const char*, 3> kNames = {"B", "L_B", "L_C"};
  return kNames[static_cast<std::size_t>(figure)];
}

std::span<const GrowthClaim> growth_claims() { return kClaims; }

std::vector<JudgedGrowth> judge_growth(const std::vector<ComparedScheme>& rows) {
  std::vector<std::string> codecs;
  for (const ComparedScheme& row : rows)
    if (std::ranges::find(codecs, row.codec) == codecs.end()) codecs.push_back(row.codec);
  std::vector<JudgedGrowth> result;
  for (const std::string& codec : codecs)
    for (const GrowthClaim& claim : kClaims)
      if (auto judged = judge(rows, claim, codec)) result.push_back(std::move(*judged));
  return result;
}

report::Html growth_claims_tab(const std::vector<JudgedGrowth>& judged) {
  using namespace report;
  if (judged.empty()) return "";
  Table text;
  text.columns = {{"scheme", false, false, {}},
                  {"codec", false, false, {}},
                  {"figure", false, false, {}},
                  {"the report says", false, false, {}},
                  {"ranks", true, false, {}},
                  {"counted", true, true, Source::counted},
                  {"ranks", true, false, {}},
                  {"counted", true, true, Source::counted},
                  {"found", false, true, Source::counted},
                  {"the report is", false, true, Source::counted}};
  for (const JudgedGrowth& one : judged) {
    text.rows.push_back(
        {one.claim.scheme, one.codec, name(one.claim.figure), name(one.claim.growth),
         std::to_string(one.few), fmt::format("{:.4g}", one.at_few), std::to_string(one.many),
         fmt::format("{:.4g}", one.at_many), name(one.found), one.is_right() ? "right" : "wrong"});
  }
  return heading("How schemes grow") +
         paragraph(
             "Kohout (2004, 3.1.2.3): B, bytes that travel in all; L_B, bytes that the busiest "
             "rank "
             "sends; L_C, pixels that it composites. Every rank draws a part of this scene.") +
         table(text);
}

Json growth_claims_json(const std::vector<JudgedGrowth>& judged) {
  Json result = Json::array();
  for (const JudgedGrowth& one : judged) {
    result.push_back({{"scheme", one.claim.scheme},
                      {"codec", one.codec},
                      {"figure", name(one.claim.figure)},
                      {"claim", name(one.claim.growth)},
                      {"ranks", {one.few, one.many}},
                      {"counted", {one.at_few, one.at_many}},
                      {"found", name(one.found)},
                      {"is_right", one.is_right()}});
  }
  return result;
}

}  // namespace delray::apps
