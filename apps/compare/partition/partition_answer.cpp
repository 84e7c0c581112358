// Which partition to take: by counted work, by processor time, and whether these agree.
#include "apps/compare/partition/partition_answer.h"

#include <fmt/format.h>

#include <algorithm>

#include "apps/compare/verdict.h"
#include "apps/report/page.h"
#include "apps/report/table.h"
#include "comm/network.h"

namespace delray::apps {
namespace {

using namespace report;
using PartitionRows = std::vector<ComparedPartition>;
using Partitions = std::vector<const ComparedPartition*>;
using Strategies = std::vector<const ComparedStrategy*>;

std::vector<std::string> names_of(const Partitions& rows) {
  std::vector<std::string> names;
  for (const ComparedPartition* row : rows) names.push_back(row->partition);
  return names;
}
std::string strategy_names(const Strategies& rows) {
  std::vector<std::string> names;
  for (const ComparedStrategy* row : rows) names.push_back(row->strategy);
  return winners_cell(names);
}

std::vector<int> drawn_ranks(const PartitionRows& rows) {
  std::vector<int> result;
  for (const ComparedPartition& row : rows)
    if (row.drawn && (result.empty() || result.back() != row.ranks)) result.push_back(row.ranks);
  return result;
}

// The rows with so many ranks (0: any number) whose frames after the first are predicted to take
// least.
Strategies best_strategies(const std::vector<ComparedStrategy>& strategies, int ranks,
                           std::string_view network) {
  Strategies all;
  for (const ComparedStrategy& one : strategies)
    if (ranks == 0 || one.ranks == ranks) all.push_back(&one);
  return winners<ComparedStrategy>(
      all, [&](const ComparedStrategy& one) { return prediction(one.drawn, network)->spread; });
}

// A sentence on the times of the busiest ranks, where they tell more than counts do.
std::string processor_time(const PartitionChoice& choice, const ComparedPartition& best) {
  if (choice.quick.empty()) return "";
  const ComparedPartition& quickest = *choice.quick.front();
  std::string text = fmt::format(" With {} the busiest rank takes {} of processor time for a frame",
                                 escaped(best.partition), measured_text(best.drawn->busiest));
  if (!choice.agree) {
    return text + fmt::format(
                      ". That contradicts what is counted: with {} it takes {}. Try both: ranks "
                      "that take turns share a core's caches.",
                      strong(listed(names_of(choice.quick))),
                      measured_text(quickest.drawn->busiest));
  }
  text += choice.quick.size() > 1
              ? fmt::format(", and with no partition measurably less by more than {:.0f} %.",
                            (kAsEven - 1) * 100)
              : ", measurably less than with any other.";
  std::vector<std::string> slower;
  for (const ComparedPartition* row : choice.even)
    if (takes_longer(row->drawn->busiest, best.drawn->busiest)) slower.push_back(row->partition);
  if (!slower.empty()) {
    text += fmt::format(" By what is counted {} {} as even, but the busiest rank takes longer.",
                        escaped(listed(slower)), slower.size() == 1 ? "is" : "are");
  }
  return text;
}

// Where processor time is shared out more evenly than by the best, and what that is worth.
std::string evener(const PartitionRows& rows, const ComparedPartition& best) {
  if (!best.drawn) return "";
  const ComparedPartition* evenest = &best;
  for (const ComparedPartition& row : rows) {
    if (row.ranks == best.ranks && row.regions_per_rank == best.regions_per_rank && row.drawn &&
        row.drawn->imbalance.median < evenest->drawn->imbalance.median)
      evenest = &row;
  }
  if (!differ(evenest->drawn->imbalance, best.drawn->imbalance)) return "";
  const Spread &own = best.drawn->busiest, &other = evenest->drawn->busiest;
  const char* worth = !takes_longer(own, other) && !takes_longer(other, own)
                          ? "which makes no difference to what that rank takes"
                      : other.median < own.median
                          ? "and that rank takes less"
                          : "but all have more to do, and that rank takes longer";
  return fmt::format(
      " {} shares processor time out more evenly, {:.3g} instead of {:.3g} times the mean for the "
      "busiest rank (measured), {}.",
      escaped(evenest->partition), evenest->drawn->imbalance.median, best.drawn->imbalance.median,
      worth);
}

// Cutting, and the busiest rank by what is counted.
Spread finish_of(const PartitionComparison& comparison, const ComparedPartition& row) {
  const double share = row.drawn->work_over_share / row.ranks;
  Spread result = row.cut_seconds;
  result.median += share * comparison.alone.median;
  result.low += share * comparison.alone.low;
  result.high += share * comparison.alone.high;
  return result;
}

// Where the screen is cut anew for every frame, what is done first.
std::string anew(const PartitionComparison& comparison, const ComparedPartition& best) {
  if (!best.drawn) return "";
  Partitions drawn;
  for (const ComparedPartition& row : comparison.rows) {
    if (row.ranks == best.ranks && row.regions_per_rank == best.regions_per_rank && row.drawn)
      drawn.push_back(&row);
  }
  const Partitions first = winners<ComparedPartition>(
      drawn, [&](const ComparedPartition& row) { return finish_of(comparison, row); });
  if (std::find(first.begin(), first.end(), &best) != first.end()) return "";
  return fmt::format(
      " Where the screen is cut anew for every frame {} {} done first, after {} instead of {} "
      "(predicted).",
      escaped(listed(names_of(first))), first.size() == 1 ? "is" : "are",
      time_text(finish_of(comparison, *first.front()).median),
      time_text(finish_of(comparison, best).median));
}

Html sentence(const PartitionComparison& comparison, int ranks) {
  const PartitionChoice choice = choose_partition(comparison.rows, ranks);
  const ComparedPartition& best = *choice.best.front();
  const char* source = best.drawn ? "counted" : "predicted";
  Html text =
      fmt::format("<p>For {} ranks cut the screen by {}", best.ranks, strong(best.partition));
  if (choice.best.size() > 1) {
    text += fmt::format(" (no difference to {})",
                        escaped(listed(names_of({choice.best.begin() + 1, choice.best.end()}))));
  }
  text += fmt::format(
      ": the busiest rank does {:.3g} times an equal share of the work of one alone ({}), cutting "
      "takes {}, and a primitive goes to {:.3g} ranks on average (counted).",
      over_share(best), source, measured_text(best.cut_seconds), best.overlap);
  const ComparedPartition* evenest = &best;
  for (const ComparedPartition* row : choice.even)
    if (over_share(*row) < over_share(*evenest)) evenest = row;
  if (evenest != &best) {
    text += fmt::format(" {} shares out more evenly, {:.3g} ({}), and is cut in {}.",
                        escaped(evenest->partition), over_share(*evenest), source,
                        measured_text(evenest->cut_seconds));
  }
  text += processor_time(choice, best) + evener(comparison.rows, best) + anew(comparison, best) +
          "</p>\n";
  return text + fmt::format("<p>One rank alone takes {} for a frame. {}</p>\n",
                            measured_text(comparison.alone),
                            best.drawn
                                ? "Ranks take turns on this machine: their processor time is "
                                  "measured, how long frames take is predicted."
                                : "So many ranks are not drawn: their shares are predicted.");
}

// Over each network, what takes least of all.
Html fastest_frames(const PartitionComparison& comparison) {
  const std::vector<ComparedStrategy>& strategies = comparison.strategies;
  if (strategies.empty()) return "";
  std::vector<std::string> parts;
  for (const comm::NamedNetwork& named : comparison.networks) {
    const Strategies best = best_strategies(strategies, 0, named.name);
    const ComparedStrategy& first = *best.front();
    std::vector<std::string> equals;
    for (std::size_t i = 1; i < best.size(); ++i)
      equals.push_back(fmt::format("{} on {}", best[i]->strategy, best[i]->ranks));
    const Spread& spread = prediction(first.drawn, named.name)->spread;
    parts.push_back(fmt::format(
        "over {} with {} on {} ranks, {} ({} to {}){}", named.name, strong(first.strategy),
        first.ranks, time_text(spread.median), time_text(spread.low), time_text(spread.high),
        equals.empty() ? "" : ", no difference to " + escaped(listed(equals))));
  }
  return fmt::format("<p>Frames take least {} (predicted).</p>\n", fmt::join(parts, "; "));
}

Table table_of(const PartitionComparison& comparison, const std::vector<int>& ranks) {
  Table result;
  result.columns = {{"ranks", true, false, {}},
                    {"partition", false, true, Source::counted},
                    {"work over share", true, true, Source::counted},
                    {"least processor time", false, true, Source::measured},
                    {"cut ms", true, true, Source::measured}};
  for (const comm::NamedNetwork& named : comparison.networks)
    result.columns.push_back({named.name, false, true, Source::predicted});
  for (const int count : ranks) {
    const PartitionChoice choice = choose_partition(comparison.rows, count);
    const ComparedPartition& best = *choice.best.front();
    std::vector<std::string> line = {
        std::to_string(count), winners_cell(names_of(choice.best)),
        fmt::format("{:.3f}", best.drawn->work_over_share),
        fmt::format("{}, {} ms", winners_cell(names_of(choice.quick)),
                    milliseconds_cell(choice.quick.front()->drawn->busiest)),
        milliseconds_cell(best.cut_seconds)};
    for (const comm::NamedNetwork& named : comparison.networks) {
      const Strategies over = best_strategies(comparison.strategies, count, named.name);
      line.push_back(
          over.empty()
              ? "-"
              : fmt::format("{}, {}", strategy_names(over),
                            time_text(prediction(over.front()->drawn, named.name)->seconds)));
    }
    result.rows.push_back(std::move(line));
  }
  return result;
}

}  // namespace

Html partition_answer(const PartitionComparison& comparison) {
  const std::vector<int> ranks =
      drawn_ranks(with_regions(comparison.rows, comparison.rows.front().regions_per_rank));
  if (ranks.empty()) return advice_beside(sentence(comparison, comparison.rows.back().ranks), "");
  const std::string caption = fmt::format(
      "By number of ranks: of the partitions whose shares of the counted work are within {:.0f} % "
      "of the most even ones, those whose busiest rank takes least processor time, if any, and of "
      "these the one that is cut soonest; what takes least processor time of all; and over each "
      "network the strategy whose frames take least. \u2248: no difference, the intervals in which "
      "the "
      "medians of the frames lie overlap.",
      (kAsEven - 1) * 100);
  return advice_beside(sentence(comparison, ranks.back()) + fastest_frames(comparison),
                       paragraph(caption) + table(table_of(comparison, ranks)));
}

PartitionRows with_regions(const PartitionRows& rows, int regions) {
  PartitionRows result;
  std::copy_if(rows.begin(), rows.end(), std::back_inserter(result),
               [&](const ComparedPartition& row) { return row.regions_per_rank == regions; });
  return result;
}

const PredictedFrame* prediction(const DrawnFrames& drawn, std::string_view network) {
  const auto at = std::find_if(drawn.predicted.begin(), drawn.predicted.end(),
                               [&](const PredictedFrame& one) { return one.network == network; });
  return at == drawn.predicted.end() ? nullptr : &*at;
}

}  // namespace delray::apps
