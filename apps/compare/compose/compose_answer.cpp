// Which compositing scheme to use: by what was measured where ranks have a core each, by what is
// predicted elsewhere, and never without what cannot be told from it.
#include "apps/compare/compose/compose_answer.h"

#include <fmt/format.h>

#include <algorithm>

#include "apps/compare/verdict.h"
#include "apps/report/page.h"
#include "apps/report/series.h"
#include "apps/report/table.h"
#include "apps/statistics.h"

namespace delray::apps {
namespace {

using namespace report;
using SchemeRows = std::vector<ComparedScheme>;
using SchemeWinners = std::vector<const ComparedScheme*>;

std::vector<std::string> names_of(const SchemeWinners& rows, bool codecs) {
  std::vector<std::string> names;
  for (const ComparedScheme* row : rows)
    names.push_back(codecs ? row->scheme + ", " + row->codec : row->scheme);
  return names;
}

std::string in_bytes(std::uint64_t bytes) {
  const auto amount = static_cast<double>(bytes);
  if (bytes < 1000) return fmt::format("{} bytes", bytes);
  return bytes < 1'000'000 ? fmt::format("{:.3g} kB", amount / 1e3)
                           : fmt::format("{:.3g} MB", amount / 1e6);
}
std::string counts_text(const ComparedScheme& row) {
  return fmt::format("{} sent in {} messages (counted)", in_bytes(row.counts.bytes_total),
                     row.counts.messages);
}
double total(const Predicted& predicted) { return predicted.seconds + predicted.gather_seconds; }

// With as many ranks the one that takes least after the best.
const ComparedScheme* next_of(const SchemeRows& rows, const SchemeWinners& best) {
  const ComparedScheme* next = nullptr;
  for (const ComparedScheme& row : rows) {
    if (row.ranks == best.front()->ranks && row.total_seconds &&
        std::find(best.begin(), best.end(), &row) == best.end() &&
        (next == nullptr || row.total_seconds->median < next->total_seconds->median))
      next = &row;
  }
  return next;
}

// REQUIRES: !best.empty().
Html measured_sentence(const ComposeComparison& comparison, const SchemeWinners& best,
                       bool codecs) {
  const ComparedScheme& first = *best.front();
  const std::vector<std::string> names = names_of(best, codecs);
  Html text = fmt::format("<p>On {} of this machine ", count_text(first.ranks, "rank"));
  text += best.size() == 1 ? fmt::format("use {}: ", strong(names[0]))
                           : fmt::format("there is no difference between {}: {} takes ",
                                         strong(listed(names)), escaped(names[0]));
  text += fmt::format("{} with the gather, {}.", measured_text(*first.total_seconds),
                      counts_text(first));
  if (const ComparedScheme* next = next_of(comparison.rows, best)) {
    text += fmt::format(" {} takes {:.0f} % more.", escaped(names_of({next}, codecs)[0]),
                        (next->total_seconds->median / first.total_seconds->median - 1) * 100);
  }
  if (first.ranks > comparison.cores) {
    text += fmt::format(" They share {}: that tells nothing of a machine with a core for each.",
                        count_text(comparison.cores, "core"));
  }
  return text + "</p>\n";
}

// On a machine that has a core for each rank.
Html predicted_sentence(const ComposeComparison& comparison, int ranks, const std::string& network,
                        double factor, bool codecs) {
  const SchemeWinners best = fastest_over(comparison.rows, ranks, network, factor);
  if (best.empty()) return "";
  const std::vector<std::string> names = names_of(best, codecs);
  Html text = fmt::format("<p>On {} ranks over {} ", ranks, escaped(network));
  text += best.size() == 1 ? fmt::format("use {}: ", strong(names[0]))
                           : fmt::format("no difference is predicted between {}: {} takes ",
                                         strong(listed(names)), escaped(names[0]));
  return text + fmt::format(
                    "{} with the gather (predicted), {}. So many ranks are simulated, not "
                    "measured: this machine has {}.</p>\n",
                    time_text(total(*prediction(*best.front(), network))),
                    counts_text(*best.front()), count_text(comparison.cores, "core"));
}

// A sentence on how sure the first place is.
Html doubts(const SchemeRows& rows, double factor) {
  const bool checked = std::any_of(rows.begin(), rows.end(), [](const ComparedScheme& row) {
    return row.total_seconds && prediction(row, kThisMachine) != nullptr;
  });
  return fmt::format(
      "<p>No difference (\u2248 in the table): between measured times, the intervals in which "
      "their medians lie overlap; "
      "between predicted ones, they are less than {:.0f} % apart, {}.</p>\n",
      (factor - 1) * 100,
      checked ? "by which predictions for this machine are off each other's proportion, in the "
                "median"
              : "as none could be checked here");
}

// As many as were measured, or are predicted where none was.
int advised_ranks(const SchemeRows& rows) {
  int ranks = 0;
  for (const ComparedScheme& row : rows)
    if (row.total_seconds) ranks = std::max(ranks, row.ranks);
  return ranks > 0 ? ranks : rows.back().ranks;
}

// The rows with the most ranks that have a core each, or with the fewest.
SchemeWinners winners_here(const ComposeComparison& comparison) {
  SchemeWinners here;
  for (const int ranks : unique_of(comparison.rows, [](const auto& row) { return row.ranks; })) {
    const SchemeWinners best = fastest(comparison.rows, ranks);
    if (!best.empty() && (here.empty() || ranks <= comparison.cores)) here = best;
  }
  return here;
}

Table table_of(const ComposeComparison& comparison, const std::vector<std::string>& networks,
               double factor, bool codecs) {
  Table result;
  result.columns = {
      {"ranks", true, false, {}}, {"here", false, true, Source::measured}, {"ms", true, false, {}}};
  for (const std::string& network : networks) {
    result.columns.push_back({network, false, true, Source::predicted});
    result.columns.push_back({"ms", true, false, {}});
  }
  for (const int ranks : unique_of(comparison.rows, [](const auto& row) { return row.ranks; })) {
    const SchemeWinners best = fastest(comparison.rows, ranks);
    const bool shares = !best.empty() && ranks > comparison.cores;
    std::vector<std::string> line = {
        std::to_string(ranks),
        winners_cell(names_of(best, codecs)) + (shares ? " (cores shared)" : ""),
        best.empty() ? "-" : milliseconds_cell(*best.front()->total_seconds)};
    for (const std::string& network : networks) {
      const SchemeWinners over = fastest_over(comparison.rows, ranks, network, factor);
      line.push_back(winners_cell(names_of(over, codecs)));
      line.push_back(over.empty() ? "-"
                                  : short_number(total(*prediction(*over.front(), network)) * 1e3));
    }
    result.rows.push_back(std::move(line));
  }
  return result;
}

}  // namespace

Html compose_answer(const ComposeComparison& comparison) {
  const SchemeRows& rows = comparison.rows;
  const bool codecs = codecs_of(rows).size() > 1;
  const double factor = prediction_factor(rows);
  std::vector<std::string> networks = networks_of(rows);
  std::erase(networks, kThisMachine);
  Html advice;
  if (const SchemeWinners here = winners_here(comparison); !here.empty())
    advice += measured_sentence(comparison, here, codecs);
  const int ranks = advised_ranks(rows);
  if (!networks.empty() && ranks > comparison.cores)
    advice += predicted_sentence(comparison, ranks, networks.front(), factor, codecs);
  if (!networks.empty()) advice += doubts(rows, factor);
  return advice_beside(advice, paragraph("Fastest with so many ranks, gather included:") +
                                   table(table_of(comparison, networks, factor, codecs)) +
                                   omissions(comparison.left_out));
}

Html omissions(const std::vector<LeftOut>& left_out) {
  if (left_out.empty()) return "";
  std::string text;
  for (const int ranks : unique_of(left_out, [](const LeftOut& one) { return one.ranks; })) {
    std::vector<std::string> names;
    for (const LeftOut& one : left_out) {
      if (one.ranks == ranks && std::find(names.begin(), names.end(), one.scheme) == names.end())
        names.push_back(one.scheme);
    }
    text += fmt::format("{}{} ranks without {}", text.empty() ? "" : "; ", ranks,
                        fmt::join(names, ", "));
  }
  return paragraph(text +
                   ": their many messages take long to simulate, which --ranks asks for all the "
                   "same.");
}

std::vector<std::string> codecs_of(const SchemeRows& rows) {
  return unique_of(rows, [](const ComparedScheme& row) { return row.codec; });
}

std::vector<std::string> networks_of(const SchemeRows& rows) {
  std::vector<std::string> result;
  for (const ComparedScheme& row : rows) {
    for (const Predicted& p : row.predicted) {
      if (std::find(result.begin(), result.end(), p.network) == result.end())
        result.push_back(p.network);
    }
  }
  return result;
}

}  // namespace delray::apps
